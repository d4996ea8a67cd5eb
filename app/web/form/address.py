"""Query string of a sample's page: the form's fields by their own names, as POST sends them, without the defaults.

The one grammar of these addresses. ``static/js/lib/address.js`` writes the same from the page that is open; short forms
of older links are read, too (`app.web.form.short_address`).
"""

from collections.abc import Iterator, Mapping
from urllib.parse import urlencode

from app.errors import NotFoundError
from app.experiments.model import Experiment, Sample
from app.images.crop import Frames, Rectangle
from app.methods.fields import fields
from app.methods.model import Method, Size
from app.methods.registry import METHODS, method
from app.web.form.draft import SIZES, Draft
from app.web.form.inputs import Choices, crop_names, further_numbers, is_optional, max_inputs, prefix, time_names
from app.web.form.parameters import VIDEO_FIELDS, form_name, own_fields, shared_names
from app.web.form.short_address import expand

STILL = Frames()
READABLE = ",:@*"  # characters that stay as they are; the star as browsers write forms


def sample_url(sample: str, values: Mapping[str, str]) -> str:
    """Link to the form of a sample, filled in with these values.

    Examples
    --------
    >>> sample_url("gravel_gray", {"method": "rpn", "seed": "7"} | input_values(1, Rectangle(4, 6, 20, 16)))
    '/samples/gravel_gray?method=rpn&crop.x=4&crop.y=6&crop.width=20&crop.height=16&seed=7'
    """
    return f"/samples/{sample}?{query_of(values)}"


def form_url(experiment: Experiment) -> str:
    """Link to the form of an experiment's first sample, filled in as the experiment says."""
    return sample_url(experiment.inputs[0].sample, values_of(experiment))


def query_of(values: Mapping[str, str]) -> str:
    """Write a form as the query that opens it again; the opposite of `from_query`.

    Parameters
    ----------
    values : mapping
        Form names to texts; what is left out is not written. Browsers leave out switches that are off: see
        `with_switches`. Only those fields are written that count for the chosen method and differ from their defaults.
    """
    chosen = METHODS.get(values.get("method", ""))
    held = ((name, default) for name, default in _fields(values, chosen) if name in values)
    query = {name: values[name] for name, default in held if values[name] != default}
    return urlencode(query, safe=READABLE).replace("~", "%7E")


def from_query(sample: Sample, choices: Choices, query: Mapping[str, str]) -> Draft:
    """Fill the form for a sample: its defaults, changed by what the page's address says.

    What was typed comes back as it was typed. A method, a size or a further sample that there is none of counts as not
    said, and so does what an address in the short forms has wrong.

    Parameters
    ----------
    sample : Sample
    choices : Choices
        What further inputs are chosen from, and where crops start.
    query : mapping
        Form names to texts, or the short forms.
    """
    chosen = METHODS.get(query.get("method", "")) or _suitable(sample)
    query = expand(sample, choices, chosen, query)
    values = _defaults(sample, choices, chosen)
    known = {name: text for name, text in query.items() if name in values and name != "method"}
    for number in further_numbers():
        name = f"{prefix(number)}sample"
        if known.get(name) and not _exists(choices, known[name]):
            known = {key: text for key, text in known.items() if not key.startswith(prefix(number))}
    values |= known
    size = known.get("size", "free" if values["width"] or values["height"] else "1")
    values["size"] = size if size in SIZES else "1"
    return Draft(values)


def with_switches(values: Mapping[str, str]) -> dict[str, str]:
    """Add the switches that are off to a submitted form, which browsers leave out of it."""
    switches = [
        form_name(declared, entry.name)
        for declared in METHODS.values()
        for entry in fields(declared.params)
        if entry.kind == "switch"
    ]
    return dict.fromkeys(switches, "") | dict(values)


def values_of(experiment: Experiment) -> dict[str, str]:
    """Fill the form in as an experiment says."""
    used = method(experiment.method)
    values = {"method": used.name, "size": "free"}
    for number, source in enumerate(experiment.inputs, 1):
        if number > 1:
            values[f"{prefix(number)}sample"] = source.sample
        values |= input_values(number, source.crop, source.frames)
    for entry in fields(used.params):
        value = experiment.parameters.get(entry.name)
        text = ("on" if value else "") if isinstance(value, bool) else str(value)
        values[form_name(used, entry.name)] = entry.default if value is None else text
    sizes = [Size(source.crop.width, source.crop.height, 3) for source in experiment.inputs]
    if used.size(sizes) == (experiment.parameters.get("width"), experiment.parameters.get("height")):
        values["size"] = "1"
    if used.moving and experiment.parameters.get("frames") == max(source.frames.count for source in experiment.inputs):
        values["frames"] = ""
    return values


def input_values(number: int, crop: Rectangle, frames: Frames = STILL) -> dict[str, str]:
    """Write a crop and a time range as an input's fields; one frame is what a still method takes, and no range."""
    first, count = str(frames.first or ""), str(frames.count) if frames.count > 1 else ""
    return dict(zip((*crop_names(number), *time_names(number)), (*str(crop).split(","), first, count), strict=True))


def _fields(values: Mapping[str, str], chosen: Method | None) -> Iterator[tuple[str, str | None]]:
    """Give each field that counts, in the order of the form, with its default; None where it is always written."""
    yield "method", None
    for number in range(1, max_inputs(chosen) + 1 if chosen else 2):
        name = f"{prefix(number)}sample"
        if number > 1:
            yield name, "" if is_optional(number) else None
        if number == 1 or values.get(name):
            yield from ((part, "") for part in time_names(number))
            yield from ((part, None if number == 1 else "") for part in crop_names(number))
    if chosen is None:
        return
    own = own_fields(chosen)
    for entry in sorted(own, key=lambda entry: entry.advanced):  # stable: else as declared
        yield form_name(chosen, entry.name), entry.default
    yield "size", "1"
    sides = ("width", "height") if values.get("size") == "free" else ()
    moving = [entry.name for entry in VIDEO_FIELDS if entry.name in shared_names(chosen)]
    defaults = {entry.name: entry.default for entry in fields(chosen.params)}
    yield from ((name, defaults[name]) for name in (*sides, *moving, "seed"))
    yield "unlisted", ""


def _defaults(sample: Sample, choices: Choices, chosen: Method) -> dict[str, str]:
    values = {"method": chosen.name, "size": "1", "unlisted": "", **input_values(1, choices.suggest_crop(sample))}
    for number in further_numbers():
        values[f"{prefix(number)}sample"] = "" if is_optional(number) else choices.suggest_sample(sample, number)
        values |= dict.fromkeys((*crop_names(number), *time_names(number)), "")
    for declared in (chosen, *METHODS.values()):
        for entry in fields(declared.params):
            values.setdefault(form_name(declared, entry.name), entry.default)
    return values


def _suitable(sample: Sample) -> Method:
    """Choose the method that a page starts with: of a clip the first one for videos."""
    methods = list(METHODS.values())
    return next((entry for entry in methods if sample.moving and entry.inputs[0].moving), methods[0])


def _exists(choices: Choices, name: str) -> bool:
    try:
        choices.find(name)
    except NotFoundError:
        return False
    return True

"""Short addresses of a sample's page, from bookmarks and older links: read, never written.

``crop=x,y,w,h`` and ``time=first,count`` are the first input's, ``second=id:x,y,w,h@first,count`` a further one, and
the method's parameters have their own names: ``alpha=0.2``.
"""

from collections.abc import Mapping
from contextlib import suppress

from app.errors import InvalidInputError, NotFoundError
from app.experiments.model import Sample
from app.images.crop import Rectangle
from app.methods.model import Method
from app.web.form.inputs import ORDINALS, Choices, crop_names, further_numbers, prefix, read_range, time_names
from app.web.form.parameters import form_name, own_fields


def expand(sample: Sample, choices: Choices, chosen: Method, query: Mapping[str, str]) -> dict[str, str]:
    """Write what a query says in short by the form's names. What is wrong is left out; the form's own names win."""
    found = _crop(1, sample, query.get("crop", "")) | _time(1, sample, query.get("time", ""))
    for number in further_numbers():
        source, _, time = query.get(ORDINALS[number - 1], "").partition("@")
        name, _, corners = source.partition(":")
        with suppress(NotFoundError):
            entry = choices.find(name)
            found[f"{prefix(number)}sample"] = name
            found |= _crop(number, entry, corners) | _time(number, entry, time)
    found |= {form_name(chosen, entry.name): query[entry.name] for entry in own_fields(chosen) if entry.name in query}
    return found | dict(query)


def _crop(number: int, sample: Sample, text: str) -> dict[str, str]:
    with suppress(InvalidInputError):
        crop = Rectangle.parse(text).check_within(sample.width, sample.height)
        return dict(zip(crop_names(number), str(crop).split(","), strict=True))
    return {}


def _time(number: int, sample: Sample, text: str) -> dict[str, str]:
    first, _, count = text.partition(",")
    with suppress(ValueError, InvalidInputError):
        read_range(sample, first, count)
        # One frame is what still methods take, and no range that a method for videos could start from.
        return dict(zip(time_names(number), (first, "" if count == "1" else count), strict=True))
    return {}

"""Template context of a sample's page: methods with their fields, inputs with the samples they offer."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from app.errors import NotFoundError
from app.experiments.files.versions import made_version
from app.experiments.model import Sample
from app.images.crop import Rectangle
from app.methods.fields import FormField, fields
from app.methods.model import Method, first_size
from app.methods.params import StillParams
from app.methods.registry import METHODS
from app.samples import BundledSample
from app.web.form.address import sample_url
from app.web.form.draft import SIZES, Draft
from app.web.form.inputs import ORDINALS, SIDES, Choices, further_numbers, is_optional, max_inputs, prefix
from app.web.form.parameters import SHARED, VIDEO_FIELDS, form_name, own_fields, shared_names


@dataclass(frozen=True)
class Offer:
    """A sample that can be chosen; ``crop`` is where it starts, ``entry`` what the catalogue says of a bundled one."""

    id: str
    digest: str
    title: str
    width: int
    height: int
    frames: int
    rate: float
    crop: Rectangle
    entry: BundledSample | None

    @property
    def moving(self) -> bool:
        return self.frames > 1

    @property
    def version(self) -> str:
        """Belongs to the addresses of its pictures."""
        return made_version(self.digest)


@dataclass(frozen=True)
class InputForm:
    """One input of the form; ``name`` and ``id`` are what its form names and its elements' ids begin with.

    ``shown`` is None for an optional one that is not there.
    """

    number: int
    title: str
    name: str
    id: str
    optional: bool
    offers: tuple[Offer, ...]
    shown: Offer | None


@dataclass(frozen=True)
class MethodForm:
    """One method of the form.

    ``takes`` are the numbers of its inputs, ``moves`` those of them that are videos, and ``named`` their titles where
    each has one of its own; ``asks`` are the parameters that it shares with other moving ones. ``follows`` says that
    its texture is as large as the first crop unless asked otherwise, and not as the method finds right; ``open`` that
    something under "advanced" is not as usual. ``clips`` are bundled clips to open it with instead, by title, where
    the page's sample is a still picture and that will not do.
    """

    method: Method
    plain: tuple[FormField, ...]
    advanced: tuple[FormField, ...]
    takes: range
    moves: tuple[int, ...]
    named: tuple[str, ...]
    asks: tuple[str, ...]
    follows: bool
    open: bool
    lacks_clip: bool
    clips: dict[str, str]


def form_context(sample: Sample, choices: Choices, draft: Draft) -> dict[str, Any]:
    """Give the template all of the form but what belongs to this one request."""
    inputs = [InputForm(1, "First sample", "", "", False, (), _make_offer(sample, choices, sample))]
    inputs += [_make_further(sample, choices, draft, number) for number in further_numbers()]
    return {
        "sample": sample,
        "draft": draft,
        "inputs": inputs,
        "sides": SIDES,
        "methods": [_make_method(method, draft, sample, choices) for method in METHODS.values()],
        "shared": fields(StillParams),
        "moving": VIDEO_FIELDS,
        "sizes": SIZES,
        "targets": {
            "method": f"method-{next(iter(METHODS))}",
            "sample": f"method-{draft.values.get('method', '')}",
            **{f"{entry.name}crop": f"{entry.id}crop-x" for entry in inputs},
            **{f"{entry.name}time": f"{entry.id}time-first" for entry in inputs},
        },
    }


def _make_offer(entry: Sample, choices: Choices, page: Sample) -> Offer:
    kind = "clip" if entry.moving else "photograph"
    return Offer(
        entry.id,
        entry.digest,
        entry.title or f"{'This' if entry.id == page.id else 'Your'} {kind}",
        entry.width,
        entry.height,
        entry.frames,
        entry.rate,
        choices.suggest_crop(entry),
        choices.entries.get(entry.id),
    )


def _make_further(sample: Sample, choices: Choices, draft: Draft, number: int) -> InputForm:
    offered = {entry.id: entry for entry in choices.samples}
    if sample.id not in offered:
        offered = {sample.id: sample, **offered}
    chosen = draft.values.get(f"{prefix(number)}sample", "")
    if chosen and chosen not in offered:
        with suppress(NotFoundError):  # the message is at the field
            offered[chosen] = choices.find(chosen)
    offers = tuple(_make_offer(entry, choices, sample) for entry in offered.values())
    shown = next((offer for offer in offers if offer.id == chosen), None)
    title = f"{ORDINALS[number - 1].capitalize()} sample"
    return InputForm(number, title, prefix(number), f"input-{number}-", is_optional(number), offers, shown)


def _make_method(method: Method, draft: Draft, sample: Sample, choices: Choices) -> MethodForm:
    own = own_fields(method)
    advanced = tuple(entry for entry in own if entry.advanced)
    names = {form_name(method, entry.name): entry.default for entry in advanced}
    takes = range(1, max_inputs(method) + 1)
    lacks_clip = method.inputs[0].moving and not sample.moving
    return MethodForm(
        method,
        tuple(entry for entry in own if not entry.advanced),
        advanced,
        takes,
        tuple(number for number in takes if method.slot(number - 1).moving),
        tuple(entry.title for entry in method.inputs) if len(takes) > 1 and not method.more else (),
        tuple(name for name in shared_names(method) if name not in SHARED),
        method.size is first_size,
        any(name in draft.errors or draft.values.get(name, "") != default for name, default in names.items()),
        lacks_clip,
        _link_clips(method, sample, choices) if lacks_clip else {},
    )


def _link_clips(method: Method, sample: Sample, choices: Choices) -> dict[str, str]:
    """Lead to the form of each bundled clip; where the method takes a still picture besides, with this one as that."""
    values = {"method": method.name}
    if still := [number for number in range(2, max_inputs(method) + 1) if not method.slot(number - 1).moving]:
        values[f"{prefix(still[0])}sample"] = sample.id
    return {clip.title or clip.id: sample_url(clip.id, values) for clip in choices.samples if clip.moving}

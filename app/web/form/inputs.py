"""Inputs of a sample's form: samples, crops and time ranges, read and validated."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.errors import InvalidInputError, NotFoundError
from app.experiments.model import Sample
from app.experiments.preparation import NewInput
from app.images.crop import Frames, Rectangle
from app.methods.model import Method, Slot
from app.methods.registry import METHODS
from app.numbers import plain, quote, whole
from app.samples import BundledSample

START = 512  # pixels of a side of the first crop, at most
SIDES = ("x", "y", "width", "height")
ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")
FOUR_NUMBERS = "A crop is four whole numbers: x, y, width and height in pixels"
OR_NONE = " Left empty, all four of them, it is a region that suits."
TWO_NUMBERS = "A time range is two whole numbers: the first frame, counted from 0, and how many"
ONE_NUMBER = "The frame is a whole number: the first one has the number 0"


@dataclass(frozen=True)
class Choices:
    """The samples that the form offers as further inputs.

    ``samples`` are in the order in which they are offered; ``entries`` by id is what the catalogue says of bundled
    ones; ``find`` gives any sample, also one that is not offered, or raises `NotFoundError`.
    """

    samples: tuple[Sample, ...]
    entries: Mapping[str, BundledSample]
    find: Callable[[str], Sample]

    def suggest_crop(self, sample: Sample) -> Rectangle:
        """Start with the suggested crop, or with the middle of a photograph, which is rarely one texture as a whole."""
        if sample.id in self.entries:
            return self.entries[sample.id].crop
        width, height = min(sample.width, START), min(sample.height, START)
        return Rectangle((sample.width - width) // 2, (sample.height - height) // 2, width, height)

    def suggest_sample(self, sample: Sample, number: int) -> str:
        """Name the sample that input ``number`` has at first: a photograph, which does for every further input."""
        others = [entry.id for entry in self.samples if entry.id != sample.id and not entry.moving] or [sample.id]
        return others[(number - 2) % len(others)]


def max_inputs(method: Method) -> int:
    """How many inputs a method takes at most."""
    return len(method.inputs) + method.more


def further_numbers() -> range:
    """The numbers of the inputs, from 2 on, that some method takes."""
    return range(2, max(max_inputs(method) for method in METHODS.values()) + 1)


def is_optional(number: int) -> bool:
    """Whether every method can do without this input."""
    return all(len(method.inputs) < number for method in METHODS.values())


def prefix(number: int) -> str:
    """What an input's form names begin with: nothing for the first, ``input-2.`` for the second."""
    return "" if number == 1 else f"input-{number}."


def crop_names(number: int) -> tuple[str, ...]:
    """The form names of the four numbers of an input's crop.

    Examples
    --------
    >>> crop_names(2)
    ('input-2.crop.x', 'input-2.crop.y', 'input-2.crop.width', 'input-2.crop.height')
    """
    return tuple(f"{prefix(number)}crop.{side}" for side in SIDES)


def time_names(number: int) -> tuple[str, str]:
    """The form names of the two numbers of an input's time range.

    Examples
    --------
    >>> time_names(1)
    ('time.first', 'time.count')
    """
    return f"{prefix(number)}time.first", f"{prefix(number)}time.count"


def read_inputs(
    sample: Sample, method: Method, choices: Choices, values: Mapping[str, str], errors: dict[str, str]
) -> dict[int, NewInput]:
    """Read the inputs that a method takes out of a submitted form, by number; what is wrong goes into ``errors``.

    An optional one without a sample is left out; a further one's crop that is left empty is the one to start with. Of
    a clip a still input takes the first frame of the time range.
    """
    read = {}
    for number in range(1, max_inputs(method) + 1):
        found: Sample | None = sample
        if number > 1:
            found = _find_sample(number, number <= len(method.inputs), choices, values, errors)
        if found is None:
            continue
        numbers = [values.get(name, "").strip() for name in crop_names(number)]
        empty = number > 1 and not any(numbers)
        crop = choices.suggest_crop(found) if empty else _read_crop(found, numbers, f"{prefix(number)}crop", errors)
        frames = _read_frames(found, method.slot(number - 1), number, values, errors)
        if crop is not None:
            read[number] = NewInput(found.id, crop, frames)
    return read


def _find_sample(
    number: int, needed: bool, choices: Choices, values: Mapping[str, str], errors: dict[str, str]
) -> Sample | None:
    field = f"{prefix(number)}sample"
    name = values.get(field, "").strip()
    if not name:
        if needed:
            errors[field] = f"Choose the {ORDINALS[number - 1]} sample: this method takes several."
        return None
    try:
        return choices.find(name)
    except NotFoundError as error:
        errors[field] = f"{error.message} Choose another one."
        return None


def _read_crop(sample: Sample, numbers: list[str], field: str, errors: dict[str, str]) -> Rectangle | None:
    wrong = [
        f"got {quote(text)} for {side}"
        for side, text in zip(SIDES, numbers, strict=True)
        if _parse_number(text) is None
    ]
    if wrong:
        errors[field] = f"{FOUR_NUMBERS}; {', '.join(wrong)}." + (OR_NONE if field != "crop" else "")
        return None
    try:
        return Rectangle(*(_parse_number(text) or 0 for text in numbers)).check_within(sample.width, sample.height)
    except InvalidInputError as error:
        errors[field] = error.message
    return None


def _parse_number(text: str) -> int | None:
    """The whole number that a person typed, None if it is none."""
    try:
        return whole(plain(text, whole=True))
    except ValueError:
        return None


def _read_frames(
    sample: Sample, slot: Slot, number: int, values: Mapping[str, str], errors: dict[str, str]
) -> Frames | None:
    if not sample.moving:
        return None
    first, count = (values.get(name, "").strip() for name in time_names(number))
    typed = {"the first frame": first or "0"} | ({"their number": count} if slot.moving and count else {})
    wrong = [f"got {quote(text)} for {name}" for name, text in typed.items() if _parse_number(text) is None]
    if wrong:
        errors[f"{prefix(number)}time"] = f"{TWO_NUMBERS if slot.moving else ONE_NUMBER}; {', '.join(wrong)}."
        return None
    try:
        return read_range(sample, first, count if slot.moving else "1")
    except InvalidInputError as error:
        errors[f"{prefix(number)}time"] = error.message
    return None


def read_range(sample: Sample, first: str, count: str) -> Frames:
    """Read a time range; left empty it begins with the first frame, and ends with the last.

    Raises `ValueError` for what is no number, and `InvalidInputError` for what does not lie in the sample.
    """
    begin = whole(plain(first, whole=True)) if first else 0
    return Frames(begin, whole(plain(count, whole=True)) if count else sample.frames - begin).check_within(
        sample.frames
    )

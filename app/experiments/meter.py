"""Structure meter: measures crops of samples, and says in plain words what their structure index means."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from app.experiments.model import Sample, check_frame
from app.experiments.ports import BlobStore
from app.images.crop import Rectangle, crop_to_centre
from app.images.read import read_crop
from app.images.stored_video import locate_crop
from app.synthesis.arrays import Real
from app.synthesis.luminance import luminance
from app.synthesis.structure import LEAST, SIGMA, Structure, is_too_small, structure_index

Verdict = Literal["micro-texture", "borderline", "structured", "unknown"]

# In crops of 256² of the bundled photographs (benchmarks/README.md) all micro-textures but one lie below the first, and
# nothing structured lies below the second; once halved in size, nothing structured lies below the first. Between two
# values of the second decimal, so that the same number, as it is shown, has the same word.
MICRO, STRUCTURED = 0.055, 0.075
SMALL = 1 << 20  # pixels of a photograph that is decoded as fast as a crop of it, and so is kept decoded
PHOTOGRAPHS = 4  # that are: 16 MB at most
KEPT = 1024  # crops whose index is remembered: the photographs of pages, and the way a crop was dragged


@dataclass(frozen=True)
class Reading:
    """Meaning of a structure index for random phase models, in a word and in a sentence."""

    verdict: Verdict
    words: str


READINGS: dict[Verdict, Reading] = {
    reading.verdict: reading
    for reading in (
        Reading("micro-texture", "Micro-texture: random phase models will reproduce it."),
        Reading("borderline", "Borderline: random phase models keep its grain, and blur the objects in it."),
        Reading("structured", "Structured: random phase models will dissolve its edges and objects."),
        Reading("unknown", f"Too small to tell: the index takes {LEAST} pixels along either side."),
    )
}


@dataclass(frozen=True)
class Index:
    """δ and z of a crop; both None if it is too small for them to mean anything."""

    delta: float | None
    z: float | None


def interpret(delta: float | None) -> Reading:
    """Interpret a structure index; None is that of a crop that is too small.

    Examples
    --------
    >>> [interpret(delta).verdict for delta in (0.02, 0.06, 0.2, None)]
    ['micro-texture', 'borderline', 'structured', 'unknown']
    """
    if delta is None:
        return READINGS["unknown"]
    if delta < MICRO:
        return READINGS["micro-texture"]
    return READINGS["borderline" if delta < STRUCTURED else "structured"]


class Meter:
    """Measures crops of samples, and remembers what it found.

    Parameters
    ----------
    blobs : BlobStore
    """

    def __init__(self, blobs: BlobStore) -> None:
        self._blobs = blobs
        self._measured = lru_cache(KEPT)(self._measure)
        self._photograph = lru_cache(PHOTOGRAPHS)(self._read)

    def structure(self, sample: Sample, crop: Rectangle | None = None, sigma: float = SIGMA, frame: int = 0) -> Index:
        """Measure a crop, all of the sample if None; of a large one, its centre 1024 × 1024 pixels.

        Of a video it is that of one frame.

        Raises
        ------
        InvalidInputError
            If the crop or the frame is outside the sample, or holds transparent pixels.
        """
        check_frame(sample, frame)
        whole = Rectangle(0, 0, sample.width, sample.height)
        area = locate_crop(
            crop_to_centre((crop or whole).check_within(sample.width, sample.height)), frame, sample.height
        )
        small = sample.width * sample.height <= SMALL and not sample.transparent and not sample.moving
        found = self._measured(sample.digest, area, sigma, whole if small else None)
        return Index(None, None) if is_too_small(area.height, area.width) else Index(found.delta, found.z)

    def _measure(self, digest: str, area: Rectangle, sigma: float, whole: Rectangle | None) -> Structure:
        if whole is None:
            return structure_index(self._read(digest, area), sigma)
        grey = self._photograph(digest, whole)[area.y : area.y + area.height, area.x : area.x + area.width]
        return structure_index(grey, sigma)

    def _read(self, digest: str, area: Rectangle) -> Real:
        """Read a crop's luminance, which is all that is measured."""
        return luminance(read_crop(self._blobs.path(digest), area))

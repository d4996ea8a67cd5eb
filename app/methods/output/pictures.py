"""Pictures of a method's arrays: rounding, PNG files, spectra and coordinate colours."""

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from app.images.png_writer import PngWriter
from app.methods.context import Context
from app.methods.model import Fact, Picture, Source
from app.synthesis.arrays import Real
from app.synthesis.fourier.spectral import LogModulus
from app.synthesis.parallel import Team, row_blocks
from app.synthesis.sinks import Levels


def encode(
    name: str,
    title: str,
    values: Real,
    peak: float,
    context: Context,
    *,
    kind: Literal["texture", "view"] = "view",
    facts: tuple[Fact, ...] = (),
) -> Picture:
    """Round values to a picture's whole numbers, cutting off what is outside, and write it.

    Parameters
    ----------
    name, title : str
    values : ndarray of float32, shape (H, W, C) or (H, W)
        C is 1 or 3; 0 is black and ``peak`` white.
    peak : float
    context : Context
        Its depth is the picture's.
    kind, facts
        See `Picture`.
    """
    planes = values[None] if values.ndim == 2 else values.transpose(2, 0, 1)
    channels, height, width = planes.shape
    writer = PngWriter(width, height, channels, context.depth)
    levels = Levels(writer.write, channels, 0, peak, 2**context.depth - 1)

    def write(block: tuple[int, int]) -> None:
        levels(block[0], planes[:, block[0] : block[1]].astype(np.float32))

    with Team(context.threads) as team:
        team.run(write, row_blocks(height), lambda part: None)
    return Picture(name, title, width, height, writer.finish(), facts, kind=kind)


def crops(sources: Sequence[Source], context: Context) -> Iterator[Picture]:
    """The inputs as pictures: ``crop``, then ``crop-2`` and so on."""
    for number, source in enumerate(sources, 1):
        name, title = ("crop", "Crop") if number == 1 else (f"crop-{number}", f"Crop {number}")
        yield encode(name, title, source.pixels, source.peak, context)


def log_modulus(name: str, title: str, power: Real, width: int, context: Context) -> Picture:
    """Squared modulus on the half spectrum, shape (H, width // 2 + 1), as a picture of the whole centred spectrum."""
    picture = LogModulus(power, width)
    writer = PngWriter(width, len(power), 1, 8)

    def write(block: tuple[int, int]) -> None:
        writer.write(block[0], picture.rows(*block)[:, :, None])

    with Team(context.threads) as team:
        team.run(write, row_blocks(len(power)), lambda part: None)
    return Picture(name, title, width, len(power), writer.finish())


def coordinate_colours(height: int, width: int) -> Real:
    """A colour for every place, shape (height, width, 3): red grows to the right, green down, blue to the upper left.

    Values are 0 to 1.
    """
    y, x = np.linspace(0, 1, height)[:, None], np.linspace(0, 1, width)[None, :]
    return np.stack(np.broadcast_arrays(x, y, 1 - (x + y) / 2), axis=2).astype(np.float32)

"""Colour management: converts grey, RGB and CMYK with an ICC profile, or plain inks, to sRGB at full depth."""

from functools import cache
from typing import Any

import imagecodecs
import numpy as np
from numpy.typing import NDArray

from app.images.png_writer import Pixels
from app.synthesis.arrays import Real

NO_OPTIMISATION = imagecodecs.CMS.FLAGS.NOOPTIMIZE  # exact, not by interpolation in a coarse grid
D65 = (0.3127, 0.3290, 1.0)
PRIMARIES = (0.64, 0.33, 1.0, 0.30, 0.60, 1.0, 0.15, 0.06, 1.0)  # of sRGB: x, y, Y of red, green and blue
LEVELS = 1 << 16
FINE_LEVELS = 1 << 18  # of linear light, so that 16 bits near black come out right
PROBES = 2048
TOLERANCE = 1e-4
ROW_PIXELS = 1 << 16  # pixels converted at once: they stay in the cache between the passes


def to_srgb(pixels: Pixels, profile: bytes | None) -> Pixels:
    """Convert grey, RGB or CMYK to sRGB.

    Parameters
    ----------
    pixels : ndarray, shape (H, W, C)
        uint8 or uint16, over the whole range of the type; C is 1, 3 or 4 (CMYK, 0 is no ink).
    profile : bytes or None
        The file's ICC profile. A profile that is broken or is not for these channels is ignored, as browsers do:
        the numbers then count as sRGB, or as plain inks.

    Returns
    -------
    ndarray, shape (H, W, 1) for grey, otherwise (H, W, 3)
        Of the same type, by the profile's perceptual intent. An array that needs no conversion is returned as it is.

    Notes
    -----
    No profile raises an error: see ``profile``.
    """
    channels = pixels.shape[2]
    if profile:
        try:
            if channels == 1:
                return _convert_grey(pixels, profile)
            if channels == 4:
                return _transform(pixels, profile, "cmyk")
            deep = pixels.dtype == np.uint16
            return _convert_deep(pixels, profile) if deep else _transform(pixels, profile, "rgb")
        except imagecodecs.CmsError:
            pass
    return _convert_inks(pixels) if channels == 4 else pixels


def _transform(colours: NDArray[Any], profile: bytes, space: str, **options: Any) -> NDArray[Any]:
    target = options.pop("target", None) or imagecodecs.cms_profile("srgb")
    converted: NDArray[Any] = imagecodecs.cms_transform(
        np.ascontiguousarray(colours), profile, target, colorspace=space, outcolorspace="rgb", **options
    )
    return converted


def _convert_grey(pixels: Pixels, profile: bytes) -> Pixels:
    """Convert grey by a table of all levels: the library interpolates, and is up to 10 of 255 levels off near black."""
    greys = np.arange(np.iinfo(pixels.dtype).max + 1, dtype=pixels.dtype)[None]
    return _transform(greys, profile, "gray", flags=NO_OPTIMISATION)[0, :, 1][pixels]


def _convert_deep(pixels: Pixels, profile: bytes) -> Pixels:
    """Convert 16-bit RGB.

    The library is either exact and takes a microsecond a pixel, or interpolates and is up to 20 levels of 255 off.
    But the profiles of cameras and screens are curves and a matrix: in linear light a colour is the sum of what each
    channel contributes alone, and that is a table. Random colours show whether the profile is of this kind; one that
    is not is converted exactly.
    """
    linear = imagecodecs.cms_profile("rgb", gamma=1.0, whitepoint=D65, primaries=PRIMARIES)
    alone = np.zeros((3, LEVELS, 3), np.float32)
    for channel in range(3):
        alone[channel, :, channel] = np.linspace(0, 1, LEVELS)
    tables = _transform(alone, profile, "rgb", target=linear)
    tables[1:] -= tables[0, 0]  # black is counted once
    probes = np.random.default_rng(0).integers(0, LEVELS, (1, PROBES, 3))
    exact = _transform((probes / (LEVELS - 1)).astype(np.float32), profile, "rgb", target=linear)
    if abs(_add_channels(tables, probes) - exact).max() > TOLERANCE:
        return _transform(pixels, profile, "rgb", flags=NO_OPTIMISATION)
    tables *= FINE_LEVELS - 1
    tables[0] += 0.5  # for rounding
    encoded, result = _make_encoding(), np.empty(pixels.shape, np.uint16)
    step = max(1, ROW_PIXELS // pixels.shape[1])
    for y in range(0, len(pixels), step):
        light = _add_channels(tables, pixels[y : y + step])
        np.clip(light, 0, FINE_LEVELS - 1, out=light)
        np.take(encoded, light.astype(np.int32), out=result[y : y + step], mode="clip")
    return result


def _add_channels(tables: Real, pixels: NDArray[Any]) -> Real:
    light = np.take(tables[0], pixels[..., 0], axis=0, mode="clip")
    light += np.take(tables[1], pixels[..., 1], axis=0, mode="clip")
    light += np.take(tables[2], pixels[..., 2], axis=0, mode="clip")
    return light


@cache
def _make_encoding() -> NDArray[np.uint16]:
    """Make the table from linear light in fine levels to 16-bit sRGB (IEC 61966-2-1)."""
    light = np.linspace(0, 1, FINE_LEVELS)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    levels: NDArray[np.uint16] = np.rint(encoded * (LEVELS - 1)).astype(np.uint16)
    return levels


def _convert_inks(pixels: Pixels) -> Pixels:
    """Convert ideal inks, of which each takes away its complement: red is ``(1 − c)(1 − k)``, and so on."""
    paper = (~pixels).astype(np.uint32)
    peak = np.iinfo(pixels.dtype).max
    left: Pixels = ((paper[..., :3] * paper[..., 3:] + peak // 2) // peak).astype(pixels.dtype)
    return left

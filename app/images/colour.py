"""Colours of an ICC profile, or of printing inks, turned into sRGB at full depth."""

import imagecodecs
import numpy as np

from app.images.png import Pixels

SPACES = {1: "gray", 3: "rgb", 4: "cmyk"}


def to_srgb(pixels: Pixels, profile: bytes | None) -> Pixels:
    """Convert grey, RGB or CMYK to sRGB.

    Parameters
    ----------
    pixels : ndarray, shape (H, W, C)
        uint8 or uint16; C is 1, 3 or 4 (CMYK, 0 is no ink).
    profile : bytes or None
        The file's ICC profile. One that is broken, or is not for these channels, is ignored, as browsers do: the
        numbers then count as sRGB, or as plain inks.

    Returns
    -------
    ndarray, shape (H, W, 1) for grey, otherwise (H, W, 3)
        Of the same type. Relative to the profile's white (relative colorimetric or perceptual, as the profile says).
    """
    channels = pixels.shape[2]
    if profile:
        try:
            converted: Pixels = imagecodecs.cms_transform(
                np.ascontiguousarray(pixels[..., 0] if channels == 1 else pixels),
                profile,
                imagecodecs.cms_profile("srgb"),
                colorspace=SPACES[channels],
                outcolorspace="rgb",
            )
        except imagecodecs.CmsError:
            pass
        else:
            return converted[..., 1:2] if channels == 1 else converted
    return _without_inks(pixels) if channels == 4 else pixels


def _without_inks(pixels: Pixels) -> Pixels:
    """Red, green and blue that three ideal inks and black leave over: ``(1 − c)(1 − k)``."""
    paper = (~pixels).astype(np.uint32)
    peak = np.iinfo(pixels.dtype).max
    return ((paper[..., :3] * paper[..., 3:] + peak // 2) // peak).astype(pixels.dtype)

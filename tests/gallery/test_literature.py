"""Figures show what their captions say."""

import numpy as np
import pytest
from imagecodecs import imread, png_decode

from app.gallery.exhibits import exhibits
from app.methods.context import Context
from app.methods.model import Source
from app.methods.registry import METHODS
from app.settings import ROOT

pytestmark = pytest.mark.slow

WAVES = ((3, 10), (11, -4))  # frequencies of the drawing, down and across
SIDE = 256
SHOWN = [exhibit for exhibit in exhibits().values() if exhibit.inputs == (("two_sinusoids", "0,0,256,256"),)]
RPN, ADSN = ([exhibit for exhibit in SHOWN if exhibit.method == name] for name in ("rpn", "adsn"))


def texture(exhibit):
    drawing = np.asarray(imread(ROOT / "samples" / "two_sinusoids.png"), np.float32).reshape(SIDE, SIDE, 1)
    method = METHODS[exhibit.method]
    params = method.params(**{"width": SIDE, "height": SIDE, **exhibit.parameters})
    made = next(iter(method.pictures([Source(drawing, 255)], params, Context(8, 1, lambda stage, fraction: None))))
    return png_decode(made.data).astype(float).reshape(SIDE, SIDE)


def waves(picture):
    """Complex amplitudes of the two oscillations, and what is left without them and the mean."""
    amplitudes = [2 * np.fft.fft2(picture)[k] / SIDE**2 for k in WAVES]
    y, x = 2 * np.pi * np.mgrid[:SIDE, :SIDE] / SIDE
    parts = sum((a * np.exp(1j * (k * y + m * x))).real for a, (k, m) in zip(amplitudes, WAVES, strict=True))
    return np.array(amplitudes), picture - picture.mean() - parts


def test_both_figures_of_the_two_sinusoids_are_looked_at():
    assert len(RPN) == 1  # one experiment for both pages
    assert len(ADSN) == 2


@pytest.mark.parametrize("exhibit", RPN, ids=str)
def test_a_random_phase_does_no_more_than_shift_the_drawing(exhibit):
    """Both amplitudes stay, and two phases are one translation. What else there is, is rounding.

    The drawing's own, which has its phase drawn anew, and the file's: two errors of 1/√12 each, 0.41 together. The
    amplitude of a wave in such an error has a deviation of 0.41 √2 / 256, the mean over 256² pixels.
    """
    amplitudes, rest = waves(texture(exhibit))
    np.testing.assert_allclose(np.abs(amplitudes), 56, atol=0.02)
    assert rest.std() == pytest.approx(np.sqrt(2 / 12), rel=0.1)
    assert np.abs(rest).max() < 2.5


@pytest.mark.parametrize("exhibit", ADSN, ids=str)
def test_the_other_model_has_the_two_waves_too_and_nothing_else(exhibit):
    """The rounding noise is multiplied by moduli of mean square 1; what passes black or white is cut off."""
    amplitudes, rest = waves(texture(exhibit))
    inside = np.abs(amplitudes).sum() < 127
    assert rest.std() < (0.5 if inside else 8)
    assert np.abs(amplitudes).max() > 2 * np.abs(amplitudes).min()


def test_and_favours_another_one_of_them_at_each_of_the_two_seeds():
    first, second = (np.abs(waves(texture(exhibit))[0]).argmax() for exhibit in ADSN)
    assert first != second

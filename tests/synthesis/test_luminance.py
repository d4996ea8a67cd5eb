"""Luminance is BT.709's weighted mean of three channels, and the plain mean of any other number."""

import numpy as np
import pytest

from app.synthesis.luminance import luminance
from tests.synthesis.images import image


def test_of_three_channels_it_has_the_weights_of_bt_709():
    h = image(7, 9)
    expected = 0.2126 * h[:, :, 0] + 0.7152 * h[:, :, 1] + 0.0722 * h[:, :, 2]
    np.testing.assert_allclose(luminance(h), expected, rtol=1e-6)
    assert luminance(h).dtype == np.float32


@pytest.mark.parametrize("channels", [1, 2, 4, 5])
def test_of_any_other_number_it_is_the_mean(channels):
    h = image(7, 9, channels)
    np.testing.assert_allclose(luminance(h), h.mean(2), rtol=1e-6)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_equal_channels_give_themselves_and_the_image_stays_as_it_is(channels):
    grey = image(7, 9, 1)
    h = np.repeat(grey, channels, axis=2)
    before = h.copy()
    np.testing.assert_allclose(luminance(h), grey[:, :, 0], rtol=1e-6)
    assert (h == before).all()


def test_a_grey_image_is_its_own():
    grey = image(7, 9, 1)[:, :, 0]
    assert luminance(grey) is grey

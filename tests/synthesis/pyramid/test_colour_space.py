"""The principal axes of colours are orthonormal, not correlated, and can be left again."""

import numpy as np
import pytest

from app.synthesis.pyramid.colour_space import ColourSpace


def planes(channels=3, peak=255, seed=0):
    rng = np.random.default_rng(seed)
    mixed = rng.uniform(0, 1, (channels, channels)) @ rng.uniform(0, 1, (channels, 24 * 31))
    return (peak / channels * mixed).reshape(channels, 24, 31).astype(np.float32)


@pytest.mark.parametrize("channels", [1, 2, 3, 5])
@pytest.mark.parametrize("peak", [1, 255, 65535])
def test_the_axes_are_orthonormal_and_there_is_a_way_back(channels, peak):
    image = planes(channels, peak)
    space = ColourSpace.from_planes(image)
    np.testing.assert_allclose(space.axes @ space.axes.T, np.eye(channels), atol=1e-12)
    np.testing.assert_allclose(space.back(space.forward(image)), image, atol=1e-5 * peak)


def test_the_components_are_centred_uncorrelated_and_ordered_by_their_variance():
    image = planes()
    space = ColourSpace.from_planes(image)
    covariance = np.cov(space.forward(image).reshape(3, -1), bias=True)
    np.testing.assert_allclose(covariance, np.diag(space.variances), atol=1e-4 * space.variances[0])
    np.testing.assert_allclose(space.forward(image).mean((1, 2)), 0, atol=1e-3)
    assert (np.diff(space.variances) <= 0).all()


def test_the_axes_have_one_sign():
    for seed in range(10):
        axes = ColourSpace.from_planes(planes(seed=seed)).axes
        assert (np.take_along_axis(axes, np.abs(axes).argmax(1)[:, None], 1) > 0).all()


def test_a_grey_photograph_in_colour_has_one_component():
    grey = planes(1)
    space = ColourSpace.from_planes(np.repeat(grey, 3, axis=0))
    np.testing.assert_allclose(space.axes[0], 1 / np.sqrt(3), atol=1e-6)
    np.testing.assert_allclose(space.variances[1:], 0, atol=1e-6 * space.variances[0])


def test_a_constant_has_axes_too():
    image = np.full((3, 4, 5), 9, np.float32)
    space = ColourSpace.from_planes(image)
    assert (space.variances == 0).all()
    np.testing.assert_allclose(space.back(space.forward(image)), 9, atol=1e-5)

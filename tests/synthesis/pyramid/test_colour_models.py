"""Every model that keeps less of a sample than its pixels keeps the covariance of its colours.

It is measured along the axes of the sample's colours, in their deviations: in a covariance whose greatest part is that
of light and dark, a colour that is lost would be a small error.
"""

from collections.abc import Callable

import numpy as np
import pytest

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot_noise import sample_spot
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.cut_texton import cut_texton
from app.synthesis.gaussian.dsn import dsn
from app.synthesis.gaussian.mixing import mix
from app.synthesis.gaussian.rpn import rpn
from app.synthesis.gaussian.texton import extend_texton, texton, texton_noise
from app.synthesis.gaussian.video_rpn import video_rpn
from app.synthesis.pyramid.heeger_bergen import heeger_bergen
from tests.synthesis.images import along_colours, covariance, photograph

SIDE = 64
DRAWS = 100
CROPS = [("leaves_forest_floor", (256, 256)), ("rockface_pink", (190, 60)), ("towel_red", (96, 96))]


def texton_at(h, seed, size=SIDE, cut=None):
    mean = h.mean((0, 1), dtype=np.float64)
    spots = [extend_texton(texton(h), mean, size, size)] if cut is None else cut_texton(h, mean, size, size, cut).spots
    return texton_noise(h, spots, seed=seed)


EXACT: dict[str, Callable] = {
    "rpn": lambda h, seed: rpn(h, seed=seed),
    "video-rpn, of a clip that stands still": lambda h, seed: video_rpn(np.stack([h, h]), seed=seed)[0],
}
ON_AVERAGE: dict[str, Callable] = {
    "adsn": lambda h, seed: adsn(h, seed=seed),
    "dsn": lambda h, seed: dsn(sample_spot(h, SIDE, SIDE), 7, seed=seed),
    "an end of a mixture": lambda h, seed: mix([h, h[::-1, :, ::-1]], [1, 0], seed=seed),
    "texton": texton_at,
    "texton on a larger area": lambda h, seed: texton_at(h, seed, 2 * SIDE),
    **{f"texton cut to {cut}": lambda h, seed, cut=cut: texton_at(h, seed, cut=cut) for cut in (31, 9, 1)},
    "texton cut to 9 on a larger area": lambda h, seed: texton_at(h, seed, 2 * SIDE, 9),
    "heeger-bergen": lambda h, seed: heeger_bergen(h, seed=seed, iterations=2),
}


@pytest.mark.parametrize("crop", CROPS, ids=lambda crop: crop[0])
@pytest.mark.parametrize("model", EXACT)
def test_a_random_phase_keeps_it_in_every_draw(model, crop):
    h = photograph(crop[0], *crop[1], SIDE)
    assert along_colours(covariance(EXACT[model](h, 1)), covariance(periodic_component(h))) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("crop", CROPS, ids=lambda crop: crop[0])
@pytest.mark.parametrize("model", ON_AVERAGE)
def test_other_models_keep_it_on_average(model, crop):
    """To 2 %, and four standard errors of the mean of these draws."""
    h = photograph(crop[0], *crop[1], SIDE)
    draws = DRAWS if model != "heeger-bergen" else 24
    found = np.array([covariance(ON_AVERAGE[model](h, seed)) for seed in range(draws)])
    variances, axes = np.linalg.eigh(covariance(periodic_component(h)))
    white = axes / np.sqrt(variances)
    found = white.T @ found @ white
    error = found.std(0, ddof=1) / np.sqrt(draws)
    assert (np.abs(found.mean(0) - np.eye(3)) < 0.02 + 4 * error).all()
    assert error.max() < 0.06

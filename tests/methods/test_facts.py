"""Every figure that a method prints beside a picture, in absolute units, against a plain formula."""

import numpy as np
import pytest
from imagecodecs import png_decode

from app.methods.model import Clip, Source
from app.methods.registry import METHODS
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.gaussian.texton import radii, texton
from app.synthesis.gaussian.video_rpn import video_rpn
from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.pyramid.heeger_bergen import Decomposition, SampleStatistics, Synthesis
from app.synthesis.pyramid.pyramid import SteerablePyramid
from tests.methods.runs import a_clip, a_crop, run_small


def outputs(name, *sources, scratch=None, **parameters):
    return {made.name: made for made in run_small(METHODS[name], sources, scratch=scratch, **parameters)}


def facts(picture):
    return {fact.name: fact.value for fact in picture.facts}


def flat(size, *values):
    return Source(np.full((*size, len(values)), values, np.float32), 255)


def test_rayleigh_prints_the_correlation_of_what_it_shows():
    """Of the texture at 16 bits and the plain periodic component, each channel about its own mean."""
    source = Source(a_crop().pixels * 0.4 + 77, 255)  # nothing of it is cut off
    found = outputs("rayleigh", source, seed=3, depth=16)["texture"]
    z = png_decode(found.data).astype(np.float64)
    p = periodic_component(source.pixels).astype(np.float64)
    a, b = ((image - image.mean((0, 1))).ravel() for image in (p, z))
    assert facts(found)["correlation"] == pytest.approx((a @ b) / np.sqrt((a @ a) * (b @ b)), abs=1e-4)


def test_the_texton_prints_the_radii_of_the_discs():
    """The smallest disc about the middle with at least a part of the energy, by going through all of them."""
    source = a_crop()
    found = facts(outputs("texton", source)["texton"])
    t = texton(source.pixels).astype(np.float64)
    y, x = np.mgrid[:48, :64]
    distances, energy = np.hypot(y - 24, x - 32), np.square(t).sum(2)
    for part in (50, 90, 99):
        inside = [
            radius for radius in np.unique(distances) if energy[distances <= radius].sum() >= part / 100 * energy.sum()
        ]
        assert found[f"radius-{part}"] == pytest.approx(inside[0])
        assert found[f"radius-{part}"] == pytest.approx(radii(t.astype(np.float32), [part / 100])[0])


def test_the_discrete_spot_noise_prints_the_kurtosis_of_its_spots_values_over_n():
    found = facts(outputs("dsn", flat((48, 64), 9.0), spot="disc", radius=5, order=40)["texture"])
    y, x = np.mgrid[:48, :64]
    disc = ((y - 24) ** 2 + (x - 32) ** 2 <= 25).astype(np.float64)
    centred = disc - disc.mean()
    kurtosis = (centred**4).mean() / (centred**2).mean() ** 2 - 3
    assert found["excess-kurtosis"] == pytest.approx(kurtosis / 40, rel=1e-4)


@pytest.mark.parametrize("edges", ["periodic", "mirror"])
def test_heeger_bergen_prints_the_shares_of_the_principal_components(edges):
    source = a_crop()
    found = facts(outputs("heeger-bergen", source, edges=edges, scales=3)["crop-bands"])
    image = periodic_component(source.pixels) if edges == "periodic" else source.pixels
    variances = np.linalg.eigvalsh(np.cov(image.reshape(-1, 3).T.astype(np.float64)))[::-1]
    expected = 100 * variances / variances.sum()
    assert [found[f"component-{number}"] for number in (1, 2, 3)] == pytest.approx(expected, rel=1e-3, abs=1e-3)


def test_heeger_bergen_prints_the_mean_distance_of_the_sub_bands():
    """Of the same synthesis, whose distances `tests/synthesis/pyramid` compares with plain bands."""
    source = a_crop()
    found = facts(outputs("heeger-bergen", source, scales=3, iterations=2, seed=5)["texture-bands"])
    decomposition = Decomposition(scales=3)
    pyramid = SteerablePyramid(48, 64, 3, 4)
    with Team(2) as team:
        work = Work(team, lambda stage, part: None)
        synthesis = Synthesis(SampleStatistics(source.pixels, decomposition, pyramid, work), pyramid, 5, work)
        for _ in range(2):
            synthesis.iterate("iteration")
        distances = list(synthesis.distances("distances").values())
    assert found["distance"] == pytest.approx(100 * np.mean(distances))


def test_patchwork_prints_how_many_cells_there_are_and_what_they_show_of_the_crop():
    """The cores of the cells at their sources, painted one by one."""
    source = a_crop(96, 110)
    made = outputs("patchwork", source, grid=16, seed=2, width=80, height=70)
    cells = jittered_cells(70, 80, grid=16, sharpness=6, tileable=True, seed=2)
    shown = np.zeros((96, 110), bool)
    for (top, bottom, left, right), (y, x) in zip(cells.cores, cells.sources(96, 110, 2), strict=True):
        shown[max(y + top, 0) : max(y + bottom, 0), max(x + left, 0) : max(x + right, 0)] = True
    assert facts(made["texture"])["cells"] == cells.count == 25
    assert facts(made["sources"])["shown"] == pytest.approx(100 * shown.mean())


@pytest.mark.parametrize("peak", [255, 65535])
def test_transfer_prints_the_root_mean_square_error_in_levels_of_255(peak):
    """A flat pattern, off by 10, 20 and 0 levels, wherever it is compared."""
    texture, pattern = (
        Source(flat((48, 64), *values).pixels * (peak // 255), peak) for values in ((100, 90, 50), (110, 70, 50))
    )
    found = facts(outputs("transfer", texture, pattern, rescale=False, candidates=3)["texture"])
    assert found["error"] == pytest.approx(np.sqrt((10**2 + 20**2) / 3), rel=1e-6)


def test_efros_and_leung_prints_what_is_copied_along_of_a_ramp():
    """Every pixel of a ramp is there once: its place is its value, and the share can be counted in the texture."""
    values = np.arange(24 * 26, dtype=np.float32).reshape(24, 26, 1)
    made = outputs("efros-leung", Source(values, 65535), width=30, height=28, half_patch=1, seed=1, depth=16)["texture"]
    place = png_decode(made.data).astype(int).reshape(28, 30)
    rows, columns = np.divmod(place, 26)
    offset = np.stack([rows, columns], 2) - np.moveaxis(np.indices(place.shape), 0, 2)
    along = sum(
        (x > 0 and (offset[y, x] == offset[y, x - 1]).all()) or (y > 0 and (offset[y, x] == offset[y - 1, x]).all())
        for y, x in np.ndindex(place.shape)
    )
    assert facts(made)["verbatim"] == pytest.approx(100 * along / place.size)


def test_video_rpn_prints_the_part_of_the_variance_that_stands_still(tmp_path):
    source = a_clip()
    assert isinstance(source.clip, Clip)
    found = facts(outputs("video-rpn", source, scratch=tmp_path, seed=4, frames=9, width=50)["average"])
    z = video_rpn(source.clip.frames, 9, 48, 50, seed=4).astype(np.float64)
    still = z.mean(0).var((0, 1)).sum() / z.var((0, 1, 2)).sum()
    assert found["still"] == pytest.approx(100 * still, rel=1e-3)

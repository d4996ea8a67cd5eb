"""Heeger and Bergen's textures have the sample's histograms."""

import numpy as np
import pytest

from app.synthesis.fourier.periodic import periodic_component, smooth_component
from app.synthesis.parallel import Team, Work
from app.synthesis.pyramid.heeger_bergen import Decomposition, SampleStatistics, Synthesis, heeger_bergen
from app.synthesis.pyramid.pyramid import SteerablePyramid
from tests.synthesis.pyramid import plain_heeger_bergen as plain
from tests.synthesis.stopping import stops_at

BOTH = pytest.mark.parametrize("edges", ["periodic", "mirror"])


def blobs(height=64, width=80, channels=3, seed=0):
    """Bright discs of two sizes on a darker ground: not Gaussian, homogeneous, of correlated colours."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    picture = rng.normal(60, 5, (height, width, channels))
    for _ in range(height * width // 80):
        radius, place = rng.choice([1.5, 4]), rng.uniform(0, (height, width))
        disc = np.hypot(y - place[0], x - place[1]) < radius
        picture[disc] = rng.uniform(120, 220) * np.linspace(1, 0.6, channels)
    return picture.astype(np.float32)


def begun(h, height=None, width=None, edges="periodic", **options):
    """A sample and the synthesis of a texture of it, which has not been iterated."""
    decomposition = Decomposition(edges=edges, **options)
    pyramid = SteerablePyramid(
        height or h.shape[0], width or h.shape[1], decomposition.scales, decomposition.orientations
    )
    work = Work(Team(2), lambda stage, part: None)
    sample = SampleStatistics(h, decomposition, pyramid, work)
    return sample, Synthesis(sample, pyramid, 1, work)


@BOTH
def test_the_pixels_have_the_samples_histogram_exactly_along_every_principal_axis(edges):
    sample, synthesis = begun(blobs(), edges=edges)
    for iteration in range(3):
        for number, asked in enumerate(sample.channels):
            found = synthesis.channel(number)
            assert (np.sort(found, axis=None) == np.sort(asked, axis=None)).all()
        synthesis.iterate(str(iteration))


@pytest.mark.parametrize("size", [(97, 131), (40, 41), (128, 50)])
def test_at_another_size_they_have_its_quantiles(size):
    h = blobs()
    sample, synthesis = begun(h, *size)
    synthesis.iterate("1")
    count = size[0] * size[1]
    for number, asked in enumerate(sample.channels):
        found = synthesis.channel(number)
        places = (np.arange(count) + 0.5) * asked.size / count - 0.5
        expected = np.interp(places, np.arange(asked.size), np.sort(asked, axis=None))
        np.testing.assert_allclose(np.sort(found, axis=None), expected, atol=1e-3)


@pytest.mark.parametrize("size", [(None, None), (101, 163)])
def test_every_iteration_brings_the_sub_bands_histograms_closer(size):
    """Last comes the matching of the pixels, and the pyramid is redundant, so the bands' histograms are not exact.

    Their Wasserstein distance, on average over the bands, starts at 0.7 deviations (these discs are far from
    Gaussian), and is a tenth after five iterations. One coarse band has few degrees of freedom (8 × 10 values or
    fewer), on which the pixels' histogram leaves its mark: up to a quarter.
    """
    _, synthesis = begun(blobs(), *size)
    distances = [np.array(list(synthesis.distances("distances").values()))]
    for iteration in range(5):
        synthesis.iterate(str(iteration))
        distances.append(np.array(list(synthesis.distances("distances").values())))
    means = [float(found.mean()) for found in distances]
    assert means == sorted(means, reverse=True)
    assert means[0] > 0.6
    assert means[-1] < 0.1
    assert distances[-1].max() < 0.25


@pytest.mark.parametrize("size", [(64, 80), (61, 67)])
def test_the_sample_itself_is_a_fixed_point(size):
    """All its histograms are right, so matching changes nothing but by rounding, which is 1e-5 of the contrast.

    A value may change places with one that differs by less than the rounding.
    """
    sample, synthesis = begun(blobs(*size))
    for channel, plane in enumerate(sample.channels):
        synthesis.restart(channel, plane.copy())
    assert max(synthesis.distances("distances").values()) < 1e-5
    for iteration in range(3):
        synthesis.iterate(str(iteration))
    np.testing.assert_allclose(synthesis.planes(), periodic_component(blobs(*size)).transpose(2, 0, 1), atol=1e-2)


def test_white_noise_gives_white_noise():
    """The shares of energy by eighth of the radius are those of white noise: 64² · π/4 · (2i + 1)/64 coefficients of
    a ring i, of exponential energy, deviate by 1/√n, and the sample's own deviation comes in by as much.
    """
    noise = np.random.default_rng(0).normal(100, 20, (128, 128)).astype(np.float32)
    power = np.abs(np.fft.fft2(heeger_bergen(noise, seed=3))) ** 2 / 128**2 / 400
    k = np.fft.fftfreq(128)
    ring = np.floor(16 * np.hypot(k[:, None], k)).astype(int)
    for i in range(1, 8):
        inside = ring == i
        inside[0, 0] = False
        # half of the coefficients are conjugates of the others; matching histograms adds no more than that again
        assert power[inside].mean() == pytest.approx(1, abs=5 * np.sqrt(2 * 2 / inside.sum()) + 0.02)


@BOTH
@pytest.mark.parametrize("angle", [30, -30])
def test_the_direction_of_a_texture_is_kept(edges, angle):
    """With mirrored edges too, although the mirror images have the opposite slope: only the crop's own part counts.

    Were both slopes counted alike, the gradients' correlation would be 0.
    """
    rng = np.random.default_rng(0)
    k = np.fft.fftfreq(96)
    theta = np.arctan2(k[:, None], k) - np.radians(angle)
    coarse = np.hypot(k[:, None], k) < 0.2
    streaks = np.fft.ifft2(np.fft.fft2(rng.normal(0, 1, (96, 96))) * np.cos(theta) ** 20 * coarse).real
    h = (100 + 400 * streaks).astype(np.float32)

    def slope(picture):
        down, across = np.diff(picture, axis=0)[:, :-1], np.diff(picture, axis=1)[:-1]
        return float((down * across).mean() / np.sqrt((down**2).mean() * (across**2).mean()))

    z = heeger_bergen(h, seed=1, decomposition=Decomposition(edges=edges))
    assert slope(h) * np.sign(angle) > 0.7
    assert slope(z) * np.sign(angle) > 0.4


@BOTH
@pytest.mark.parametrize("size", [(64, 80), (97, 50)])
def test_mean_and_variance_are_the_samples(edges, size):
    h = blobs()
    z = heeger_bergen(h, *size, seed=2, decomposition=Decomposition(edges=edges))
    expected = periodic_component(h) if edges == "periodic" else h
    assert z.shape == (*size, 3)
    np.testing.assert_allclose(z.mean((0, 1)), expected.mean((0, 1)), rtol=2e-3)
    # total variance: a sum over the principal axes, along which the histograms are right
    assert z.var((0, 1)).sum() == pytest.approx(expected.var((0, 1)).sum(), rel=1e-2)


def test_the_smooth_component_is_added_to_the_same_texture_where_it_fits():
    h = blobs() + np.linspace(0, 90, 80, dtype=np.float32)[None, :, None]
    with_smooth = heeger_bergen(h, seed=1, add_smooth=True)
    np.testing.assert_allclose(with_smooth, heeger_bergen(h, seed=1) + smooth_component(h), atol=1e-3)
    with pytest.raises(ValueError, match="own size"):
        heeger_bergen(h, 64, 81, add_smooth=True)
    with pytest.raises(ValueError, match="periodic edges"):
        heeger_bergen(h, decomposition=Decomposition(edges="mirror"), add_smooth=True)


@pytest.mark.parametrize("size", [(64, 80), (71, 101)])
def test_the_result_depends_on_the_seed_and_not_on_the_threads(size):
    h = blobs()
    one = heeger_bergen(h, *size, seed=3)
    assert (heeger_bergen(h, *size, seed=3, threads=2) == one).all()
    assert (heeger_bergen(h, *size, seed=4) != one).mean() > 0.9


def test_a_grey_image_stays_two_dimensional_and_equals_its_one_channel():
    h = blobs(channels=1)
    assert (heeger_bergen(h[:, :, 0], 70, 40, seed=2) == heeger_bergen(h, 70, 40, seed=2)[:, :, 0]).all()


@BOTH
def test_a_constant_image_gives_itself_back(edges):
    h = np.full((33, 40, 3), [0, 77, 255], np.float32)
    z = heeger_bergen(h, 50, 41, decomposition=Decomposition(edges=edges))
    np.testing.assert_allclose(z, np.broadcast_to(h[0, 0], z.shape), atol=1e-4)


def test_the_result_tiles_without_a_seam():
    rng = np.random.default_rng(0)
    h = np.cumsum(rng.normal(0, 10, (64, 64)), axis=1).astype(np.float32)  # strongly correlated along x
    z = heeger_bergen(h, 150, 131)
    across = z[:, 0] - z[:, -1]
    assert across.std() < 1.5 * np.diff(z, axis=1).std()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_that_are_not_finite_are_refused(bad):
    h = blobs()
    h[3, 4, 1] = bad
    with pytest.raises(ValueError, match="not finite"):
        heeger_bergen(h)


@pytest.mark.parametrize("stop_at", [1, 5, 60, 200])
@pytest.mark.parametrize("threads", [1, 2])
def test_what_the_progress_raises_stops_the_work(stop_at, threads):
    stops_at(stop_at, lambda progress: heeger_bergen(blobs(), threads=threads, progress=progress))


def test_the_progress_of_every_stage_rises_to_one():
    calls = []
    heeger_bergen(blobs(), iterations=2, threads=2, progress=lambda stage, part: calls.append((stage, part)))
    stages = {stage: [part for name, part in calls if name == stage] for stage, _ in calls}
    assert list(stages) == ["sample", "noise", "iteration 1", "iteration 2"]
    for parts in stages.values():
        assert parts == sorted(parts)
        assert (parts[0], parts[-1]) == (0, 1)


@BOTH
@pytest.mark.parametrize(("scales", "orientations"), [(4, 4), (1, 1), (2, 3), (3, 2)])
@pytest.mark.parametrize("size", [(33, 40), (48, 37)])
@pytest.mark.parametrize("iterations", [0, 2])
def test_with_every_option_it_is_the_synthesis_of_the_articles(edges, scales, orientations, size, iterations):
    """Written a second time with full transforms in double precision.

    Two values that single precision ranks the other way round change places, here or there: a thousandth of the
    contrast is far more than they make up together, and far less than any other decomposition does.
    """
    h = blobs(33, 40, 1)[:, :, 0]
    decomposition = Decomposition(scales, orientations, edges)
    z = heeger_bergen(h, *size, seed=3, decomposition=decomposition, iterations=iterations)
    sample = (periodic_component(h) if edges == "periodic" else h).astype(np.float64)
    options = {"scales": scales, "orientations": orientations, "edges": edges, "iterations": iterations}
    expected = plain.synthesis(sample, *size, seed=3, **options)
    assert np.sqrt(np.square(z - expected).mean()) < 1e-3 * h.std()


@BOTH
def test_the_distances_of_the_bands_are_those_of_their_quantiles_in_deviations(edges):
    """Recomputed from the plain bands of the texture and of the sample, in double precision."""
    h = blobs(33, 40, 1)
    sample, synthesis = begun(h, 48, 37, edges=edges)
    synthesis.iterate("1")
    found = synthesis.distances("distances")
    component, own = sample.channels[0].astype(np.float64), None
    if edges == "mirror":
        own = component.shape
        component = np.pad(component, ((0, 33), (0, 40)), mode="symmetric")
    of_sample, of_texture = (
        list(plain.bands(image, 4, 4, only))
        for image, only in ((component, own), (synthesis.channel(0).astype(np.float64), None))
    )
    for (band, distance), target, values in zip(found.items(), of_sample, of_texture, strict=True):
        wanted = plain.matched(values, target)
        deviation = np.sort(wanted, axis=None).std()
        expected = np.sqrt(np.square(np.sort(values, axis=None) - np.sort(wanted, axis=None)).mean()) / deviation
        assert distance == pytest.approx(expected, rel=1e-3, abs=1e-4), band

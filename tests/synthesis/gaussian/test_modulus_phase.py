"""The swap takes the modulus of one image and the phase of the other, and undoes itself."""

import numpy as np
import pytest

from app.synthesis.gaussian.modulus_phase import centred_phase, power, swap

SIZES = [(1, 1), (1, 12), (12, 1), (2, 3), (16, 16), (16, 17), (17, 16), (37, 41)]


def pair(height, width, channels=3):
    """Two images of values of 0–255, the second smoother than the first."""
    rng = np.random.default_rng(0)
    first = rng.uniform(0, 255, (height, width, channels))
    second = np.cumsum(rng.uniform(-20, 20, (height, width, channels)), axis=0) + 128
    return first.astype(np.float32), second.astype(np.float32)


def spectrum(picture):
    return np.fft.fft2(picture.astype(np.float64), axes=(0, 1))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3])
def test_swapping_twice_gives_the_images_back(size, channels):
    images = pair(*size, channels)
    for image, again in zip(images, swap(*swap(*images)), strict=True):
        np.testing.assert_allclose(again, image, atol=255 * 1e-4)


@pytest.mark.parametrize("size", SIZES)
def test_each_has_the_modulus_of_one_image_and_the_phase_of_the_other(size):
    images = pair(*size)
    for made, modulus, phase in zip(swap(*images), images, images[::-1], strict=True):
        expected = np.abs(spectrum(modulus)) * np.exp(1j * np.angle(spectrum(phase)))
        np.testing.assert_allclose(spectrum(made), expected, atol=1e-4 * np.abs(expected).max())


def test_mean_and_variance_go_with_the_modulus():
    images = pair(30, 41)
    for made, modulus in zip(swap(*images), images, strict=True):
        np.testing.assert_allclose(made.mean((0, 1)), modulus.mean((0, 1)), rtol=1e-5)
        np.testing.assert_allclose(made.var((0, 1)), modulus.var((0, 1)), rtol=1e-4)


def test_the_sign_of_the_mean_is_its_phase():
    first, second = pair(16, 17)
    made, other = swap(first - 300, second)
    np.testing.assert_allclose(made.mean((0, 1)), -(first - 300).mean((0, 1)), rtol=1e-5)
    np.testing.assert_allclose(other.mean((0, 1)), -second.mean((0, 1)), rtol=1e-5)


def test_an_image_swapped_with_itself_stays():
    image = pair(16, 17)[0]
    for made in swap(image, image):
        np.testing.assert_allclose(made, image, atol=1e-3)


def test_an_image_swapped_with_a_constant_keeps_its_own_phase():
    image, constant = pair(16, 17)[0], np.full((16, 17, 3), [0, 77, 255], np.float32)
    for made, expected in zip(swap(image, constant), (image, constant), strict=True):
        np.testing.assert_allclose(made, expected, atol=1e-3)
    for again, expected in zip(swap(*swap(constant, image)), (constant, image), strict=True):
        np.testing.assert_allclose(again, expected, atol=1e-3)


def test_contours_follow_the_phase():
    """With a white modulus and its own phase a square is all outline; with its modulus and a random phase it has none.

    The outline's 92 of 4096 pixels would hold a fortieth of the energy of a picture that knows nothing of it.
    """
    square = np.zeros((64, 64), np.float32)
    square[20:44, 20:44] = 255
    outline = square > 0
    outline[21:43, 21:43] = False
    noise = np.random.default_rng(1).normal(128, 40, (64, 64)).astype(np.float32)
    energies = [np.square(made - made.mean()) for made in swap(noise, square)]
    shares = [energy[outline].sum() / energy.sum() for energy in energies]
    assert shares[0] > 4 / 40
    assert shares[1] < 2 / 40


@pytest.mark.parametrize("size", SIZES)
def test_the_phase_picture_is_centred_and_odd(size):
    image = pair(*size)[0]
    phase = centred_phase(image)
    whole = np.fft.fftshift(np.fft.fft2(image.mean(axis=2)))
    assert phase.shape == size
    np.testing.assert_allclose(np.exp(1j * phase), whole / np.abs(whole), atol=1e-3)
    assert (centred_phase(image[:, :, 0]) == centred_phase(image[:, :, :1])).all()


def test_images_that_differ_in_shape_are_refused():
    with pytest.raises(ValueError, match="differ"):
        swap(pair(8, 9)[0], pair(9, 8)[0])


def test_the_result_does_not_depend_on_the_threads():
    images = pair(64, 65)
    for one, two in zip(swap(*images), swap(*images, threads=2), strict=True):
        assert (one == two).all()


def test_the_progress_rises_to_one():
    parts = []
    swap(*pair(16, 16), progress=lambda stage, part: parts.append(part))
    assert parts == sorted(parts)
    assert (parts[0], parts[-1]) == (0, 1)


def test_the_power_is_the_mean_square_of_the_moduli():
    image = pair(16, 17)[0]
    expected = np.square(np.abs(spectrum(image))).mean(axis=2)[:, :9]
    np.testing.assert_allclose(power(image.transpose(2, 0, 1)), expected, rtol=1e-3, atol=1e-6 * expected.max())

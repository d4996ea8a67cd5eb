"""Heeger and Bergen's synthesis as the articles write it: full transforms, double precision, `numpy.argsort`."""

import math

import numpy as np
from numpy.random import SFC64, Generator, SeedSequence


def cosine(t):
    return np.cos(np.pi / 2 * np.clip(t, -1, 1))


def responses(height, width, scales, orientations):
    """The frequency response of every band on the full spectrum, with the band's scale."""
    y, x = 2 * np.fft.fftfreq(height)[:, None], 2 * np.fft.fftfreq(width)
    r, theta = np.hypot(y, x), np.arctan2(y, x)
    with np.errstate(divide="ignore"):
        octave = np.log2(r)
    order = orientations - 1
    kappa = 2 ** (2 * order) * math.factorial(order) ** 2 / (orientations * math.factorial(2 * order))
    yield 0, cosine(np.minimum(octave, 0))
    for scale in range(scales):
        for orientation in range(orientations):
            angular = math.sqrt(kappa) * np.cos(theta - np.pi * orientation / orientations) ** order
            yield scale, (-1j) ** order * cosine(octave + scale + 1) * angular
    yield scales, cosine(np.maximum(octave + scales + 1, 0))


def frequencies(length):
    """Whole numbers of turns, in the order of `numpy.fft`."""
    return np.rint(np.fft.fftfreq(length) * length).astype(int)


def places(length, scale):
    """Where, in pixels, a band of a scale has its samples along an axis of the image."""
    count = -(-length // 2**scale)
    return np.arange(count) * length / count


def at_places(spectrum, rows, columns):
    """The image of a spectrum, evaluated wherever one likes; frequencies of the Nyquist rate as cosines."""
    height, width = spectrum.shape

    def waves(where, length):
        k = frequencies(length)
        turn = np.exp(2j * np.pi * np.outer(where, k) / length)
        return np.where(np.abs(k) * 2 == length, turn.real, turn)

    return (waves(rows, height) @ spectrum @ waves(columns, width).T).real / (height * width)


def bands(image, scales, orientations, own=None):
    """The bands' values; ``own``: those whose places lie within so many rows and columns of the image."""
    spectrum = np.fft.fft2(image)
    for scale, response in responses(*image.shape, scales, orientations):
        rows, columns = (places(length, scale) for length in image.shape)
        if own:
            rows, columns = rows[rows < own[0]], columns[columns < own[1]]
        yield at_places(spectrum * response, rows, columns)


def rebuilt(values, height, width, scales, orientations):
    """The image of all bands: each one's spectrum, filtered with the conjugate response, added up."""
    total = np.zeros((height, width), complex)
    for band, (_, response) in zip(values, responses(height, width, scales, orientations), strict=True):
        own = np.fft.fft2(band) / band.size
        whole = np.zeros((height, width), complex)
        whole[np.ix_(*map(frequencies, band.shape))] = own
        total += whole * response.conj() * height * width
    return np.fft.ifft2(total).real


def matched(values, target):
    """Values with the distribution of a target: the one of rank j becomes its quantile (j + ½) / n."""
    ordered, count = np.sort(target, axis=None), values.size
    wanted = np.interp((np.arange(count) + 0.5) * ordered.size / count - 0.5, np.arange(ordered.size), ordered)
    result = np.empty(count)
    result[np.argsort(values, axis=None, kind="stable")] = wanted
    return result.reshape(values.shape)


def synthesis(sample, height, width, *, seed, scales, orientations, edges, iterations):
    """The texture of one grey image, which is the periodic component already where the edges are periodic."""
    padded, own = sample, None
    if edges == "mirror":
        padded = np.block([[sample, sample[:, ::-1]], [sample[::-1], sample[::-1, ::-1]]])
        own = sample.shape
    wanted = list(bands(padded, scales, orientations, own))
    noise = Generator(SFC64(SeedSequence(seed, spawn_key=(0,)))).standard_normal((height, width), np.float32)
    texture = matched(noise, sample)
    for _ in range(iterations):
        found = bands(texture, scales, orientations)
        texture = rebuilt(
            [matched(band, target) for band, target in zip(found, wanted, strict=True)],
            height, width, scales, orientations,
        )  # fmt: skip
        texture = matched(texture, sample)
    return texture

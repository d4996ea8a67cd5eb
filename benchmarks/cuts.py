"""Colours of a texton cut to K × K pixels: what is kept of them by the program's way and by others that were tried.

Every way gives a kernel of rows (channels) and columns (noises); all of them but the first are then given the
covariance of the sample's colours by one matrix, so that they differ in the covariance of the colours of two places.
"""

from collections.abc import Callable

import numpy as np
from imagecodecs import imread
from numpy.typing import NDArray

from app.settings import ROOT
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.luminance import WEIGHTS

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

CROPS = {
    "leaves_forest_floor": (256, 256),
    "rockface_pink": (190, 60),
    "towel_red": (96, 96),
    "sand_desert009": (128, 64),
}
SIDE, NEAR = 256, 16
CUTS = (65, 31, 15, 7)
GREY = np.full((3, 3), 1 / 3)


def to_spectrum(kernel: Real) -> Complex:
    return np.fft.fft2(kernel, axes=(0, 1))


def to_kernel(spectrum: Complex) -> Real:
    return np.fft.ifft2(spectrum, axes=(0, 1)).real


def unit(values: Complex) -> Complex:
    """Over its modulus, 0 for 0."""
    modulus = np.abs(values)
    return values / np.where(modulus > 0, modulus, 1)


def inside(kernel: Real, cut: int) -> Real:
    """The square around the origin, zeros elsewhere."""
    lags = np.fft.fftfreq(SIDE, 1 / SIDE)
    there = (lags >= -(cut // 2)) & (lags < cut - cut // 2)
    return kernel * (there[:, None] & there).reshape(SIDE, SIDE, *([1] * (kernel.ndim - 2)))


def single(p: Complex) -> Complex:
    """The luminance's phase taken off every channel."""
    return (p * unit(p @ np.array(WEIGHTS)).conj()[:, :, None])[..., None]


def root(p: Complex) -> Complex:
    """p̂ p̂* / ‖p̂‖."""
    norm = np.linalg.norm(p, axis=2)[:, :, None, None]
    return p[..., :, None] * p[..., None, :].conj() / np.where(norm > 0, norm, 1)


def projected(p: Complex, cut: int, start: Complex, times: int) -> Real:
    """Support and spectrum by turns: to a spectrum t̂ belongs the nearest p̂ v*, ‖v‖ = 1."""
    kernel = inside(to_kernel(start), cut)
    for _ in range(times):
        towards = np.einsum("yxcj,yxc->yxj", to_spectrum(kernel), p.conj())
        norm = np.linalg.norm(towards, axis=2)[:, :, None]
        kernel = inside(to_kernel(p[..., None] * (towards / np.where(norm > 0, norm, 1))[:, :, None, :]), cut)
    return kernel


def smoothed_root(p: Complex, cut: int, reach: float) -> Real:
    """The Hermitian root of cross-spectra whose covariances were faded out linearly until ``reach`` times K."""
    lags = np.abs(np.fft.fftfreq(SIDE, 1 / SIDE))
    fade = np.clip(1 - lags / (reach * cut), 0, None)
    covariances = to_kernel(p[..., :, None] * p[..., None, :].conj()) * (fade[:, None] * fade)[..., None, None]
    values, axes = np.linalg.eigh(to_spectrum(covariances))
    roots = (axes * np.sqrt(np.clip(values, 0, None))[..., None, :]) @ np.swapaxes(axes.conj(), -1, -2)
    return inside(to_kernel(roots), cut)


def whitened(p: Complex, make: Callable[[Complex], Real]) -> Real:
    """The same for colours of covariance 1, and back."""
    values, axes = np.linalg.eigh(covariance(p[..., None])[0, 0])
    adjusted: Real = np.einsum(
        "ab,yxbj->yxaj", (axes * np.sqrt(values)) @ axes.T, make(p @ (axes / np.sqrt(values)) @ axes.T)
    )
    return adjusted


def covariance(spectrum: Complex) -> Real:
    """Of the colours at every lag, (H, W, C, C)."""
    return to_kernel(spectrum @ np.swapaxes(spectrum.conj(), -1, -2)) / SIDE**2


def set_right(kernel: Real, target: Real) -> Real:
    """R t, see app.synthesis.gaussian.cut_texton."""
    values, axes = np.linalg.eigh(covariance(without_mean(kernel))[0, 0])
    half, back = (axes * np.sqrt(values)) @ axes.T, (axes / np.sqrt(values)) @ axes.T
    values, axes = np.linalg.eigh(half @ target @ half)
    adjusted: Real = np.einsum(
        "ab,yxbj->yxaj", back @ (axes * np.sqrt(np.clip(values, 0, None))) @ axes.T @ back, kernel
    )
    return adjusted


def without_mean(kernel: Real) -> Complex:
    spectrum = to_spectrum(kernel)
    spectrum[0, 0] = 0
    return spectrum


WAYS: dict[str, Callable[[Complex, int], Real]] = {
    "one spot, factors per channel (before)": lambda p, cut: inside(to_kernel(single(p)), cut),
    "one spot": lambda p, cut: inside(to_kernel(single(p)), cut),
    "one spot, 30 projections": lambda p, cut: projected(p, cut, single(p), 30),
    "root": lambda p, cut: inside(to_kernel(root(p)), cut),
    "root, 30 projections": lambda p, cut: projected(p, cut, root(p), 30),
    "root of whitened colours": lambda p, cut: whitened(p, lambda q: inside(to_kernel(root(q)), cut)),
    "root of averages, lags to K": lambda p, cut: smoothed_root(p, cut, 1),
    "**root of averages, lags to 4 KN/(N − K)**": lambda p, cut: smoothed_root(p, cut, 4 * SIDE / (SIDE - cut)),
    "root of averages, lags to 8 KN/(N − K)": lambda p, cut: smoothed_root(p, cut, 8 * SIDE / (SIDE - cut)),
}


def measure(p: Complex, name: str, cut: int) -> tuple[float, ...]:
    """Errors in percent: at one place; at two at most; root mean square within 16 pixels, of all and of differences."""
    own, kernel = covariance(p[..., None]), WAYS[name](p, cut)
    if "before" in name:
        ratios = own[0, 0].diagonal() / covariance(without_mean(kernel))[0, 0].diagonal()
        kernel *= np.sqrt(ratios)[:, None]
    else:
        kernel = set_right(kernel, own[0, 0])
    model, chroma = covariance(without_mean(kernel)), np.eye(3) - GREY
    lags = np.abs(np.fft.fftfreq(SIDE, 1 / SIDE))
    near = np.maximum(lags[:, None], lags) <= NEAR
    off = np.linalg.norm(model - own, axis=(2, 3))
    colours_off, colours = (np.linalg.norm(chroma @ each @ chroma, axis=(2, 3)) for each in (model - own, own))
    return (
        100 * float(colours_off[0, 0] / colours[0, 0]),
        100 * float(off.max() / np.linalg.norm(own[0, 0])),
        100 * float(np.sqrt((off[near] ** 2).sum() / (np.linalg.norm(own, axis=(2, 3))[near] ** 2).sum())),
        100 * float(np.sqrt((colours_off[near] ** 2).sum() / (colours[near] ** 2).sum())),
    )


def main() -> None:
    for crop, (x, y) in CROPS.items():
        file = next((ROOT / "samples").glob(f"{crop}.*"))
        h = np.asarray(imread(file))[y : y + SIDE, x : x + SIDE, :3].astype(np.float32)
        p = without_mean(periodic_component(h).astype(np.float64))
        print(f"\n| {crop} | " + " | ".join(f"K = {cut}" for cut in CUTS) + " |\n|---|" + "---|" * len(CUTS))
        for name in WAYS:
            cells = (" / ".join(f"{value:.0f}" for value in measure(p, name, cut)) for cut in CUTS)
            print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()

"""Rendering of the bundled clips: real input for the video methods, each from a photograph or from noise.

Usage: drawn_clips.py [DIRECTORY [NAME …]]. Each is a function of nothing but a bundled photograph and the seeds below:
anybody can make it again.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter, map_coordinates, spline_filter

SIDE, FRAMES, RATE = 320, 72, 24
SAMPLES = Path(__file__).resolve().parent.parent / "samples"
BT_709, LIMITED_RANGE = 1, 1  # as H.264 numbers them

Real = NDArray[np.float64]
Pixels = NDArray[np.uint8]


def sky_pan() -> Iterator[Real]:
    """Clouds under a camera that drifts along an arc and comes a little nearer.

    Neither step nor magnification is a whole number of pixels, so that every frame samples the photograph anew.
    """
    splines = _splines(_photograph("sky_clouds.jpg"))
    y, x = _grid(SIDE) - (SIDE - 1) / 2
    for t in np.linspace(0, 1, FRAMES):
        pixel = 1 - 0.12 * t  # of the photograph in one of the clip
        yield _look(splines, 262 - 90 * np.sin(np.pi * t / 2) + pixel * y, 250 + 150 * t + pixel * x)


METRES = 0.002  # of a pixel: the ripples in the sand are then 10 cm apart
REFRACTION = 1 - 1 / 1.33  # a ray from straight above is turned by this part of the surface's slope
GRAVITY, TENSION = 9.81, 7.3e-5  # m/s²; m³/s², surface tension by density
SLOPE = 0.12  # of the water, root mean square
SLOWER = 3  # than it went: the camera took 72 frames a second
SUN = 80  # pixels that its rays, about 40° off the vertical, go on along each axis in the water
MARGIN = 48  # pixels around the picture from which light and sight may come
RAYS = 3  # along a pixel's side


def sand_under_water() -> Iterator[Real]:
    """Rippled sand under forty centimetres of clear water in a breeze: the sun draws a net of bright lines."""
    return _under_water("sand_desert009.png", 352, 96, depth=0.4, waves=11)


def leaves_under_water() -> Iterator[Real]:
    """Fallen leaves on the ground of a shallow pool: each stays where it is, and wavers."""
    return _under_water("leaves_forest_floor.jpg", 272, 272, depth=0.25, waves=12)


def _under_water(name: str, top: int, left: int, *, depth: float, waves: int) -> Iterator[Real]:
    """What lies in this corner of a photograph, under ``depth`` metres of water.

    The surface is a sum of travelling waves with the dispersion relation of water, ω² = (g k + τ k³) tanh(k h). Its
    slope bends the sun's light, which gathers in bright lines on the ground, and, at another place, the view of it.
    """
    rng = np.random.default_rng(waves)
    count = 60
    k = 2 * np.pi / np.exp(rng.uniform(np.log(0.06), np.log(0.5), count))  # radians a metre
    towards = rng.normal(0.6, 1.1, count)
    omega = np.sqrt((GRAVITY * k + TENSION * k**3) * np.tanh(k * depth))
    phase = rng.uniform(0, 2 * np.pi, count)
    slope = SLOPE * np.sqrt(2 / (k * np.sum(1 / k)))
    side = SIDE + 2 * MARGIN
    ground = _photograph(name)[top : top + side, left : left + side]
    ray = (np.arange(RAYS * side) + 0.5) / RAYS - 0.5
    rays = np.stack(np.meshgrid(ray, ray, indexing="ij"))

    down, across = np.sin(towards) * k, np.cos(towards) * k

    def shift(at: Real, t: float) -> Real:
        """Pixels by which rays that pass the surface at rows and columns ``at`` come off the vertical, y then x."""
        amplitudes = -depth * REFRACTION / METRES * slope * np.exp(1j * (phase - omega * t))
        parts = [amplitudes * each / k for each in (down, across)]
        return np.stack([_waves(METRES * down, METRES * across, part, at) for part in parts])

    view = np.arange(side, dtype=float)
    for frame in range(FRAMES):
        t = frame / RATE / SLOWER
        fallen = np.rint(shift(ray + SUN, t) + rays).astype(np.intp).clip(0, side - 1)
        light = np.bincount(np.ravel_multi_index(fallen, (side, side)).ravel(), minlength=side**2)
        # The sun's disc, half a degree wide, blurs its picture at this depth by about a pixel.
        sun = gaussian_filter(light.reshape(side, side) / RAYS**2, 0.9)
        lit = ground * (0.5 + 0.6 * np.log1p(sun))[:, :, None] * (0.88, 1.03, 1.08)
        y, x = shift(view, t) + _grid(side)
        inside = slice(MARGIN, MARGIN + SIDE)
        yield _look(_splines(lit), y[inside, inside], x[inside, inside])


LIFE, LAYERS = 36, 3  # frames that a layer of noise lasts; layers at a time


def advected_noise() -> Iterator[Real]:
    """Coloured noise that rises and curls in a slowly changing flow without sources, as smoke over a fire.

    Three noises at a time are carried by the flow, each from its own start on; they fade in and out by turns such that
    the sum of their squared weights is constant, and so is the variance of what is seen.
    """
    rng = np.random.default_rng(5)
    down, across = rng.integers(-4, 5, (2, 30)) * 2 * np.pi / SIDE
    speed = rng.normal(0, 0.14, 30) * np.exp(1j * rng.uniform(0, 2 * np.pi, 30))  # pixels a frame
    turn = rng.normal(0, 0.04, 30)  # radians a frame
    grid, at = _grid(SIDE), np.arange(SIDE, dtype=float)

    def flow(frame: int) -> Real:
        """Pixels a frame, down and across: what rises, and waves that run across their own direction."""
        long = np.maximum(np.hypot(down, across), np.pi / SIDE)
        parts = [speed * np.exp(1j * turn * frame) * each / long for each in (across, -down)]
        rise = np.array([1.6, 0])[:, None, None]
        return np.asarray(np.stack([_waves(down, across, part, at) for part in parts]) - rise)

    layers: dict[int, tuple[Real, Real]] = {}  # a noise, and how far each place's has come
    for frame in range(-LIFE, FRAMES):
        step, seen = flow(frame), np.zeros((SIDE, SIDE, 2))
        for layer in range(LAYERS):
            age = (frame + layer * LIFE // LAYERS) % LIFE
            if age == 0:
                layers[layer] = _splines(_smoke(rng)), np.zeros((2, SIDE, SIDE))
            if layer not in layers:
                continue
            noise, shift = layers[layer]
            shift = np.stack([map_coordinates(each, grid - step, order=1, mode="grid-wrap") for each in shift]) - step
            layers[layer] = noise, shift
            if frame >= 0:
                y, x = grid + shift
                seen += np.sin(np.pi * (age + 0.5) / LIFE) * _look(noise, y, x, mode="grid-wrap")
        if frame >= 0:
            glow, haze = np.sqrt(2 / LAYERS) * np.moveaxis(seen, 2, 0)
            yield np.stack([150 + 44 * glow + 8 * haze, 92 + 34 * glow - 2 * haze, 62 + 17 * glow - 12 * haze], axis=2)


def _smoke(rng: np.random.Generator) -> Real:
    """Two independent noises of the torus, (SIDE, SIDE, 2), whose spectrum falls as of turbulence; variance 1."""
    down, across = np.fft.fftfreq(SIDE)[:, None], np.fft.rfftfreq(SIDE)
    k = np.hypot(down, across)
    gain = (k**2 + 0.012**2) ** -0.85 * np.exp(-((k / 0.22) ** 2))
    gain[0, 0] = 0
    planes = [np.fft.irfft2(np.fft.rfft2(rng.normal(size=(SIDE, SIDE))) * gain, s=(SIDE, SIDE)) for _ in range(2)]
    return np.stack([plane / plane.std() for plane in planes], axis=2)


CLIPS = {clip.__name__: clip for clip in (sand_under_water, leaves_under_water, sky_pan, advected_noise)}


def _waves(down: Real, across: Real, amplitude: NDArray[np.complex128], at: Real) -> Real:
    """Real part of a sum of plane waves, of these radians a pixel, at the rows and the columns ``at``."""
    columns = np.exp(1j * np.outer(across, at))
    return np.asarray(((amplitude * np.exp(1j * np.outer(at, down))) @ columns).real)


def _photograph(name: str) -> Real:
    with Image.open(SAMPLES / name) as picture:
        return np.asarray(picture.convert("RGB"), np.float64)


def _grid(side: int) -> Real:
    return np.mgrid[:side, :side].astype(np.float64)


def _splines(picture: Real) -> Real:
    """Cubic splines through a picture's values, (C, H, W)."""
    return np.stack([spline_filter(plane, order=3, mode="mirror") for plane in np.moveaxis(picture, 2, 0)])


def _look(splines: Real, y: Real, x: Real, mode: str = "mirror") -> Real:
    """What lies at these rows and columns, (H, W, C)."""
    return np.stack([map_coordinates(plane, (y, x), order=3, mode=mode, prefilter=False) for plane in splines], axis=2)


def write(path: Path, frames: Iterator[Real]) -> None:
    """Write an H.264 video that every browser plays."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=RATE, options={"crf": "16", "preset": "slow"})
        stream.width = stream.height = SIDE
        stream.pix_fmt = "yuv420p"
        coder = stream.codec_context
        coder.colorspace = coder.color_primaries = coder.color_trc = BT_709
        coder.color_range = LIMITED_RANGE
        for values in frames:
            pixels: Pixels = np.clip(np.rint(values), 0, 255).astype(np.uint8)
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
            container.mux(stream.encode(frame.reformat(format="yuv420p", dst_colorspace=BT_709)))
        container.mux(stream.encode())


if __name__ == "__main__":
    directory = Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLES
    for name in sys.argv[2:] or CLIPS:
        write(directory / f"{name}.mp4", CLIPS[name]())

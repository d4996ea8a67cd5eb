"""Video RPN, random phase noise in three dimensions: a Gaussian dynamic texture.

    Ẑ(ω, ξ) = ĥ(ω, ξ) exp(iθ(ω, ξ)),   θ odd, uniform on ]−π, π], θ(0, 0) = 0,

the same θ for every channel. The result is periodic in space and in time. A video hardly ever is: the jumps between
opposite borders, and between its last frame and its first, would come back as streaks and as a flicker over all of it.
So every frame is replaced by its periodic component, and the jump J(ξ) that is left between the last frame and the
first is taken out as Moisan does it along one more axis, a frame counting as a pixel:

    ŝ(ω, ξ) = Ĵ(ξ) (1 − exp(2πi k/T)) / (4 sin²(π k/T) + 4 sin²(π k₁/H) + 4 sin²(π k₂/W)),   ω = 2πk/T.

That leaves k = 0, and with it the average frame and all that stands still, as it is. (In features of more than 50
pixels of the bundled sky and smoke the mean square difference between frames is 9.1 and 3.2 times the clip's own with
the jump, 0.9 and 0.9 without; that of second differences 102 and 49 against 1.2 and 1.3.)

A larger or longer video is made from the extended spot, see `microtexture.fourier.spot`; what does not change with
time is kept out of the window along time, so that what stands still does so for as long. One factor at the end gives
the whole video the clip's variance, the mean over the channels.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011; Xia, Ferradans, Peyré, Aujol,
"Synthesizing and Mixing Stationary Gaussian Texture Models", SIAM J. Imaging Sciences 2014, for dynamic textures.
"""

from collections.abc import Callable, Iterator
from math import sqrt
from typing import Any

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from ..arrays import Complex, Double, Progress, Real, ignore_progress
from ..fourier.periodic import SmoothSpectrum
from ..fourier.spectral import half_spectrum
from ..fourier.spot import Profile, Spot, fade, window
from ..fourier.spot_noise import transform
from ..parallel import Team
from .rpn import random_phase
from .video_phase import conjugate_rows, random_phase_rows
from .video_power import VideoPower

Video = NDArray[Any]


def jump_share(frames: int, height: int, width: int, rows: list[int]) -> Complex:
    """Compute ŝ / Ĵ at some rows of the half spectrum; see the module.

    Parameters
    ----------
    frames, height, width : int
        Size of the video.
    rows : list of int
        k₁, 0 first if it is among them.

    Returns
    -------
    ndarray of complex64, shape (frames, rows, width // 2 + 1)
    """
    k = 2 * np.pi * np.arange(frames) / frames
    down, across = (4 * np.sin(np.pi * each) ** 2 for each in (np.array(rows) / height, np.fft.rfftfreq(width)))
    below = 2 - 2 * np.cos(k)[:, None, None] + down[:, None] + across
    if rows[0] == 0:
        below[0, 0, 0] = np.inf
    share: Complex = ((1 - np.exp(1j * k))[:, None, None] / below).astype(np.complex64)
    return share


def centre_video(video: Video, shape: tuple[int, int, int]) -> Video:
    """Cut a video to its centre, at most ``shape`` (frames, height, width) of it; a view."""
    starts = (max(0, (have - most) // 2) for have, most in zip(video.shape, shape, strict=False))
    return video[tuple(slice(start, start + most) for start, most in zip(starts, shape, strict=True))]


class VideoNoiseField:
    """RPN of a video, prepared up to its last transform: `frames` yields its frames, any number of times.

    Parameters
    ----------
    video : ndarray, shape (T, H, W, C)
        Finite; any range. Along an axis that is longer than the texture's, its centre is taken.
    shape : tuple of int
        Frames, height and width of the texture.
    seed : int
        Not negative.
    alpha, profile
        The spot's transition along an axis that is extended, see `microtexture.fourier.spot.window`.
    team : Team
        The threads that work.
    progress : callable ``(stage, part)``
        Called between pieces of work; what it raises stops the work.

    Attributes
    ----------
    mean : ndarray of float64, shape (C,)
    power : ndarray of float32, shape (height, width // 2 + 1)
        Squared modulus of the texture's spectrum, the sum over channels and frequencies in time.
    power_in_time : ndarray of float32, shape (frames, width // 2 + 1)
        The sum over channels and the few rows next to k₁ = 0, by frequency in time: a steady motion is a slanted line.
    still : float
        Part of the texture's variance that does not change with time, 0–1.
    """

    def __init__(
        self,
        video: Video,
        shape: tuple[int, int, int],
        *,
        seed: int,
        alpha: float,
        profile: Profile,
        team: Team,
        progress: Progress,
    ) -> None:
        self.shape, self._seed, self._alpha, self._profile = shape, seed, alpha, profile
        self._team, self._progress = team, progress
        video = centre_video(video, shape)
        self.mean = video.mean(axis=(0, 1, 2), dtype=np.float64)
        extended = video.shape[:3] != shape
        spectrum = self._frame_spectra(video, ("periodic", 0.0, 0.5 if extended else 1.0))
        jump = spectrum[:, 0] - spectrum[:, -1]
        drawing = ("random phase", 0.0, 1.0)
        if extended:
            own = self._in_time(spectrum, video.shape[2], ("periodic", 0.5, 1.0), jump=jump)
            spectrum, still = self._extend(spectrum, video.shape[2])
            noise = self._in_time(spectrum, shape[2], drawing, still=still, randomise=True)
            gain = sqrt(own.variance / noise.variance) if noise.variance > 0 else 1.0
        else:
            noise = self._in_time(spectrum, shape[2], drawing, jump=jump, randomise=True)
            gain = 1.0
        self._spectrum, self._gain = spectrum, np.float32(gain)
        self.power, self.power_in_time = (power * np.float32(gain**2) for power in (noise.power, noise.in_time))
        self.still = noise.still

    def frames(self) -> Iterator[Real]:
        """Compute frame after frame, (height, width, C); values may lie outside the video's range."""
        mean = self.mean.astype(np.float32)[:, None, None]
        for index in range(self.shape[0]):
            planes: Real = scipy.fft.irfft2(self._spectrum[:, index], s=self.shape[1:], workers=self._team.threads)
            planes *= self._gain
            planes += mean
            yield planes.transpose(1, 2, 0)

    def _run(self, task: Callable[[int], None], count: int, stage: tuple[str, float, float]) -> None:
        name, begin, end = stage
        self._team.run(task, range(count), lambda part: self._progress(name, begin + (end - begin) * part))

    def _frame_spectra(self, video: Video, stage: tuple[str, float, float]) -> Complex:
        """Half spectra of the frames' periodic components without the mean, (C, T, H, W // 2 + 1)."""
        frames, height, width, channels = video.shape
        spectrum = np.empty((channels, frames, height, width // 2 + 1), np.complex64)
        mean = self.mean.astype(np.float32)

        def transform_frame(index: int) -> None:
            h = video[index] - mean
            spectrum[:, index] = scipy.fft.rfft2(h.transpose(2, 0, 1), workers=1)
            spectrum[:, index] -= SmoothSpectrum(h).whole()

        self._progress("periodic", 0.0)
        self._run(transform_frame, frames, stage)
        return spectrum

    def _in_time(
        self,
        spectrum: Complex,
        width: int,
        stage: tuple[str, float, float],
        *,
        jump: Complex | None = None,
        still: Complex | None = None,
        randomise: bool = False,
    ) -> VideoPower:
        """Go to frequencies in time and back, in place, row by row of the frames' spectra.

        ``jump`` (C, H, columns) is taken out; ``still``, of the same shape, is added to every frame; the mean becomes 0
        and, with ``randomise``, the phase random.
        """
        _, frames, height, _ = spectrum.shape
        flat = half_spectrum(random_phase, height, width, self._seed) if randomise else None
        measure = VideoPower(spectrum.shape[1:], width)

        def transform_rows(row: int) -> None:
            rows = conjugate_rows(row, height)
            smooth = None if jump is None else jump_share(frames, height, width, rows) * jump[:, None, rows]
            phase = None if flat is None else random_phase_rows((frames, height, width), row, flat, self._seed)
            for channel, planes in enumerate(spectrum):
                block: Complex = scipy.fft.fft(planes[:, rows], axis=0, overwrite_x=True, workers=1)
                if smooth is not None:
                    block -= smooth[channel]
                if still is not None:
                    block[0] += frames * still[channel, rows]
                if row == 0:
                    block[0, 0, 0] = 0
                measure(row, rows, block)
                if phase is not None:
                    block *= phase
                planes[:, rows] = scipy.fft.ifft(block, axis=0, overwrite_x=True, workers=1)

        self._run(transform_rows, height // 2 + 1, stage)
        return measure

    def _extend(self, spectrum: Complex, width: int) -> tuple[Complex, Complex]:
        """Spectra of the extended spot's frames, (C, frames, height, columns), and of what stands still in it."""
        channels, count, high, _ = spectrum.shape
        frames, height, across = self.shape
        phi = window(count, self._alpha, self._profile) if frames > count else np.ones(count)
        # What stands still is the mean that leaves nothing of it in the rest, once that is faded in and out.
        weights = (phi / phi.sum()).astype(np.float32)
        average = np.einsum("cthw,t->chw", spectrum, weights)
        gains = (phi * np.sqrt(frames / count)).astype(np.float32)
        wider = np.float32(sqrt(height * across / (high * width)))
        extended = np.zeros((channels, frames, height, across // 2 + 1), np.complex64)
        top = (frames - count) // 2

        def spread(planes: Complex) -> tuple[Complex, Double]:
            """A frame's spectrum at the texture's size, but for its mean, and this."""
            p: Real = scipy.fft.irfft2(planes, s=(high, width), workers=1)
            mean = p.mean((1, 2), dtype=np.float64)
            p -= mean.astype(np.float32)[:, None, None]
            fade(p, height, across, self._alpha, self._profile)
            p *= wider
            spread = np.stack([transform(plane, Spot(p, mean, height, across)) for plane in p])
            spread[:, 0, 0] = 0
            return spread, mean

        def spread_frame(index: int) -> None:
            frame, mean = spread(spectrum[:, index] - average)
            frame[:, 0, 0] = height * across * mean
            np.multiply(frame, gains[index], out=extended[:, top + index])

        self._run(spread_frame, count, ("spot", 0.0, 1.0))
        return extended, spread(average)[0]


def video_rpn(
    video: Video,
    frames: int | None = None,
    height: int | None = None,
    width: int | None = None,
    *,
    seed: int = 0,
    alpha: float = 0.1,
    window: Profile = "bump",
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Synthesize the RPN of a video in three dimensions, of any length and size.

    Parameters
    ----------
    video : ndarray, shape (T, H, W, C)
        Any number of channels, any range, finite.
    frames, height, width : int, optional
        Length and size of the texture; default: the video's. Along a longer axis the spot is extended (see
        `microtexture.fourier.spot`), along a shorter one the video's centre is taken.
    seed : int
        Not negative; the result depends on nothing else.
    alpha, window
        The spot's transition, see `microtexture.fourier.spot.window`.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between pieces of work; what it raises stops it.

    Returns
    -------
    ndarray of float32, shape (frames, height, width, C)
        Periodic in space and in time; values may lie outside the video's range.

    Raises
    ------
    ValueError
        If values are not finite.

    Examples
    --------
    >>> video = np.random.default_rng(0).random((6, 16, 20, 3), np.float32)
    >>> z = video_rpn(video, 8, 24, 20, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1, 2)), video.mean((0, 1, 2))))
    ((8, 24, 20, 3), True)
    """
    if not np.isfinite(video).all():
        raise ValueError("The video holds values that are not finite.")
    shape = (frames or video.shape[0], height or video.shape[1], width or video.shape[2])
    with Team(threads) as team:
        report = progress or ignore_progress
        field = VideoNoiseField(video, shape, seed=seed, alpha=alpha, profile=window, team=team, progress=report)
        return np.stack(list(field.frames()))

"""Clips: what every decoder of a video or an animation returns, and the limits that they share."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from app.errors import TooLargeError
from app.images.media import STILL, Media
from app.images.png_writer import Pixels

SLOWEST, FASTEST = 1.0, 120.0
USUAL_RATE = 25.0
ROUNDING = 0.0015  # seconds: of two times to milliseconds, and a little


@dataclass(frozen=True)
class ClipLimits:
    """Limits of a video: number of frames, seconds for which it plays, pixels of all its frames together."""

    frames: int
    seconds: float
    pixels: int


class TimedFrame(NamedTuple):
    """A frame and when it is shown: ``pixels`` is (H, W, C) uint8, upright and in sRGB, C as `ClipStream.channels`."""

    pixels: Pixels
    seconds: float


@dataclass(frozen=True)
class ClipStream:
    """An uploaded video or animation, whose ``frames`` are decoded while they are taken, once.

    ``channels`` is 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha; ``media_type`` is what the file is,
    ``nominal_rate`` the frames a second that its header names, 0 if none.
    """

    width: int
    height: int
    channels: int
    media_type: str
    frames: Iterator[TimedFrame]
    nominal_rate: float = 0.0

    def media(self, times: Sequence[float]) -> Media:
        """Describe the clip once all its frames were taken; ``times`` are the seconds at which each is shown."""
        return Media(
            self.width,
            self.height,
            channels=1 if self.channels < 3 else 3,
            depth=8,
            transparent=self.channels % 2 == 0,
            frames=len(times),
            rate=estimate_rate(times, self.nominal_rate),
            media_type=self.media_type if len(times) > 1 else STILL,
        )


def check_clip(width: int, height: int, frames: int, seconds: float, limits: ClipLimits, *, more: bool = False) -> None:
    """Refuse a video that exceeds a limit.

    Parameters
    ----------
    width, height : int
        Of a frame.
    frames : int
        How many there are.
    seconds : float
        For which it plays; 0 if unknown.
    limits : ClipLimits
    more : bool, optional
        Whether more frames may follow.

    Raises
    ------
    TooLargeError
        With the limits, and how much shorter or smaller the video must be.

    Examples
    --------
    >>> check_clip(1920, 1080, 72, 3.0, ClipLimits(frames=600, seconds=60, pixels=1 << 28))
    """
    area = width * height
    if frames <= limits.frames and seconds <= limits.seconds and area * frames <= limits.pixels:
        return
    rate = frames / seconds if seconds else 0.0
    short_enough = min(frames, limits.frames, int(limits.seconds * rate) if rate else frames)
    few_enough = min(short_enough, limits.pixels // area)
    advice = [f"trim it to its first {_describe_length(few_enough, rate)}"] if few_enough > 1 else []
    if few_enough < short_enough:
        scale = (limits.pixels / (area * short_enough)) ** 0.5
        smaller = f"{max(1, int(width * scale))} × {max(1, int(height * scale))} pixels"
        shorten = short_enough < frames or more
        rest = f" and trim it to its first {_describe_length(short_enough, rate)}" if shorten else ""
        advice.append(f"scale it to {smaller}{rest}")
    raise TooLargeError(
        f"The video has {'at least ' if more else ''}{_describe_length(frames, rate)} of {width} × {height} pixels; "
        f"at most {limits.frames:,} frames, {limits.seconds:g} seconds and {limits.pixels / 1e6:,.1f} megapixels "
        f"(all frames together) are accepted. {', or '.join(advice).capitalize() or 'Trim it'}, and upload it again."
    )


def limit_clip(frames: Iterator[TimedFrame], limits: ClipLimits) -> Iterator[TimedFrame]:
    """Pass frames on until one exceeds a limit: the length in a file's header may be wrong.

    Raises
    ------
    TooLargeError
        As `check_clip`.
    """
    start = None
    for count, frame in enumerate(frames, 1):
        start = frame.seconds if start is None else start
        height, width = frame.pixels.shape[:2]
        check_clip(width, height, count, frame.seconds - start, limits, more=True)
        yield frame


def estimate_rate(seconds: Sequence[float], nominal: float = 0.0) -> float:
    """Estimate the frames a second from the times of the frames.

    Parameters
    ----------
    seconds : sequence of float
        When each frame is shown.
    nominal : float, optional
        The rate that the header names; 0 if none.

    Returns
    -------
    float
        The average, between 1 and 120; 0 of a single frame. An average that the rounding of times to milliseconds
        alone may have moved away from the nominal rate, or else from a usual one, is that rate.

    Examples
    --------
    >>> estimate_rate([0.0]), estimate_rate([0.0, 0.033, 0.067, 0.1]), estimate_rate([0.0, 0.4, 0.5])
    (0.0, 30.0, 4.0)
    """
    if len(seconds) < 2:
        return 0.0
    intervals, span = len(seconds) - 1, seconds[-1] - seconds[0]
    rate = intervals / span if span > 0 else USUAL_RATE
    usual = min((float(round(rate)), round(rate) / 1.001), key=lambda each: abs(each - rate))
    likely = (each for each in (nominal, usual) if each and abs(intervals / each - span) <= ROUNDING)
    return min(FASTEST, max(SLOWEST, next(likely, round(rate, 3))))


def _describe_length(frames: int, rate: float) -> str:
    return f"{frames:,} frames" + (f" ({frames / rate:.1f} seconds)" if rate else "")

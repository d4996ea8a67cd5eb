"""`video-rpn`: random phase noise in three dimensions."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.methods.context import Context, Progress
from app.methods.explanations.references import GAUSSIAN_MIXING, IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.explanations.video_rpn import EXPLANATION
from app.methods.gaussian.params import SpotParams, not_extended
from app.methods.model import Fact, Method, Picture, Size, Slot, Source
from app.methods.output.pictures import encode, log_modulus
from app.methods.output.videos import encode_crop, encode_texture, encoding_bytes
from app.methods.outputs import SHOWN_CLIP, VIDEO_OUTPUTS, views
from app.methods.params import MovingParams, Resolved
from app.methods.stages import Plan
from app.synthesis.arrays import Bytes, Real
from app.synthesis.gaussian.video_rpn import VideoNoiseField
from app.synthesis.parallel import Team

CUBES = ("crop-cube", "cube")
FRAMES, ROWS = 16, 24  # of floats: averages, powers and the like; rows of all frames, which the threads have in hand


class VideoRpnParams(SpotParams, MovingParams):
    """Parameters of random phase noise in three dimensions."""


def memory(sizes: Sequence[Size], resolved: Resolved[VideoRpnParams]) -> int:
    """The clip, its half spectrum, that of the texture where the two differ, some frames, and the encoders."""
    clip = sizes[0]
    frames, height, width = shape = resolved.shape
    inside = min(frames, clip.frames), min(height, clip.height), min(width, clip.width)
    needed = clip.channels * clip.frames * clip.height * clip.width + _spectrum_bytes(inside, clip.channels)
    if inside != shape:
        needed += _spectrum_bytes(shape, clip.channels)
    wide, high = max(width, clip.width), max(height, clip.height)
    floats = clip.channels * wide * (FRAMES * high + ROWS * max(frames, clip.frames))
    return needed + 4 * floats + encoding_bytes(wide, high, clip.channels)


def _spectrum_bytes(shape: tuple[int, int, int], channels: int) -> int:
    frames, height, width = shape
    return channels * frames * height * (width // 2 + 1) * np.dtype(np.complex64).itemsize


def run(sources: Sequence[Source], resolved: Resolved[VideoRpnParams], context: Context) -> Iterator[Picture]:
    """The texture's files, then what was measured on the way, then the crop's."""
    source = sources[0]
    video, rate = source.require_clip().frames, source.require_clip().rate
    params, shape = resolved.params, resolved.shape
    with Team(context.threads) as team:
        field = VideoNoiseField(
            video,
            shape,
            seed=params.seed,
            alpha=params.alpha,
            profile=params.window,
            team=team,
            progress=context.progress,
        )
        yield from encode_texture(
            _reported(field, context.progress),
            width=shape[2],
            height=shape[1],
            channels=video.shape[3],
            count=shape[0],
            rate=rate,
            context=context,
        )
    yield from _views(video, field, context)
    del field  # its spectrum, before the encoders take their memory again
    yield from encode_crop(source, context)


def stages(sizes: Sequence[Size], resolved: Resolved[VideoRpnParams]) -> Plan:
    """Of a clip of another size or length the spot is extended."""
    clip = sizes[0]
    extending = (("spot", 3),) if resolved.shape != (clip.frames, clip.height, clip.width) else ()
    return (
        ("periodic", 4),
        *extending,
        ("random phase", 11),
        ("texture", 45),
        ("encoding", 10),
        ("spectrum", 2),
        ("crop", 28),
    )


def _reported(field: VideoNoiseField, progress: Progress) -> Iterator[Real]:
    for index, frame in enumerate(field.frames()):
        progress("texture", index / field.shape[0])
        yield frame


def _views(video: Bytes, field: VideoNoiseField, context: Context) -> Iterator[Picture]:
    """The average frame, and two sections through the block of the squared moduli."""
    context.progress("spectrum", 0)
    still = Fact("still", "Part of the texture's contrast that stands still", 100 * field.still, "% of the variance")
    average = video.mean(axis=0, dtype=np.float64).astype(np.float32)
    yield encode("average", "Average frame of the crop", average, 255, context, facts=(still,))
    _, _, width = field.shape
    yield log_modulus("spectrum", "Log-modulus over space, all times together", field.power, width, context)
    title = "Log-modulus over time (downwards) and across"
    yield log_modulus("spectrum-in-time", title, field.power_in_time, width, context)


VIDEO_RPN = Method(
    name="video-rpn",
    title="Random phase noise in three dimensions (video RPN)",
    summary="Keeps the Fourier modulus of a clip over time and space and draws its phase at random.",
    inputs=(Slot("clip", "Clip", "A video; crop a rectangle and a time in which all looks alike.", moving=True),),
    params=VideoRpnParams,
    references=(RANDOM_PHASE_TEXTURES, GAUSSIAN_MIXING, IPOL_RPN, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    run=run,
    outputs=(*VIDEO_OUTPUTS, *views("average", of=()), *views("spectrum", "spectrum-in-time", deep=False), *SHOWN_CLIP),
    idle=not_extended,
    stages=stages,
    memory=memory,
)

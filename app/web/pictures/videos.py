"""Videos of an experiment on its pages: sources, poster, frames and rate."""

from dataclasses import dataclass

from app.experiments.files.outputs import MP4_SUFFIX
from app.experiments.files.renditions import POSTERS
from app.experiments.model import Experiment, Output
from app.web.pictures.addresses import output_url


@dataclass(frozen=True)
class Video:
    """A video; ``sources`` are (address, media type), the best first."""

    sources: tuple[tuple[str, str], ...]
    poster: str
    frames: int
    rate: float


def find_video(experiment: Experiment, output: Output) -> Video | None:
    """The video that an output is, None for a picture."""
    if not output.video:
        return None
    other = experiment.output(f"{output.name}{MP4_SUFFIX}")
    files = [output] if other is None else [output, other]
    return Video(
        sources=tuple((output_url(experiment, file.name), file.media_type) for file in files),
        poster=output_url(experiment, POSTERS[output.name]),
        frames=output.frames,
        rate=output.rate,
    )


def is_video(experiment: Experiment) -> bool:
    """Whether its texture is a video."""
    texture = experiment.output("texture")
    return texture is not None and texture.video

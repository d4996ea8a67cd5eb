"""Addresses of pictures and videos on pages, each with the version of its bytes (`v`): browsers may keep those."""

from typing import Literal, Protocol
from urllib.parse import urlencode

from app.experiments.files.renditions import derived_digest, is_derived
from app.experiments.files.versions import made_version, stored_version
from app.experiments.model import Experiment, deep_name


class Stored(Protocol):
    """What a sample and an offer of one have in common."""

    @property
    def id(self) -> str: ...

    @property
    def digest(self) -> str: ...


def sample_image_url(sample: Stored, size: int, frame: int = 0) -> str:
    """Where a sample is as a picture; of a video one frame."""
    which = {"frame": frame} if frame else {}
    return f"{_sample(sample)}/image?{urlencode({'size': size, **which, 'v': made_version(sample.digest)})}"


def sample_video_url(sample: Stored) -> str:
    """Where a sample plays."""
    return f"{_sample(sample)}/video?v={made_version(sample.digest)}"


def output_url(
    experiment: Experiment,
    name: str,
    *,
    download: bool = False,
    file_format: str | None = None,
    depth: Literal[8, 16] | None = None,
) -> str:
    """Where an output is: as it is stored, or in another format and depth; with no version if it is yet to be made."""
    query: dict[str, str | int] = {}
    if download:
        query["download"] = "true"
    if file_format is not None:
        query["format"] = file_format
    if depth is not None:
        query["depth"] = depth
    found = _version(experiment, name, converted=file_format is not None or depth is not None, depth=depth)
    if found is not None:
        query["v"] = found
    return f"/api/v1/experiments/{experiment.id}/outputs/{name}?{urlencode(query)}".rstrip("?")


def display_url(experiment: Experiment, name: str) -> str:
    """Where an output is as pages show it: a screen shows no more than 8 bits, and they are half as many bytes."""
    return output_url(experiment, name, depth=8 if experiment.depth == 16 else None)


def _sample(sample: Stored) -> str:
    return f"/api/v1/samples/{sample.id}"


def _version(experiment: Experiment, name: str, *, converted: bool, depth: int | None) -> str | None:
    if is_derived(name):
        crop, texture = experiment.output("crop"), experiment.output("texture")
        return None if crop is None or texture is None else stored_version(derived_digest(name, crop, texture))
    output = experiment.output(name)
    if depth == 16 and experiment.depth != 16:
        output = experiment.output(deep_name(name))
    if output is None:
        return None
    return made_version(output.digest) if converted else stored_version(output.digest)

"""Panes of the viewer: the pictures of an experiment, with their structure index."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from app.errors import NotFoundError
from app.experiments.model import Experiment, Output
from app.methods.model import Method
from app.methods.registry import method
from app.web.form.inputs import ORDINALS
from app.web.pictures.addresses import display_url, output_url
from app.web.pictures.videos import Video, find_video, is_video
from app.web.templating import label

CUBES = ("crop-cube", "cube")


@dataclass(frozen=True)
class Pane:
    """One picture or video.

    ``page`` is where its title leads, ``measured`` whether its structure index was asked for, ``delta`` what that is,
    None being too small to tell, ``video`` how a video plays, ``deep_url`` where it is at 16 bits.
    """

    title: str
    url: str
    width: int
    height: int
    note: str = ""
    page: str = ""
    measured: bool = False
    delta: float | None = None
    video: Video | None = None
    deep_url: str = ""


def crop_panes(experiment: Experiment, *, other: bool = False) -> list[Pane]:
    """Every input's crop; for ``other`` see `input_titles`."""
    deltas = _deltas(experiment, "inputs")
    titles = input_titles(experiment, other=other)
    return [
        _pane(experiment, _output(experiment, name), title, deltas=deltas[index : index + 1])
        for index, (name, title) in enumerate(zip(_crop_names(experiment), titles, strict=True))
    ]


def texture_pane(experiment: Experiment, note: str = "", page: str = "") -> Pane:
    """The texture itself."""
    output = _output(experiment, "texture")
    deltas = _texture_deltas(experiment).get("texture", [])
    return _pane(experiment, output, label(experiment.method), note=note, page=page, deltas=deltas)


def gallery(experiment: Experiment) -> list[Pane]:
    """The textures that were synthesised beside the main one."""
    deltas = _texture_deltas(experiment)
    return [
        replace(
            _pane(experiment, output, output.title, deltas=deltas.get(output.name, [])),
            deep_url=deep_url(experiment, output),
        )
        for output in experiment.outputs
        if output.listed and output.kind == "texture" and output.name != "texture"
    ]


def deep_url(experiment: Experiment, output: Output) -> str:
    """Where a still texture is downloaded at 16 bits."""
    return output_url(experiment, output.name, download=True, file_format="png", depth=16)


def steps(experiment: Experiment) -> list[Pane]:
    """What led to the texture, with it and without the rest of the gallery; of videos the stills, their cubes first."""
    moving = is_video(experiment)
    found = [
        output
        for output in experiment.outputs
        if output.listed and (output.kind == "view" or output.name == "texture") and not (moving and output.frames > 1)
    ]
    found.sort(key=lambda output: CUBES.index(output.name) if output.name in CUBES else len(CUBES))
    return [_pane(experiment, output, output.title) for output in found]


def describe_tiling(seamless: Sequence[bool]) -> str:
    """Say of one texture, or of several, whether they tile."""
    several = len(seamless) > 1
    if all(seamless):
        which = "These textures are" if several else "The texture is"
        return (
            f"{which} toroidal: the left edge continues at the right edge and the top at the bottom, so that it "
            "tiles without a seam."
        )
    if several and any(seamless):
        return "Only one of the two textures is toroidal: the edges of the other do not meet."
    which = "these textures" if several else "this texture"
    return f"Not toroidal: like the sample’s, the edges of {which} do not meet, and a seam shows where they touch."


def describe_looping(loops: Sequence[bool]) -> str:
    """Say of one video, or of several, whether they play for ever; nothing of none."""
    if not loops:
        return ""
    several = len(loops) > 1
    if all(loops):
        which = "Their last frames continue" if several else "Its last frame continues"
        return f"{which} in the first, so that there is no jump as it begins again."
    if any(loops):
        return "Only one of them loops: the other jumps from its last frame to the first."
    return f"{'They do' if several else 'It does'} not loop: from the last frame to the first there is a jump."


def input_parts(declared: Method) -> tuple[str, ...]:
    """The titles of a method's inputs if every one has a part of its own; empty if they are alike."""
    return () if len(declared.inputs) == 1 or declared.more else tuple(slot.title for slot in declared.inputs)


def input_titles(experiment: Experiment, *, other: bool = False) -> list[str]:
    """Name every input: by its part in the method, else the sample, or the first sample and the others.

    ``other`` says that they stand beside those of another experiment.
    """
    count = len(experiment.inputs)
    word = "other " if other else ""
    if named := input_parts(method(experiment.method)):
        titles = [f"{word}{title[0].lower()}{title[1:]}" for title in named]
    else:
        titles = [f"{word}sample"] if count == 1 else [f"{ordinal} {word}sample" for ordinal in ORDINALS[:count]]
    return [f"{title[0].upper()}{title[1:]}" for title in titles]


def facts(experiment: Experiment) -> Iterator[tuple[str, str]]:
    """What the method found out, as (title, value with its unit); titles that clash say which picture they mean."""
    found = experiment.diagnostics.get("facts", [])
    pictures = {output.name: output.title for output in experiment.outputs}
    times = Counter(fact["title"] for fact in found)
    for fact in found:
        title = fact["title"]
        if times[title] > 1:
            title = f"{pictures.get(fact['output'], fact['output'])}: {title[0].lower()}{title[1:]}"
        yield title, f"{_number(fact['value'])} {fact['unit']}".rstrip()


def _number(value: float) -> str:
    """Write a number with as many digits as people read.

    Examples
    --------
    >>> [_number(value) for value in (12.0, 0.123456, 12345.6, -0.00001234)]
    ['12', '0.1235', '12,346', '-1.234e-05']
    """
    return f"{value:,.0f}" if abs(value) >= 1000 or value == round(value) else f"{value:.4g}"


def _crop_names(experiment: Experiment) -> list[str]:
    return ["crop", *(f"crop-{number}" for number in range(2, len(experiment.inputs) + 1))]


def _output(experiment: Experiment, name: str) -> Output:
    output = experiment.output(name)
    if output is None:
        raise NotFoundError(f"The experiment {experiment.id} has no picture “{name}”.")
    return output


def _pane(
    experiment: Experiment,
    output: Output,
    title: str,
    *,
    note: str = "",
    page: str = "",
    deltas: Sequence[float | None] = (),
) -> Pane:
    """Show an output; ``deltas`` is its structure index, or empty where it was not measured."""
    video = find_video(experiment, output)
    url = output_url(experiment, output.name) if output.video else display_url(experiment, output.name)
    return Pane(title, url, output.width, output.height, note, page, bool(deltas), next(iter(deltas), None), video)


def _deltas(experiment: Experiment, part: str) -> list[float | None]:
    """The structure indices; experiments of the first version have none."""
    return list(experiment.diagnostics.get("structure", {}).get(part, []))


def _texture_deltas(experiment: Experiment) -> dict[str, list[float | None]]:
    names = [output.name for output in experiment.outputs if output.kind == "texture"]
    return {name: [delta] for name, delta in zip(names, _deltas(experiment, "outputs"), strict=False)}

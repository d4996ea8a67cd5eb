"""`mix`: barycentres of Gaussian textures."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from pydantic import Field, field_validator

from app.errors import InvalidInputError
from app.images.png_writer import PngWriter, encode_png
from app.methods.context import Context
from app.methods.explanations.mix import EXPLANATION
from app.methods.explanations.references import GAUSSIAN_MIXING, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.gaussian.params import SpotParams, not_extended
from app.methods.gaussian.weights import canonical
from app.methods.inputs import alike
from app.methods.model import Method, Picture, Size, Slot, Source
from app.methods.output.pictures import crops
from app.methods.outputs import Condition, OutputSpec, from_inputs, shown_inputs, texture
from app.methods.params import WHOLE_IN_MEMORY, Resolved
from app.methods.stages import Plan
from app.synthesis.arrays import Pixels
from app.synthesis.fourier.field import Noise
from app.synthesis.gaussian.adsn import white_noise
from app.synthesis.gaussian.mixing import Mixture
from app.synthesis.parallel import Team
from app.synthesis.sinks import Levels

MOST_STEPS, FURTHER = 16, 2  # of the path; samples beside the first two
PANEL = 512  # pixels of each side that a step of the path shows in the strip


class MixParams(SpotParams):
    """Parameters of the mixture."""

    weights: str = Field(
        "",
        max_length=100,
        title="Weights",
        description="How much of each sample: numbers with commas between them, one for each sample in their order, "
        "such as 0.3,0.7; or with semicolons or spaces, where the commas are decimal: 0,3; 0,7. Only their proportions "
        "count. Empty: as much of each.",
    )
    strip: int = Field(
        8,
        ge=0,
        le=MOST_STEPS,
        title="Steps of the path",
        description="How many textures to make along the path from the first sample (ρ = 0) to the second (ρ = 1), "
        "beside the one of the given weights; 0 for none. A path needs two samples: with more of them, each one's own "
        "texture is made instead.",
    )

    @field_validator("weights")
    @classmethod
    def _are_weights(cls, text: str) -> str:
        return canonical(text)

    def shares(self, count: int) -> list[float]:
        """The weights of ``count`` samples, of sum 1."""
        found = [float(number) for number in self.weights.split(",")] if self.weights.strip() else [1.0] * count
        return [weight / sum(found) for weight in found]


def check(sizes: Sequence[Size], resolved: Resolved[MixParams]) -> None:
    """Refuse weights that are not one for each sample, and a path of a single step."""
    params = resolved.params
    found = len(params.shares(len(sizes)))
    if found != len(sizes):
        raise InvalidInputError(
            f"Give one weight for each of the {len(sizes)} samples, or none to take as much of each; there "
            f"{'are' if found > 1 else 'is'} {found} weight{'s' * (found > 1)}.",
            "parameters.weights",
        )
    if params.strip == 1:
        raise InvalidInputError(
            "Choose 2 steps or more, or 0 to make no path: a path has two ends.",
            "parameters.strip",
        )


def idle(sizes: Sequence[Size], resolved: Resolved[MixParams]) -> Mapping[str, str]:
    """The extension's parameters where nothing is extended, and a path's where there is none."""
    words = f"a path needs two samples, and there are {len(sizes)}; leave the steps out."
    return {**not_extended(sizes, resolved), **({"strip": words} if len(sizes) > 2 else {})}


class _Strip:
    """Steps of a path side by side; of larger textures the upper left corner."""

    def __init__(self, steps: int, height: int, width: int, channels: int, context: Context) -> None:
        self._context = context
        self._height, self._width = min(height, PANEL), min(width, PANEL)
        kind = np.uint8 if context.depth == 8 else np.uint16
        self._pixels = np.empty((self._height, steps * self._width, channels), kind)

    def put(self, step: int, first: int, block: Pixels) -> None:
        part = block[: max(0, self._height - first), : self._width]
        self._pixels[first : first + len(part), step * self._width : (step + 1) * self._width] = part

    def picture(self) -> Picture:
        height, width = self._pixels.shape[:2]
        png = encode_png(self._pixels, self._context.threads)
        return Picture("strip", "The path from the first sample to the second", width, height, png)


class _Run:
    """One run: makes its pictures one by one."""

    def __init__(self, sources: Sequence[Source], resolved: Resolved[MixParams], context: Context, team: Team) -> None:
        self._sources, self._context, self._team = sources, context, team
        self._params = params = resolved.params
        self._height, self._width = resolved.height, resolved.width
        samples = alike(sources)
        self._channels = samples[0].shape[2]
        self._shares = params.shares(len(sources))
        self._path = params.strip if len(sources) == 2 else 0
        alone = len(sources) if len(sources) > 2 else 0
        self._further = [f"mix-{step}" for step in range(1, self._path + 1)]
        self._further += [f"sample-{number}" for number in range(1, alone + 1)]
        names = [*self._further, "strip"] if self._path else ["texture", *self._further]
        self._textures = context.during("strip" if self._path else "texture", [(name, 1) for name in names])
        self._own_stage = set(names)
        noise = Noise(
            white_noise, self._height, self._width, seed=params.seed, alpha=params.alpha, window=params.window
        )
        self._mixture = Mixture(samples, self._shares, noise, team, self._progress)

    def _progress(self, stage: str, part: float) -> None:
        (self._textures if stage in self._own_stage else self._context.progress)(stage, part)

    def pictures(self) -> Iterator[Picture]:
        path = self._path
        yield self._texture("texture", "Texture", self._shares)
        yield from crops(self._sources, self._context)
        strip = _Strip(path, self._height, self._width, self._channels, self._context) if path else None
        for step, name in enumerate(self._further):
            if strip:
                rho = step / (path - 1)
                yield self._texture(name, f"ρ = {rho:.2f}", [1 - rho, rho], strip, step)
            else:
                alone = [float(index == step) for index in range(len(self._further))]
                yield self._texture(name, f"Sample {step + 1} alone", alone)
        if strip:
            self._textures("strip", 0)
            yield strip.picture()

    def _texture(
        self, name: str, title: str, weights: list[float], strip: _Strip | None = None, step: int = 0
    ) -> Picture:
        writer = PngWriter(self._width, self._height, self._channels, self._context.depth)

        def write(first: int, block: Pixels) -> None:
            writer.write(first, block)
            if strip:
                strip.put(step, first, block)

        levels = Levels(write, self._channels, 0, self._sources[0].peak, 2**self._context.depth - 1)
        self._mixture.emit(weights, levels, name)
        return Picture(name, title, self._width, self._height, writer.finish(), kind="texture")


def run(sources: Sequence[Source], resolved: Resolved[MixParams], context: Context) -> Iterator[Picture]:
    """The barycentre; then the path between two samples, or each one's own texture if there are more."""
    with Team(context.threads) as team:
        yield from _Run(sources, resolved, context, team).pictures()


def stages(sizes: Sequence[Size], resolved: Resolved[MixParams]) -> Plan:
    """The mixture, and the path or the samples' own textures."""
    further = (("texture", 10), ("strip", 60)) if len(sizes) == 2 and resolved.params.strip else (("texture", 70),)
    return (("spot", 10), ("random phase", 20), *further)


_PATH, _WEIGHED = ("alpha", "window", "strip"), ("alpha", "window", "weights")


def _holds(step: int) -> Condition:
    """The condition that there is a path that has this step, from 1."""
    return lambda params, inputs: inputs == 2 and params.strip >= step


OUTPUTS = (
    texture(of=_WEIGHED),
    *shown_inputs(2 + FURTHER, least=2),
    *(
        texture(f"mix-{step}", _PATH, _holds(step), f"there are two inputs and {step} “Steps of the path” or more")
        for step in range(1, MOST_STEPS + 1)
    ),
    *(
        texture(f"sample-{number}", _WEIGHED, from_inputs(least), f"there are {least} inputs or more")
        for number, least in ((1, 3), (2, 3), (3, 3), (4, 4))
    ),
    OutputSpec("strip", of=_PATH, applies=_holds(1), condition="there are two inputs and some “Steps of the path”"),
)

MIX = Method(
    name="mix",
    title="Mixture of textures",
    summary="Gaussian textures between two or more samples, along optimal transport.",
    inputs=(
        Slot("sample", "First sample", "A photograph; crop a homogeneous region of it. The path begins here."),
        Slot("other", "Further sample", "What to mix it with: the path ends here. Up to two more may follow."),
    ),
    params=MixParams,
    references=(GAUSSIAN_MIXING, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=OUTPUTS,
    idle=idle,
    stages=stages,
    most_pixels=WHOLE_IN_MEMORY,
    more=FURTHER,
    phase=True,
)

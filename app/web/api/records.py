"""The JSON of the API: what is sent and what comes back, and how domain objects become it."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.experiments.model import Experiment, Output, Sample, Snapshot, Status
from app.images.crop import Rectangle
from app.methods.model import Method

API = "/api/v1"
IDENTIFIER = r"^[A-Za-z0-9_-]{1,64}$"
Identifier = Annotated[str, StringConstraints(pattern=IDENTIFIER)]
_FAR = 1_000_000  # pixels; beyond any sample, and small enough for every database


class Body(BaseModel):
    """A JSON body: no unknown fields, no guessing at types."""

    model_config = ConfigDict(strict=True, extra="forbid")


class Crop(Body):
    """A rectangle in pixels of the upright sample."""

    x: int = Field(ge=0, le=_FAR, description="From the left edge.")
    y: int = Field(ge=0, le=_FAR, description="From the top edge.")
    width: int = Field(ge=1, le=_FAR)
    height: int = Field(ge=1, le=_FAR)

    def rectangle(self) -> Rectangle:
        return Rectangle(self.x, self.y, self.width, self.height)


class InputBody(Body):
    """One input of an experiment."""

    sample: Identifier = Field(description="Id of an uploaded or bundled sample.")
    crop: Crop | None = Field(None, description="Default: the whole sample.")


class ListedBody(Body):
    """What may be changed of an experiment."""

    listed: bool = Field(description="Whether the archive shows it; otherwise only its link leads to it.")


class SampleRecord(BaseModel):
    """A sample."""

    id: str
    width: int = Field(description="Pixels, upright.")
    height: int
    channels: int = Field(description="Colour channels: 1 or 3.")
    depth: int = Field(description="Bits per channel: 8 or 16.")
    frames: int = Field(description="1 for a still picture.")
    media_type: str
    title: str | None = Field(description="Of a bundled sample.")
    transparent: bool = Field(description="Whether some pixels are not opaque; a crop must not hold such.")
    created_at: datetime
    url: str
    image: str = Field(description="Address of an upright rendition.")

    @classmethod
    def of(cls, sample: Sample, base: str) -> "SampleRecord":
        url = f"{base}{API}/samples/{sample.id}"
        return cls(
            id=sample.id,
            width=sample.width,
            height=sample.height,
            channels=sample.channels,
            depth=sample.depth,
            frames=sample.frames,
            media_type=sample.media_type,
            title=sample.title,
            transparent=sample.transparent,
            created_at=sample.created_at,
            url=url,
            image=f"{url}/image",
        )


class SampleList(BaseModel):
    """The bundled samples."""

    samples: list[SampleRecord]


class InputRecord(BaseModel):
    """An input of an experiment."""

    sample: str
    crop: Crop


class OutputRecord(BaseModel):
    """A file that an experiment made."""

    name: str
    title: str
    kind: Literal["texture", "view"] = Field(description="A texture that was synthesised, or a view on the way to it.")
    media_type: str
    width: int
    height: int
    bytes: int
    url: str

    @classmethod
    def of(cls, output: Output, experiment_url: str) -> "OutputRecord":
        return cls(
            name=output.name,
            title=output.title,
            kind=output.kind,
            media_type=output.media_type,
            width=output.width,
            height=output.height,
            bytes=output.bytes,
            url=f"{experiment_url}/outputs/{output.name}",
        )


class StructureRecord(BaseModel):
    """The structure index δ: the share of total variation that a picture lacks against its random phase textures."""

    inputs: list[float] = Field(description="Of the crops.")
    outputs: list[float] = Field(description="Of the textures, in the order of the outputs.")


class FactRecord(BaseModel):
    """A number that the method found out."""

    output: str = Field(description="Name of the output it is about.")
    name: str
    title: str
    value: float
    unit: str


class DiagnosticsRecord(BaseModel):
    """What was measured of an experiment."""

    structure: StructureRecord
    facts: list[FactRecord]


class ExperimentRecord(BaseModel):
    """An experiment."""

    id: str
    status: Status
    progress: float = Field(ge=0, le=1, description="The part of the run that is done.")
    stage: str | None = Field(description="What is being computed while it runs.")
    position: int | None = Field(description="Place in the queue while it waits; 1 is next.")
    method: str
    inputs: list[InputRecord]
    parameters: dict[str, Any] = Field(description="Complete: sizes and defaults are filled in.")
    listed: bool
    outputs: list[OutputRecord]
    timings: dict[str, float] = Field(description="Seconds by stage.")
    diagnostics: DiagnosticsRecord | None = Field(description="Once it has succeeded.")
    error: str | None = Field(description="Why it failed and what to try.")
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    url: str
    page: str = Field(description="Address of its page, for people.")
    owner_token: str | None = Field(
        None,
        description="Only in the answer that makes you an owner: keep it and send it as `Authorization: Bearer …` "
        "to cancel, delete, list or unlist your experiments. Browsers keep it in a cookie.",
    )

    @classmethod
    def of(cls, experiment: Experiment, snapshot: Snapshot | None, base: str) -> "ExperimentRecord":
        """Make the record; the snapshot of an unfinished experiment says how far it is.

        Where the snapshot is newer and finished, the record is not: what succeeded shows its outputs.
        """
        url = f"{base}{API}/experiments/{experiment.id}"
        if snapshot is None or snapshot.status.finished or experiment.status.finished:
            snapshot = Snapshot(experiment.status, fraction=float(experiment.status is Status.SUCCEEDED))
        return cls(
            id=experiment.id,
            status=snapshot.status,
            progress=snapshot.fraction,
            stage=snapshot.stage,
            position=snapshot.position,
            method=experiment.method,
            inputs=[
                InputRecord(
                    sample=source.sample,
                    crop=Crop(x=source.crop.x, y=source.crop.y, width=source.crop.width, height=source.crop.height),
                )
                for source in experiment.inputs
            ],
            parameters=dict(experiment.parameters),
            listed=experiment.listed,
            outputs=[OutputRecord.of(output, url) for output in experiment.outputs if output.listed],
            timings={stage: round(seconds, 6) for stage, seconds in experiment.timings.items()},
            diagnostics=DiagnosticsRecord(**experiment.diagnostics) if experiment.diagnostics else None,
            error=experiment.error,
            created_at=experiment.created_at,
            started_at=experiment.started_at,
            finished_at=experiment.finished_at,
            url=url,
            page=f"{base}/experiments/{experiment.id}",
        )


class ExperimentList(BaseModel):
    """A page of the archive."""

    experiments: list[ExperimentRecord]
    next: str | None = Field(description="Address of the next page; null on the last. The `Link` header says the same.")


class SlotRecord(BaseModel):
    """An input that a method asks for."""

    name: str
    title: str
    summary: str


class ReferenceRecord(BaseModel):
    """An article."""

    authors: str
    title: str
    venue: str
    year: int
    url: str
    kind: str = Field(description="Of its BibTeX entry.")
    pages: str
    bibtex: str


class MethodRecord(BaseModel):
    """A method."""

    name: str
    title: str
    summary: str
    inputs: list[SlotRecord]
    more_inputs: int = Field(description="How many further inputs like the last one it takes.")
    parameters: dict[str, Any] = Field(description="JSON Schema of its parameters.")
    reference: ReferenceRecord = Field(description="The article it comes from.")
    references: list[ReferenceRecord] = Field(description="All of its articles, the main one first.")

    @classmethod
    def of(cls, method: Method) -> "MethodRecord":
        references = [ReferenceRecord(**vars(reference), bibtex=reference.bibtex) for reference in method.references]
        return cls(
            name=method.name,
            title=method.title,
            summary=method.summary,
            inputs=[SlotRecord(**vars(slot)) for slot in method.inputs],
            more_inputs=method.more,
            parameters=method.params.model_json_schema(),
            reference=references[0],
            references=references,
        )


class MethodList(BaseModel):
    """Every method of the service."""

    methods: list[MethodRecord]


class Fault(BaseModel):
    """A field at fault."""

    field: str = Field(description="Dotted, as in the body: `parameters.alpha`, `inputs.0.crop`.")
    message: str


class Problem(BaseModel):
    """An error (RFC 9457)."""

    type: str = Field(examples=["about:blank"])
    title: str
    status: int
    detail: str = Field(description="What is wrong and what to do about it.")
    errors: list[Fault] = Field(default_factory=list, description="The fields at fault, where they are known.")

"""JSON records of the API: the bodies of its responses, made from domain objects."""

from datetime import datetime
from typing import Any, Literal, Self

from pydantic import BaseModel, Field

from app.experiments.files.versions import made_version
from app.experiments.model import Experiment, Output, Sample, Snapshot, Status
from app.methods.effects import COMMON
from app.methods.model import Method
from app.methods.outputs import OutputSpec
from app.web.api.bodies import Crop, TimeRange
from app.web.api.environment import EnvironmentRecord

API = "/api/v1"


class Record(BaseModel):
    """A JSON answer that is made of a domain object's attributes of the same names."""

    @classmethod
    def from_source(cls, source: object, **others: object) -> Self:
        """Take ``others`` as they are, and the attributes of ``source`` for the rest; what it lacks stays unset."""
        names = [name for name in cls.model_fields if name not in others and hasattr(source, name)]
        return cls.model_validate({name: getattr(source, name) for name in names} | others, from_attributes=True)


class SampleRecord(Record):
    """A sample."""

    id: str
    width: int = Field(description="Width in pixels, upright.")
    height: int
    channels: int = Field(description="Colour channels: 1 or 3.")
    depth: int = Field(description="Bits per channel: 8 or 16.")
    frames: int = Field(description="1 for a still picture.")
    rate: float = Field(description="Frames a second; 0 for a still picture.")
    media_type: str = Field(description="Media type of the uploaded video; image/png for a still picture.")
    title: str | None = Field(description="Title of a bundled sample; null for uploads.")
    transparent: bool = Field(description="Whether some pixels are not opaque; a crop must not contain such pixels.")
    created_at: datetime
    url: str
    image: str = Field(description="Address of an upright image for display.")
    version: str = Field(
        description="Version of its pictures: under an address with `v=…` browsers keep them for ever."
    )

    @classmethod
    def of(cls, sample: Sample, base: str) -> "SampleRecord":
        url = f"{base}{API}/samples/{sample.id}"
        return cls.from_source(sample, url=url, image=f"{url}/image", version=made_version(sample.digest))


class SampleList(BaseModel):
    """The bundled samples."""

    samples: list[SampleRecord]


class InputRecord(BaseModel):
    """An input of an experiment."""

    sample: str
    crop: Crop
    frames: TimeRange


class OutputRecord(Record):
    """A file that an experiment made."""

    name: str
    title: str
    kind: Literal["texture", "view"] = Field(description="A texture that was synthesised, or a view on the way to it.")
    media_type: str
    width: int
    height: int
    bytes: int
    frames: int = Field(description="1 for a still picture.")
    rate: float = Field(description="Frames a second; 0 for a still picture.")
    url: str

    @classmethod
    def of(cls, output: Output, experiment_url: str) -> "OutputRecord":
        return cls.from_source(output, url=f"{experiment_url}/outputs/{output.name}")


class StructureRecord(BaseModel):
    """The structure index δ: the share of total variation that a picture lacks against its random phase textures."""

    inputs: list[float | None] = Field(description="One per crop; null if a side is shorter than 32 pixels.")
    outputs: list[float | None] = Field(
        description="One value per texture, in the order of the outputs; null as above."
    )


class FactRecord(BaseModel):
    """A number that the method found out."""

    output: str = Field(description="Name of the output that the number describes.")
    name: str
    title: str
    value: float
    unit: str


class DiagnosticsRecord(BaseModel):
    """What was measured of an experiment."""

    structure: StructureRecord
    facts: list[FactRecord]


class ExperimentRecord(Record):
    """An experiment."""

    id: str
    status: Status
    progress: float = Field(ge=0, le=1, description="Fraction of the run that is done.")
    stage: str | None = Field(description="What is being computed while it runs.")
    position: int | None = Field(description="Place in the queue while it waits; 1 is next.")
    method: str
    inputs: list[InputRecord]
    parameters: dict[str, Any] = Field(description="Complete: sizes and defaults are filled in.")
    depth: int = Field(description="Bits per channel of the pictures, except those that always have 8.")
    listed: bool
    outputs: list[OutputRecord]
    timings: dict[str, float] = Field(description="Seconds by stage.")
    diagnostics: DiagnosticsRecord | None = Field(description="Null until the experiment has succeeded.")
    environment: EnvironmentRecord | None = Field(
        description="Null until the experiment has succeeded, and for experiments of earlier versions."
    )
    error: str | None = Field(description="Why the experiment failed and what to try.")
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    url: str
    page: str = Field(description="Address of the experiment's page for people.")
    owner_token: str | None = Field(
        None,
        description="Only in the response that makes you an owner: keep it, and send it as `Authorization: Bearer …` "
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
        return cls.from_source(
            experiment,
            status=snapshot.status,
            progress=snapshot.fraction,
            stage=snapshot.stage,
            position=snapshot.position,
            parameters=dict(experiment.parameters),
            outputs=[OutputRecord.of(output, url) for output in experiment.outputs if output.listed],
            timings={stage: round(seconds, 6) for stage, seconds in experiment.timings.items()},
            diagnostics=experiment.diagnostics or None,
            environment=experiment.environment or None,
            url=url,
            page=f"{base}/experiments/{experiment.id}",
        )


class ProgressRecord(Record):
    """State of an experiment: the data of an event."""

    status: Status
    position: int | None = Field(description="Place in the queue while it waits; 1 is next.")
    progress: float = Field(description="Fraction of the run that is done.")
    stage: str | None = Field(description="What is being computed while it runs.")
    elapsed: float = Field(description="Seconds since the run started.")

    @classmethod
    def of(cls, snapshot: Snapshot) -> "ProgressRecord":
        return cls.from_source(snapshot, progress=snapshot.fraction, elapsed=round(snapshot.elapsed, 3))


class PlanRecord(Record):
    """What an experiment would make and take."""

    width: int = Field(description="Pixels of the texture.")
    height: int
    frames: int = Field(description="1 for a still picture.")
    memory: int = Field(description="Peak memory of the run in bytes; 0 if it is always small.")
    memory_limit: int = Field(description="Largest memory in bytes that a run may need.")


class ExperimentList(BaseModel):
    """A page of the archive."""

    experiments: list[ExperimentRecord]
    next: str | None = Field(description="Address of the next page; null on the last. The `Link` header says the same.")


class SlotRecord(BaseModel):
    """An input that a method asks for."""

    name: str
    title: str
    summary: str
    moving: bool = Field(description="Whether the input is a video.")


class ReferenceRecord(BaseModel):
    """An article."""

    authors: str
    title: str
    venue: str
    year: int
    url: str
    kind: str = Field(description="BibTeX entry type.")
    pages: str
    bibtex: str


class AnnouncedRecord(Record):
    """An output that a method can give."""

    name: str
    kind: Literal["texture", "view"] = Field(description="A texture that is synthesised, or a view on the way to it.")
    media_type: str
    depths: list[int] = Field(description="Bits per channel that the output is available at.")
    parameters: list[str] = Field(description="Parameters that change the output.")
    condition: str | None = Field(description="When the output is given; null if always.")

    @classmethod
    def of(cls, output: OutputSpec, method: Method) -> "AnnouncedRecord":
        return cls.from_source(
            output,
            depths=[8, 16] if output.deep else [8],
            parameters=[name for name in method.params.model_fields if name in COMMON or output.changed_by(name)],
            condition=output.condition or None,
        )


class MethodRecord(Record):
    """A method."""

    name: str
    title: str
    summary: str
    inputs: list[SlotRecord]
    more_inputs: int = Field(description="How many further inputs like the last one it takes.")
    parameters: dict[str, Any] = Field(description="JSON Schema of its parameters.")
    outputs: list[AnnouncedRecord] = Field(description="All outputs that the method can give, in their order.")
    reference: ReferenceRecord = Field(description="The main article.")
    references: list[ReferenceRecord] = Field(description="All of its articles, the main one first.")

    @classmethod
    def of(cls, method: Method) -> "MethodRecord":
        return cls.from_source(
            method,
            more_inputs=method.more,
            parameters=method.params.model_json_schema(),
            outputs=[AnnouncedRecord.of(output, method) for output in method.outputs],
            reference=method.references[0],
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
    instance: str = Field("", description="URN of the request; the service's log has the same id.")
    errors: list[Fault] = Field(default_factory=list, description="The fields at fault, where they are known.")

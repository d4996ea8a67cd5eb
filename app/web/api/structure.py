"""Structure index of a crop, ``/api/v1/samples/{id}/structure``: whether it is a micro-texture."""

from typing import Annotated

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel, Field
from starlette.concurrency import run_in_threadpool

from app import threads
from app.experiments.meter import Verdict, interpret
from app.images.crop import Rectangle
from app.numbers import FAR
from app.synthesis.structure import SIGMA
from app.web.api.bodies import Crop
from app.web.api.openapi import problems
from app.web.api.records import API
from app.web.api.samples import SampleId
from app.web.deps import ServiceDep
from app.web.limits import VIEWS, take

LARGEST_SIGMA = 64

router = APIRouter(prefix=f"{API}/samples", tags=["samples"])


class StructureIndex(BaseModel):
    """How structured a crop is."""

    delta: float | None = Field(
        description="The structure index δ: the share of total variation that the crop lacks against its own random "
        "phase textures, at the scale σ. About 0 for a micro-texture, 0.1 to 0.4 for bricks, tiles and leaves. Null "
        "where the crop has less than 32 pixels along a side: of so few it means nothing."
    )
    z: float | None = Field(
        description="The same difference in standard deviations of the total variation of those textures. It grows "
        "with the crop and with sharpness; δ tells better what a texture is. Null with it."
    )
    sigma: float = Field(description="Deviation, in pixels, of the Gaussian that smoothed the crop first.")
    verdict: Verdict = Field(description="What δ says, in one word; unknown where it is null.")
    words: str = Field(description="… and in a sentence.")
    crop: Crop = Field(description="What was asked about. Of a side beyond 1024 pixels the middle 1024 are measured.")


@router.get("/{sample_id}/structure", summary="Is it a micro-texture?", responses=problems(404, 422, 429))
async def read_structure(
    sample_id: SampleId,
    request: Request,
    service: ServiceDep,
    crop: Annotated[
        str | None,
        Query(
            pattern=r"^\d{1,6},\d{1,6},\d{1,6},\d{1,6}$",
            description="`x,y,width,height` in pixels of the upright sample; by default all of it.",
            examples=["96,96,320,320"],
        ),
    ] = None,
    sigma: Annotated[
        float, Query(ge=0, le=LARGEST_SIGMA, description="Scale in pixels, for δ and z. The verdict is meant for 2.")
    ] = SIGMA,
    frame: Annotated[int, Query(ge=0, le=FAR, description="Of a video: which frame, from 0.")] = 0,
) -> StructureIndex:
    """Measure a crop, within a tenth of a second for 512 × 512 pixels: random phase models reproduce micro-textures."""
    take(request, VIEWS)
    sample = await run_in_threadpool(service.samples.get, sample_id)
    area = Rectangle.parse(crop) if crop else Rectangle(0, 0, sample.width, sample.height)
    found = await threads.run(threads.PICTURES, service.meter.structure, sample, area, sigma, frame)
    reading = interpret(found.delta)
    return StructureIndex(
        delta=None if found.delta is None else round(found.delta, 4),
        z=None if found.z is None else round(found.z, 2),
        sigma=sigma,
        verdict=reading.verdict,
        words=reading.words,
        crop=Crop(x=area.x, y=area.y, width=area.width, height=area.height),
    )

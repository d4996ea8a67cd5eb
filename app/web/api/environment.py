"""Environment record of an experiment: versions and processor that computed it."""

from pydantic import BaseModel, Field


class EnvironmentRecord(BaseModel):
    """What computed an experiment: with the same versions, every processor with AVX2 gives the same bytes."""

    version: str = Field(description="Of Microtexture.")
    cpu: str = Field(description="The processor, and the best kernels that numpy has for it.")
    numpy: str
    scipy: str

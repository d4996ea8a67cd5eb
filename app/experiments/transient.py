"""An output straight from files: run once for one answer, and forgotten with it."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any, Literal

from app.errors import ConflictError, InvalidInputError
from app.experiments.files.outputs import AnyFormat, Outputs, file_of
from app.experiments.files.renditions import PNG, check_deep
from app.experiments.housekeeping import Housekeeping
from app.experiments.model import Experiment, Sample, Status
from app.experiments.preparation import Answer, NewExperiment, NewInput
from app.experiments.samples import SampleIntake
from app.experiments.watching import Following
from app.images.crop import Frames, Rectangle
from app.methods.effects import possible_output
from app.methods.registry import method as method_named


class Direct:
    """Runs that leave nothing behind.

    Parameters
    ----------
    intake, housekeeping, outputs, following
        Those of the service.
    submit : callable
        Accepts a transient experiment.
    forget : callable
        Stops a transient experiment if it still runs, and removes it.
    """

    def __init__(
        self,
        intake: SampleIntake,
        housekeeping: Housekeeping,
        outputs: Outputs,
        following: Following,
        submit: Callable[[NewExperiment], Experiment],
        forget: Callable[[Experiment], None],
    ) -> None:
        self._intake = intake
        self._housekeeping = housekeeping
        self._outputs = outputs
        self._following = following
        self._submit = submit
        self._forget = forget

    async def synthesize(
        self,
        uploads: Sequence[Path],
        *,
        method: str,
        crops: Sequence[Rectangle | None],
        frames: Sequence[Frames | None],
        parameters: Mapping[str, Any],
        output: str,
        file_format: AnyFormat | None,
        depth: Literal[8, 16] | None,
    ) -> tuple[bytes, str]:
        """The picture and its media type."""
        # It goes on to its end if the caller hangs up: only then is known what to forget.
        begun = asyncio.ensure_future(
            asyncio.to_thread(self._begin, uploads, method, crops, frames, parameters, output, file_format, depth)
        )
        try:
            experiment = await asyncio.shield(begun)
            finished = await self._following.wait(experiment.id, float("inf"))
            if finished.status is not Status.SUCCEEDED:
                raise ConflictError(finished.error or "The run was cancelled.")
            made, path = await asyncio.to_thread(self._outputs.output, experiment.id, finished.wanted)
            media_type = made.media_type
            if media_type == PNG:
                path, media_type = await self._outputs.converted(experiment.id, made.name, file_format, depth)
            return await asyncio.to_thread(path.read_bytes), media_type
        finally:
            await asyncio.shield(self._forgotten(begun))

    def _begin(
        self,
        uploads: Sequence[Path],
        method: str,
        crops: Sequence[Rectangle | None],
        frames: Sequence[Frames | None],
        parameters: Mapping[str, Any],
        output: str,
        file_format: AnyFormat | None,
        depth: Literal[8, 16] | None,
    ) -> Experiment:
        samples: list[Sample] = []
        try:
            answer = Answer(file_of(possible_output(method_named(method), output), file_format), depth)
            if depth == 16:
                check_deep(file_format)
            for given, what, field in ((crops, "crops", "crop"), (frames, "time ranges", "frames")):
                if len(given) > len(uploads):
                    raise InvalidInputError(
                        f"There are more {what} ({len(given)}) than files ({len(uploads)}).",
                        f"inputs.{len(uploads)}.{field}",
                    )
            for upload in uploads:
                samples.append(self._intake.add(upload, None))
            parts = zip_longest(samples, crops, frames)
            inputs = tuple(NewInput(sample.id, crop, time) for sample, crop, time in parts)
            return self._submit(NewExperiment(method, inputs, parameters, listed=False, answer=answer))
        except BaseException:
            for sample in samples:
                self._housekeeping.remove_sample(sample.id)
            raise
        finally:
            for upload in uploads:
                upload.unlink(missing_ok=True)

    async def _forgotten(self, begun: asyncio.Future[Experiment]) -> None:
        await asyncio.wait({begun})
        if begun.exception() is None:
            await asyncio.to_thread(self._forget, begun.result())

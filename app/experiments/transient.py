"""Transient experiments: an output straight from files, run once for one answer and deleted with it."""

import asyncio
from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any, Literal

from app import threads
from app.errors import ConflictError, InvalidInputError
from app.experiments.experiments import Experiments
from app.experiments.files.outputs import AnyFormat, Outputs, name_of_file
from app.experiments.files.renditions import PNG, check_deep
from app.experiments.housekeeping import Housekeeping
from app.experiments.model import Experiment, Sample, Status
from app.experiments.preparation import Answer, NewExperiment, NewInput
from app.experiments.samples import Samples
from app.experiments.submission import Submission
from app.experiments.watching import Watching
from app.images.crop import Frames, Rectangle
from app.methods.effects import possible_output
from app.methods.registry import method as method_named


class Transient:
    """Runs that leave nothing behind; the parameters are those of the service."""

    def __init__(
        self,
        samples: Samples,
        submission: Submission,
        experiments: Experiments,
        outputs: Outputs,
        watching: Watching,
        housekeeping: Housekeeping,
    ) -> None:
        self._samples = samples
        self._submission = submission
        self._experiments = experiments
        self._outputs = outputs
        self._watching = watching
        self._housekeeping = housekeeping

    async def synthesize(
        self,
        uploads: Sequence[Path],
        *,
        method: str,
        crops: Sequence[Rectangle | None],
        parameters: Mapping[str, Any],
        frames: Sequence[Frames | None] = (),
        output: str = "texture",
        file_format: AnyFormat | None = None,
        depth: Literal[8, 16] | None = None,
        client: str | None = None,
    ) -> tuple[bytes, str]:
        """Make an output straight from files: its bytes and media type. Nothing of it is kept, the files included.

        Parameters
        ----------
        uploads : sequence of Path
            One file for each input.
        method : str
        crops, frames : sequence of Rectangle or None, and of Frames or None
            Of the files, in their order; for those at the end that are left out, and for None, as in `NewInput`.
        parameters : mapping
        output, file_format, depth
            The name of the output that is the answer, and what it is written as.
        client : str, optional
            Who asks, for clients take turns.

        Raises
        ------
        AppError
            Any of those of `Samples.add`, `Submission.submit` and `Outputs.convert`; `ConflictError` if the run failed.
        """
        # It goes on to its end if the caller hangs up: only then is known what to forget.
        what = (uploads, method, crops, frames, parameters, output, file_format, depth, client)
        begun = asyncio.ensure_future(threads.run(threads.UPLOADS, self._begin, *what))
        try:
            experiment = await asyncio.shield(begun)
            finished = await self._watching.wait(experiment.id, float("inf"))
            if finished.status is not Status.SUCCEEDED:
                raise ConflictError(finished.error or "The run was cancelled.")
            answer, path = await threads.run(threads.RECORDS, self._outputs.get, experiment.id, finished.wanted)
            media_type = answer.media_type
            if media_type == PNG:
                path, media_type = await self._outputs.convert(experiment.id, answer.name, file_format, depth)
            return await threads.run(threads.RECORDS, path.read_bytes), media_type
        finally:
            await asyncio.shield(self._forget(begun))

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
        client: str | None,
    ) -> Experiment:
        samples: list[Sample] = []
        try:
            answer = Answer(name_of_file(possible_output(method_named(method), output), file_format), depth)
            if depth == 16:
                check_deep(file_format)
            for parts, what, field in ((crops, "crops", "crop"), (frames, "time ranges", "frames")):
                if len(parts) > len(uploads):
                    raise InvalidInputError(
                        f"There are more {what} ({len(parts)}) than files ({len(uploads)}).",
                        f"inputs.{len(uploads)}.{field}",
                    )
            for upload in uploads:
                samples.append(self._samples.add(upload, None))
            inputs = tuple(
                NewInput(sample.id, crop, time) for sample, crop, time in zip_longest(samples, crops, frames)
            )
            return self._submission.submit_transient(
                NewExperiment(method, inputs, parameters, listed=False, answer=answer), client
            )
        except BaseException:
            for sample in samples:
                self._housekeeping.remove_sample(sample.id)
            raise
        finally:
            for upload in uploads:
                upload.unlink(missing_ok=True)

    async def _forget(self, begun: asyncio.Future[Experiment]) -> None:
        await asyncio.wait({begun})
        if begun.exception() is None:
            await threads.run(threads.RECORDS, self._experiments.discard, begun.result())

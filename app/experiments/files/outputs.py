"""Output files of experiments: as they are stored, in other formats, at 16 bits."""

from pathlib import Path
from typing import Literal, Protocol

from app import threads
from app.errors import AppError, BusyError, InvalidInputError, NotFoundError
from app.experiments.files.renditions import DERIVED, PNG, Renditions, VideoFormat, check_deep, found_or_made
from app.experiments.model import Experiment, Output, deep_job, deep_name
from app.experiments.ports import BlobStore, Executor, ExperimentStore, JobQueue
from app.experiments.queue import check_queue
from app.experiments.shares import Shares
from app.experiments.watching import Watching
from app.images.convert import Format, read_depth
from app.methods.effects import possible_output, refuse_deep
from app.methods.registry import method as method_named

AnyFormat = Format | VideoFormat
MP4_SUFFIX = "-mp4"  # ends the name of a video's second file: see `app.methods.output.videos`
DEEP_SECONDS = 120.0  # how long a download waits for its output at 16 bits


class Named(Protocol):
    """What made and announced outputs have in common."""

    @property
    def name(self) -> str: ...

    @property
    def media_type(self) -> str: ...

    @property
    def video(self) -> bool: ...


def name_of_file(output: Named, file_format: AnyFormat | None) -> str:
    """Name the output that is this one in this format: a video is two of them.

    Raises
    ------
    InvalidInputError
        At ``format``, if it does not come in this one.
    """
    if output.video:
        if file_format is None or output.media_type == f"video/{file_format}":
            return output.name
        if file_format in ("webm", "mp4"):
            return output.name.removesuffix(MP4_SUFFIX) + (MP4_SUFFIX if file_format == "mp4" else "")
        raise InvalidInputError(
            "Ask for webm or mp4, or take one of the still outputs, such as 'cube': this output is a video.", "format"
        )
    if output.media_type != PNG and file_format is not None and output.media_type != f"image/{file_format}":
        raise InvalidInputError("Leave the format out: this picture comes only as it is stored.", "format")
    if file_format == "webm" or file_format == "mp4":
        raise InvalidInputError("Ask for png, jpeg, webp or tiff: this output is a still picture.", "format")
    return output.name


class Outputs:
    """Finds outputs, and has those made that are not stored.

    Parameters
    ----------
    store, queue, blobs, executor, renditions, watching
        Those of the service.
    queue_limit : int
        Jobs that may wait before another output at 16 bits is refused.
    shares : Shares
        And those of one client.
    """

    def __init__(
        self,
        store: ExperimentStore,
        queue: JobQueue,
        blobs: BlobStore,
        executor: Executor,
        renditions: Renditions,
        watching: Watching,
        *,
        queue_limit: int,
        shares: Shares,
    ) -> None:
        self._store = store
        self._queue = queue
        self._blobs = blobs
        self._executor = executor
        self._renditions = renditions
        self._watching = watching
        self._queue_limit = queue_limit
        self._shares = shares

    def get(self, experiment_id: str, name: str) -> tuple[Output, Path]:
        """Find an output and its file. Raises `NotFoundError`, also while it is not there yet."""
        return self._get(self._renditions, experiment_id, name)

    async def fetch(self, experiment_id: str, name: str) -> tuple[Output, Path]:
        """Find an output as `get` does, without a wait for pictures that are still to be made."""

        def find(renditions: Renditions) -> tuple[Output, Path]:
            return self._get(renditions, experiment_id, name)

        return await found_or_made(self._renditions, find)

    def _get(self, renditions: Renditions, experiment_id: str, name: str) -> tuple[Output, Path]:
        experiment = self._store.get(experiment_id)
        if name in DERIVED:
            return renditions.derive(name, self._output(experiment, "crop"), self._output(experiment, "texture"))
        output = self._output(experiment, name)
        return output, self._blobs.path(output.digest)

    async def convert(
        self,
        experiment_id: str,
        name: str,
        file_format: AnyFormat | None,
        depth: Literal[8, 16] | None = None,
        client: str | None = None,
    ) -> tuple[Path, str]:
        """Convert an output to another format and depth; its file and media type.

        By default it is as it is stored, and of a video WebM. At 16 bits it is computed when first asked for, in the
        turn of this client; by default in that of the experiment's owner.

        Raises
        ------
        InvalidInputError
            If the format or the output does not come at this depth.
        BusyError
            If the engine did not get to it soon enough; trying again later helps.
        QuotaError
            If too much of this client waits already.
        """
        output = await self.make_source(experiment_id, name, file_format, depth, client)
        return await self.render(output, file_format, depth)

    def find_source(
        self, experiment_id: str, name: str, file_format: AnyFormat | None, depth: Literal[8, 16] | None
    ) -> Output | None:
        """Find what `convert` converts: a stored output; None while it is to be computed at 16 bits.

        Raises
        ------
        InvalidInputError
            As `convert`.
        """
        experiment = self._store.get(experiment_id)
        output = self._output(experiment, name)
        output = self._output(experiment, name_of_file(output, file_format or ("webm" if output.video else None)))
        if depth != 16:
            return output
        check_deep(file_format)
        if not output.video and read_depth(self._blobs.path(output.digest)) == 16:
            return output
        refuse_deep(possible_output(method_named(experiment.method), output.name), experiment.depth)
        return experiment.output(deep_name(output.name))

    async def make_source(
        self,
        experiment_id: str,
        name: str,
        file_format: AnyFormat | None,
        depth: Literal[8, 16] | None,
        client: str | None = None,
    ) -> Output:
        """Find what `convert` converts, or have it computed first, in a job of its own. Raises as `convert`."""
        output = await threads.run(threads.RECORDS, self.find_source, experiment_id, name, file_format, depth)
        if output is not None:
            return output
        job = deep_job(experiment_id, name)
        await threads.run(threads.RECORDS, self._enqueue, experiment_id, job, client)
        if not await self._watching.wait_until_left(job, DEEP_SECONDS):
            raise BusyError(f"The {name} at 16 bits is still being computed. Try again in a minute.")
        output = await threads.run(threads.RECORDS, self.find_source, experiment_id, name, file_format, depth)
        if output is None:
            failure = await threads.run(threads.RECORDS, self._queue.failure, job)
            raise AppError(failure or f"The {name} at 16 bits could not be computed. Try again.")
        return output

    async def render(
        self, output: Output, file_format: AnyFormat | None, depth: Literal[8, 16] | None
    ) -> tuple[Path, str]:
        """Write a stored output in this format and depth; its file and media type."""
        if output.media_type != PNG:
            return self._blobs.path(output.digest), output.media_type
        assert file_format != "webm"  # `name_of_file` lets these through for videos only
        assert file_format != "mp4"
        return await found_or_made(
            self._renditions, lambda renditions: renditions.convert(output, file_format or "png", depth)
        )

    def _output(self, experiment: Experiment, name: str) -> Output:
        output = experiment.output(name)
        if output is not None:
            return output
        if not experiment.status.finished:
            raise NotFoundError("This experiment has no outputs yet: it is not finished.")
        names = ", ".join(output.name for output in experiment.outputs if output.listed)
        raise NotFoundError(f"This experiment has no output {name!r}. It has: {names or 'none'}.")

    def _enqueue(self, experiment_id: str, job: str, client: str | None) -> None:
        if not self._queue.states([job]):
            check_queue(self._queue, self._queue_limit)
            client = client or self._store.get(experiment_id).owner
            self._shares.check(client)
            self._queue.enqueue(job, client)
            self._executor.wake()

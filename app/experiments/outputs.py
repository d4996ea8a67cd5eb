"""The outputs of an experiment as files: as they are stored, in other formats, at 16 bits."""

import asyncio
from pathlib import Path
from typing import Literal

from app.errors import AppError, BusyError, InvalidInputError, NotFoundError
from app.experiments.following import Following
from app.experiments.model import Experiment, Output
from app.experiments.pictures import DERIVED, FilmFormat, Pictures
from app.experiments.ports import BlobStore, Executor, ExperimentStore
from app.experiments.run import DEEP, DEEP_TEXTURE
from app.images.convert import Format

AnyFormat = Format | FilmFormat
MP4_SUFFIX = "-mp4"  # ends the name of a film's second file: see `app.methods.films`
DEEP_SECONDS = 120.0  # how long a download waits for its texture at 16 bits


class Outputs:
    """Finds outputs and has made what is not stored.

    Parameters
    ----------
    store, blobs, executor, pictures, following
        Those of the service.
    queue_limit : int
        Jobs that may wait before another texture at 16 bits is refused.
    """

    def __init__(
        self,
        store: ExperimentStore,
        blobs: BlobStore,
        executor: Executor,
        pictures: Pictures,
        following: Following,
        *,
        queue_limit: int,
    ) -> None:
        self._store = store
        self._blobs = blobs
        self._executor = executor
        self._pictures = pictures
        self._following = following
        self._queue_limit = queue_limit
        self._failures: dict[str, str] = {}

    def output(self, experiment_id: str, name: str) -> tuple[Output, Path]:
        """An output's record and its file. Raises `NotFoundError`, also while it is not there yet."""
        experiment = self._store.get(experiment_id)
        if name in DERIVED:
            return self._pictures.derived(name, self._output(experiment, "crop"), self._output(experiment, "texture"))
        output = self._output(experiment, name)
        return output, self._blobs.path(output.digest)

    async def converted(
        self, experiment_id: str, name: str, file_format: AnyFormat | None, depth: Literal[8, 16] | None
    ) -> tuple[Path, str]:
        """An output in another format, and its media type; by default PNG, and WebM of a film."""
        experiment = await asyncio.to_thread(self._store.get, experiment_id)
        output = self._output(experiment, name)
        if output.frames > 1:
            film = self._film(experiment, output, file_format, depth)
            return self._blobs.path(film.digest), film.media_type
        if file_format == "webm" or file_format == "mp4":
            raise InvalidInputError("This is a still picture: ask for png, jpeg, webp or tiff.", "format")
        file_format = file_format or "png"
        if depth == 16:
            self._pictures.check_deep(file_format)
            output = await self._deep_texture(experiment, output)
        return await asyncio.to_thread(self._pictures.converted, output, file_format)

    def failed(self, job: str, failure: str) -> None:
        """Remember why a texture at 16 bits could not be made, for who waits for it."""
        self._failures[job] = failure

    def _output(self, experiment: Experiment, name: str) -> Output:
        output = experiment.output(name)
        if output is not None:
            return output
        if not experiment.status.finished:
            raise NotFoundError("This experiment has no outputs yet: it is not finished.")
        names = ", ".join(output.name for output in experiment.outputs if output.listed)
        raise NotFoundError(f"This experiment has no output {name!r}. It has: {names or 'none'}.")

    def _film(
        self, experiment: Experiment, output: Output, file_format: AnyFormat | None, depth: Literal[8, 16] | None
    ) -> Output:
        """The output's film in this format: both are stored."""
        if depth == 16:
            raise InvalidInputError("A video has 8 bits per channel: leave the depth out.", "depth")
        name = output.name.removesuffix(MP4_SUFFIX)
        files = {file.media_type: file for file in experiment.outputs if file.name in (name, name + MP4_SUFFIX)}
        found = files.get(f"video/{file_format or 'webm'}")
        if found is None:
            raise InvalidInputError(
                "This is a moving picture: ask for webm or mp4, or take one of the still outputs, such as 'cube'."
                if output.film
                else "This picture comes only as it is stored: leave the format out.",
                "format",
            )
        return found

    async def _deep_texture(self, experiment: Experiment, output: Output) -> Output:
        if output.name != "texture":
            raise InvalidInputError("Only the texture itself comes at 16 bits per channel.", "depth")
        deep = experiment.output(DEEP_TEXTURE)
        if deep is not None:
            return deep
        job = f"{experiment.id}{DEEP}"
        if self._executor.snapshot(job) is None:
            if self._executor.waiting >= self._queue_limit:
                raise BusyError("Too many experiments wait already. Try again in a minute.")
            self._failures.pop(job, None)
            self._executor.submit(job)
        if not await self._following.left(job, DEEP_SECONDS):
            raise BusyError("The texture at 16 bits is still being computed. Try again in a minute.")
        deep = (await asyncio.to_thread(self._store.get, experiment.id)).output(DEEP_TEXTURE)
        if deep is None:
            raise AppError(self._failures.pop(job, "The texture at 16 bits could not be computed. Try again."))
        return deep

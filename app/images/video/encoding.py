"""Parallel encoding of several files of one video: every encoder works in a thread of its own."""

from collections import deque
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from types import TracebackType
from typing import Self

from app.images.video.writers import Frame, VideoWriter
from app.synthesis.arrays import PartDone

WAITING = 2  # frames that wait for an encoder before `write` does
PATIENCE = 0.1  # seconds between two calls of `progress` while encoders finish


class Encoding:
    """Context manager that hands every frame to several writers; leaving it removes unfinished files.

    Parameters
    ----------
    writers : sequence of VideoWriter
        They are closed on leaving.
    """

    def __init__(self, writers: Sequence[VideoWriter]) -> None:
        self._writers = writers
        self._threads = [ThreadPoolExecutor(1, "encode") for _ in writers]
        self._pending: list[deque[Future[None]]] = [deque() for _ in writers]

    def write(self, frame: Frame) -> None:
        """Queue a frame, (H, W, C) uint8, which the caller must not change afterwards; wait while queues are full."""
        for writer, thread, pending in zip(self._writers, self._threads, self._pending, strict=True):
            if len(pending) > WAITING:
                pending.popleft().result()
            pending.append(thread.submit(writer.write, frame))

    def finish(self, progress: PartDone) -> None:
        """Wait until every file is complete; ``progress`` is called with the share that is done, 0 to 1.

        Raises
        ------
        OSError
            If a file cannot be written; also what ``progress`` raises.
        """
        for writer, thread, pending in zip(self._writers, self._threads, self._pending, strict=True):
            pending.append(thread.submit(writer.finish))
        jobs = [job for pending in self._pending for job in pending]
        unfinished = set(jobs)
        while unfinished:
            progress(1 - len(unfinished) / len(jobs))
            done, unfinished = wait(unfinished, PATIENCE)
            for job in done:
                job.result()
        progress(1.0)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for thread in self._threads:
            thread.shutdown(cancel_futures=True)
        for writer in self._writers:
            writer.close()

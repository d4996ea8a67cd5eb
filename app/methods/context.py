"""Context of a run: depth, threads, scratch directory and progress."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from app.methods.stages import Plan, Stages

Progress = Callable[[str, float], None]
"""Callback ``(stage, fraction)`` between pieces of work; it raises when the experiment is cancelled or out of time.

``stage`` is a short lower-case name (``"periodic component"``), ``fraction`` the part of the run that is done, 0–1. The
time from one stage's first call to the next stage's is that stage's time in the record.
"""


@dataclass(frozen=True)
class Context:
    """What a run may use.

    Parameters
    ----------
    depth : {8, 16}
        Bits per channel of still pictures.
    threads : int
    progress : callable ``(stage, fraction)``
        Whoever starts a run is called with the part of the run that is done. A method's own ``run`` is handed the
        `app.methods.stages.Stages` that it declares, and calls them with the part of the *stage* that is done, as the
        numerics do.
    scratch : Path
        Directory for files that are too large to be kept in memory until they are given back.
    """

    depth: Literal[8, 16]
    threads: int
    progress: Progress
    scratch: Path = field(default_factory=lambda: Path(tempfile.gettempdir()))

    def during(self, stage: str, plan: Plan) -> Stages:
        """Divide one stage into steps that are reported under its name."""
        return Stages(plan, lambda step, part: self.progress(stage, part))

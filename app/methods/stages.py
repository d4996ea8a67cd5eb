"""Stages of a run and their weights: turns the part of a stage that is done into the part of the run."""

from collections.abc import Sequence

from app.synthesis.arrays import Progress

Plan = Sequence[tuple[str, float]]
"""Names of stages in the order in which they come, each with its weight: about how long it takes beside the others.

A name may come again, as that of another stage.
"""


class Stages:
    """Progress of a run whose work reports its stages; to be called like any progress callback.

    Parameters
    ----------
    plan : Plan
    report : callable ``(stage, fraction)``
        Called with the part of the whole plan that is done. It never falls, as stages come in the plan's order and the
        part of none of them falls; the weights of stages that are left out are skipped.

    Examples
    --------
    >>> stages = Stages((("spot", 1), ("texture", 3)), lambda stage, fraction: print(stage, fraction))
    >>> stages("spot", 0.5)
    spot 0.125
    >>> stages("texture", 1 / 3)
    texture 0.5
    >>> stages.finish()
    texture 1.0
    """

    def __init__(self, plan: Plan, report: Progress) -> None:
        total = sum(weight for _, weight in plan)
        self._names = [name for name, _ in plan]
        self._bounds = [sum(weight for _, weight in plan[:index]) / total for index in range(len(plan))] + [1.0]
        self._report = report
        self._index, self._part = 0, 0.0

    def __call__(self, stage: str, part: float) -> None:
        """Report that a part of a stage is done: of the current one, or of the next one of this name.

        Raises
        ------
        LookupError
            If no such stage comes any more: it is not declared, or not in this place.
        """
        self._move(stage, part)
        self._report(stage, self._fraction())

    def within(self, stage: str) -> Progress:
        """Make a progress callback for work that is one stage here and has stages of its own, whose names it keeps."""

        def report(name: str, fraction: float) -> None:
            self._move(stage, fraction)
            self._report(name, self._fraction())

        return report

    def finish(self) -> None:
        """Report that all is done, under the name of the last stage."""
        self._index, self._part = len(self._names) - 1, 1.0
        self._report(self._names[-1], 1.0)

    def _move(self, stage: str, part: float) -> None:
        if self._names[self._index] != stage or part < self._part:
            try:
                self._index = self._names.index(stage, self._index + (self._names[self._index] == stage))
            except ValueError:
                raise LookupError(
                    f"The stage {stage!r} is not declared after {self._names[self._index]!r}; the stages are: "
                    f"{', '.join(self._names)}."
                ) from None
        self._part = part

    def _fraction(self) -> float:
        begin, end = self._bounds[self._index : self._index + 2]
        return begin + self._part * (end - begin)

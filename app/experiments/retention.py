"""Retention of experiments by age: when one goes by itself."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Self

from app.experiments.model import Experiment
from app.gallery.exhibits import exhibits
from app.settings import Settings


@dataclass(frozen=True)
class Retention:
    """How long finished experiments are kept; None is for ever.

    Parameters
    ----------
    unlisted, every : timedelta, optional
        Those that no archive lists, and all; of two the shorter one counts.
    """

    unlisted: timedelta | None = None
    every: timedelta | None = None

    @classmethod
    def by(cls, settings: Settings) -> Self:
        """Read it from the settings."""
        return cls(_days(settings.keep_unlisted_days), _days(settings.keep_days))

    def end(self, experiment: Experiment) -> datetime | None:
        """Tell when an experiment goes; None for one that stays, that has not finished, or that a page shows."""
        if experiment.finished_at is None or experiment.id in exhibits():
            return None
        limits = [self.every] if experiment.listed else [self.every, self.unlisted]
        kept = [limit for limit in limits if limit is not None]
        return experiment.finished_at + min(kept) if kept else None


def _days(number: float | None) -> timedelta | None:
    return None if number is None else timedelta(days=number)

"""What a worker does with a job: it hands the lease to the run, lets through what that raises, gives memory back."""

import pytest

from app.errors import STORAGE, UnavailableError
from app.executor import tasks
from app.executor.tasks import work
from app.experiments.model import Lease
from app.settings import Settings


@pytest.mark.parametrize("error", [None, UnavailableError(STORAGE, "It is away."), ZeroDivisionError()])
def test_memory_is_given_back_whatever_it_raises(monkeypatch: pytest.MonkeyPatch, error: Exception | None) -> None:
    given_back: list[bool] = []
    monkeypatch.setattr(tasks, "give_back", lambda: given_back.append(True))
    lease, settings = Lease("job", 7), Settings()

    def run(*arguments: object) -> None:
        assert arguments == (settings, lease)
        if error is not None:
            raise error

    if error is None:
        work(run, settings, lease)
    else:
        with pytest.raises(type(error)):
            work(run, settings, lease)
    assert given_back == [True]

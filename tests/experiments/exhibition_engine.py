"""An engine and a queue for the exhibition's tests: exhibits are begun in them, and end as the test says."""

from collections.abc import Callable, Collection

from app.experiments.model import Experiment
from app.experiments.service import Service


class Engine:
    """An engine and its queue: notes what is begun, and tells ``record``, which may end it or note it as running."""

    def __init__(self, service: Service, record: Callable[[str], object] = lambda job: None) -> None:
        self.waits = 0
        self.jobs: list[str] = []
        self.running: set[str] = set()
        self._service, self._record, self._replace = service, record, service._store.replace
        for part in ("_queue", "_executor"):
            setattr(service.exhibition, part, self)
        service._store.replace = self.replace  # type: ignore[method-assign, assignment]

    def replace(self, experiment: Experiment, client: str) -> None:
        self._replace(experiment, client)
        self.jobs.append(experiment.id)
        self._record(experiment.id)

    def wake(self) -> None: ...

    def waiting(self) -> int:
        return self.waits

    def states(self, jobs: Collection[str]) -> dict[str, object]:
        return dict.fromkeys(self.running & set(jobs))

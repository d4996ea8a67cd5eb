"""The program's own experiments are made once, for good, and of nothing but what they declare."""

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from app.errors import DeletedError, ForbiddenError, InvalidInputError, NotFoundError
from app.experiments import exhibition
from app.experiments.model import Status
from app.experiments.service import Service
from app.gallery.exhibits import exhibits
from app.gallery.identity import identifier
from app.methods.explanations.model import Exhibit
from app.settings import ROOT, Settings
from tests.experiments.exhibition_engine import Engine
from tests.experiments.jobs import lease_of

SAMPLES = ROOT / "samples"
DRAWN = ("two_sinusoids", "lit_plaster")
WAVES = Exhibit("rpn", (("two_sinusoids", "0,0,64,64"),), {"seed": 1})
PLASTER = Exhibit("adsn", (("lit_plaster", "0,0,64,48"),), {"seed": 2})


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Bundled samples that are small and quickly taken in."""
    directory = tmp_path_factory.mktemp("drawn")
    entries = json.loads((SAMPLES / "catalogue.json").read_text(encoding="utf-8"))
    chosen = [entry for entry in entries if Path(entry["file"]).stem in DRAWN]
    (directory / "catalogue.json").write_text(json.dumps(chosen), encoding="utf-8")
    for entry in chosen:
        (directory / entry["file"]).symlink_to(SAMPLES / entry["file"])
    return directory


@pytest.fixture
def settings(tmp_path: Path, samples: Path) -> Settings:
    return Settings(data_dir=tmp_path / "data", samples_dir=samples, operator_token="the operator", threads=1)


@pytest.fixture
def two(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two exhibits are declared, and one more whose sample is not here."""
    away = Exhibit("rpn", (("gravel_gray", "0,0,64,64"),))
    declared = {identifier(exhibit): exhibit for exhibit in (WAVES, PLASTER, away)}
    monkeypatch.setattr(exhibition, "exhibits", lambda: declared)


@pytest.fixture
def filled(service: Service, two: None) -> Service:
    assert service.exhibition.fill(threading.Event()) == exhibition.Filled(made=2, without_sample=1)
    return service


def test_made_twice_it_gives_the_same_bytes(filled: Service) -> None:
    digests = [output.digest for output in filled.exhibition.find(WAVES).outputs]
    told = []
    again = filled.exhibition.fill(threading.Event(), again=True, on_done=lambda *args: told.append(args))
    assert again == exhibition.Filled(made=2, without_sample=1)
    assert [output.digest for output in filled.exhibition.find(WAVES).outputs] == digests
    assert told == [(1, 2, WAVES, None), (2, 2, PLASTER, None)]


def test_what_is_made_is_not_made_again(filled: Service) -> None:
    assert filled.exhibition.fill(threading.Event()) == exhibition.Filled(kept=2, without_sample=1)


def test_it_is_in_no_archive_and_survives_pruning(filled: Service, monkeypatch: pytest.MonkeyPatch) -> None:
    """What no page declares any more goes like any other experiment."""
    assert filled.experiments.page().experiments == ()
    monkeypatch.setattr("app.experiments.housekeeping.exhibits", lambda: {identifier(WAVES): WAVES})
    assert filled.housekeeping.prune(timedelta(0)).experiments == 1
    assert filled.exhibition.find(WAVES).status is Status.SUCCEEDED
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        filled.experiments.get(identifier(PLASTER))


def test_only_the_operator_may_delete_it_and_it_stays_deleted_until_made_again(filled: Service) -> None:
    with pytest.raises(ForbiddenError, match="Only the owner of this experiment may do this"):
        filled.experiments.cancel_or_delete(identifier(WAVES), exhibition.OWNER)
    filled.experiments.cancel_or_delete(identifier(WAVES), "the operator")
    assert filled.exhibition.find(WAVES) is None
    assert filled.exhibition.fill(threading.Event()).made == 0
    assert filled.exhibition.fill(threading.Event(), again=True).made == 2
    assert filled.exhibition.find(WAVES).status is Status.SUCCEEDED


def test_what_failed_is_tried_again(service: Service, two: None, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:
        broken.setattr("app.experiments.computation.read_crop", lambda *args: 1 / 0)
        assert service.exhibition.fill(threading.Event()).failed == 2
    assert service.exhibition.find(WAVES).status is Status.FAILED
    assert service.exhibition.fill(threading.Event()).made == 2


def test_the_service_makes_what_is_missing_in_the_background(
    make_service: Callable[..., Service], settings: Settings, two: None
) -> None:
    service = make_service(settings.model_copy(update={"catalogue": True}))
    service.start()
    moments, deadline = threading.Event(), 1200
    while deadline and not ((found := service.exhibition.find(PLASTER)) and found.status.finished):
        moments.wait(0.05)
        deadline -= 1
    assert service.exhibition.find(PLASTER).status is Status.SUCCEEDED


def test_nothing_is_begun_while_somebody_waits(filled: Service) -> None:
    """It asks again and again: here until the fifth time it is told that somebody waits."""
    engine, asked = Engine(filled), list[float | None]()
    engine.waits = 1

    class Closing(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            assert engine.jobs == [] or engine.waits == 0
            asked.append(timeout)
            engine.waits = 0 if len(asked) == 5 else engine.waits
            return False

    filled.exhibition.fill(Closing(), again=True)
    assert engine.jobs == [identifier(WAVES), identifier(PLASTER)]
    assert len(asked) == 5


Done = list[tuple[int, int, Exhibit, str | None]]


def fill(service: Service, **values: Any) -> tuple[exhibition.Filled, Done]:
    done: Done = []
    filled = service.exhibition.fill(threading.Event(), on_done=lambda *args: done.append(args), **values)
    return filled, done


def test_what_fails_is_counted_and_reported_with_its_reason(filled: Service) -> None:
    """One that failed, and one that was cancelled, which has no reason of its own."""
    store: Any = filled._store

    def end(job: str) -> None:
        if job == identifier(PLASTER):
            assert store.cancel(job)
        else:
            assert store.fail(lease_of(store, job), "too large")

    Engine(filled, end)
    counts, done = fill(filled, again=True)
    assert counts == exhibition.Filled(failed=2, without_sample=1)
    assert done == [(1, 2, WAVES, "too large"), (2, 2, PLASTER, "It was cancelled.")]


def test_what_is_deleted_while_it_is_made_is_reported(filled: Service) -> None:
    Engine(filled, filled._store.delete)
    counts, done = fill(filled, again=True)
    assert counts == exhibition.Filled(failed=2, without_sample=1)
    assert {error for _, _, _, error in done} == {"It could not be begun; the log says why."}


def test_one_that_cannot_be_prepared_is_logged_and_keeps_no_other_from_being_made(
    service: Service, two: None, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    prepare_it = service.exhibition.prepare

    def refusing(exhibit: Exhibit) -> Any:
        if exhibit is WAVES:
            raise InvalidInputError("The crop is too small.")
        return prepare_it(exhibit)

    monkeypatch.setattr(service.exhibition, "prepare", refusing)
    counts, done = fill(service)
    assert counts == exhibition.Filled(made=1, failed=1, without_sample=1)
    assert done == [(1, 2, WAVES, "It could not be begun; the log says why."), (2, 2, PLASTER, None)]
    assert [record.message for record in caplog.records] == ["an exhibit of rpn cannot be made: The crop is too small."]


def test_as_many_are_begun_at_once_as_are_asked_for(filled: Service) -> None:
    begun: list[int] = []

    def begin(job: str) -> None:
        engine.running.add(job)
        begun.append(len(engine.running))

    engine = Engine(filled, begin)

    class Closing(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            if len(begun) == 2:
                engine.running.clear()
            return False

    filled.exhibition.fill(Closing(), again=True, at_once=2)
    assert begun == [1, 2]
    assert engine.jobs == [identifier(WAVES), identifier(PLASTER)]


@pytest.mark.parametrize("seen", [True, False])
def test_two_processes_make_an_exhibit_once(filled: Service, monkeypatch: pytest.MonkeyPatch, seen: bool) -> None:
    """The second leaves the first one's alone, whether that waits already or is added at the same moment."""
    first = filled.exhibition.prepare(WAVES)
    Engine(filled)
    filled._store.replace(first, "another process")
    find = filled.exhibition.find
    if not seen:
        monkeypatch.setattr(filled.exhibition, "find", lambda exhibit: None)
    filled.exhibition._begin(WAVES, False)
    made = find(WAVES)
    assert made is not None
    assert made.created_at == first.created_at


def test_a_fault_of_the_background_is_logged_and_the_pages_no_longer_promise_figures(
    make_service: Callable[..., Service],
    settings: Settings,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    service = make_service(settings.model_copy(update={"catalogue": True}))
    assert service.exhibition.making

    def failing(closing: threading.Event) -> None:
        raise OSError("database is locked")

    monkeypatch.setattr(service.exhibition, "fill", failing)
    service.exhibition.keep(threading.Event())
    assert [record.message for record in caplog.records] == [
        "the catalogue could not be made; the next start tries again"
    ]
    assert "database is locked" in caplog.text
    assert not service.exhibition.making


def test_samples_that_cannot_be_taken_in_keep_no_command_waiting(
    make_service: Callable[..., Service], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`fill` waits for them; a fault there ends the waiting, and is the thread's own."""
    exhibits_of = make_service(settings).exhibition

    def failing(closing: threading.Event) -> None:
        raise OSError("the disk is gone")

    monkeypatch.setattr(exhibits_of._samples, "add_bundled", failing)
    with pytest.raises(OSError, match="gone"):
        exhibits_of.keep(threading.Event())
    monkeypatch.setattr(exhibition, "exhibits", dict)
    assert exhibits_of.fill(threading.Event()) == exhibition.Filled()


def test_filling_ends_with_the_service_while_the_samples_are_not_in(
    make_service: Callable[..., Service], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exhibition, "POLL_SECONDS", 0.001)
    closing = threading.Event()
    closing.set()
    assert make_service(settings).exhibition.fill(closing) == exhibition.Filled()


def test_an_exhibit_that_nobody_made_is_not_found_but_can_be_prepared(filled: Service) -> None:
    other = Exhibit("rpn", WAVES.inputs, {"seed": 3})
    assert filled.exhibition.find(other) is None
    assert filled.exhibition.prepare(other).parameters["width"] == 64
    with pytest.raises(NotFoundError, match="There is no such photograph"):
        filled.exhibition.prepare(Exhibit("rpn", (("nothing", "0,0,9,9"),)))


@pytest.mark.slow
def test_the_command_says_what_it_makes(tmp_path: Path, samples: Path) -> None:
    """With a real engine, on what can be made of the drawn samples."""
    environment = {
        **os.environ,
        "MICROTEXTURE_DATA_DIR": str(tmp_path),
        "MICROTEXTURE_SAMPLES_DIR": str(samples),
        "MICROTEXTURE_WORKERS": "2",
    }
    command = [str(Path(sys.executable).parent / "microtexture"), "catalogue"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    here = [exhibit for exhibit in exhibits().values() if set(dict(exhibit.inputs)) <= set(DRAWN)]
    assert done.stdout == f"Made {len(here)} figures, 0 failed, 0 were there already.\n"
    assert f"\n{len(here)}/{len(here)} " in done.stderr
    assert "MICROTEXTURE_SAMPLES_DIR" in done.stderr

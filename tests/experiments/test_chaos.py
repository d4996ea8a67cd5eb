"""What was accepted is finished, whatever is killed."""

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
import pytest

from app.experiments.model import Status
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.settings import Settings

pytestmark = pytest.mark.chaos

PROGRAM = Path(__file__).with_name("service_process.py")
ROOT = Path(__file__).resolve().parents[2]
SECONDS = 120.0
SIDE = 1500  # takes most of a second: long enough to be caught in the middle


@contextmanager
def service_process(settings: Settings) -> Iterator[subprocess.Popen[bytes]]:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, str(PROGRAM), str(settings.data_dir)]
    process = subprocess.Popen(command, env=environment, start_new_session=True)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(SECONDS)


def until(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + SECONDS
    while not condition():
        assert time.monotonic() < deadline, "what was waited for did not come"
        time.sleep(0.01)


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"max_output_pixels": SIDE * SIDE})


@pytest.mark.parametrize("whole_group", [True, False], ids=["with its workers", "alone"])
def test_a_killed_service_finishes_after_a_restart_as_if_nothing_had_happened(
    settings: Settings, upload: Path, make_service: Callable[..., Service], whole_group: bool
) -> None:
    """The bytes are those of an undisturbed run, and a service that is killed alone takes its workers along."""
    idle = make_service()
    inputs = (NewInput(idle.samples.add(upload, None).id),)
    request = NewExperiment("rpn", inputs, {"width": SIDE, "height": SIDE, "seed": 9})
    disturbed = idle.submission.submit(request, "owner").id
    with service_process(settings) as process:
        until(lambda: idle.experiments.get(disturbed).status is Status.RUNNING)
        family = psutil.Process(process.pid).children(recursive=True)
        assert family
        if whole_group:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.wait(SECONDS)
        assert psutil.wait_procs(family, SECONDS)[1] == []
    assert not idle.experiments.get(disturbed).status.finished
    undisturbed = idle.submission.submit(request, "owner").id
    with service_process(settings) as process:
        for experiment_id in (disturbed, undisturbed):
            assert asyncio.run(idle.watching.wait(experiment_id, SECONDS)).status is Status.SUCCEEDED
        family = psutil.Process(process.pid).children(recursive=True)
        process.send_signal(signal.SIGTERM)
        process.wait(SECONDS)
        assert psutil.wait_procs(family, SECONDS)[1] == []
    one, other = idle.experiments.get(disturbed), idle.experiments.get(undisturbed)
    assert one.attempts == other.attempts == ()  # nobody but us is to blame
    assert one.outputs == other.outputs

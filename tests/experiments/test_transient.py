"""Textures straight from files, of which nothing is kept."""

import asyncio
import shutil
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from app.errors import InvalidInputError, UnsupportedFormatError
from app.experiments.model import Experiment
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Rectangle

Stored = Callable[[], set[str]]
OWNER = "the owner's token"
SECONDS = 30.0


def test_a_texture_straight_from_a_file_leaves_nothing_behind(
    service: Service, photograph: Path, upload: Path, stored: Stored
) -> None:
    parameters = {"seed": 4}
    sample = service.samples.add(Path(shutil.copy(photograph, photograph.with_suffix(".copy"))), None)
    experiment = service.submission.submit(NewExperiment("adsn", (NewInput(sample.id),), parameters), OWNER)
    asyncio.run(service.watching.wait(experiment.id, SECONDS))
    expected = service.outputs.get(experiment.id, "texture")[1].read_bytes()
    service.experiments.cancel_or_delete(experiment.id, OWNER)
    picture, media_type = asyncio.run(
        service.transient.synthesize([upload], method="adsn", crops=[None], parameters=parameters)
    )
    assert (picture, media_type) == (expected, "image/png")
    assert stored() == set()
    assert sum(service.experiments.counts().values()) == 0


def test_a_refused_texture_straight_from_a_file_leaves_nothing_behind(
    service: Service, upload: Path, stored: Stored
) -> None:
    with pytest.raises(InvalidInputError, match="The crop 0,0,999,9 reaches outside the photograph, which"):
        asyncio.run(
            service.transient.synthesize([upload], method="rpn", crops=[Rectangle(0, 0, 999, 9)], parameters={})
        )
    assert stored() == set()


def test_a_caller_who_hangs_up_cancels_the_run(
    upload: Path, make_service: Callable[..., Service], stored: Stored
) -> None:
    service = make_service()

    async def hanging_up() -> None:
        work = asyncio.create_task(service.transient.synthesize([upload], method="rpn", crops=[None], parameters={}))
        while service.waiting == 0:
            await asyncio.sleep(0.005)
        work.cancel()
        with pytest.raises(asyncio.CancelledError):
            await work

    asyncio.run(hanging_up())
    assert service.waiting == 0
    assert stored() == set()


def test_a_caller_who_hangs_up_while_it_is_submitted_leaves_nothing_behind(
    upload: Path, make_service: Callable[..., Service], monkeypatch: pytest.MonkeyPatch, stored: Stored
) -> None:
    service = make_service()
    added, hung_up = threading.Event(), threading.Event()
    add = service._store.add

    def slow_add(experiment: Experiment, client: str) -> None:
        add(experiment, client)
        added.set()
        assert hung_up.wait(SECONDS)

    monkeypatch.setattr(service._store, "add", slow_add)

    async def hanging_up() -> None:
        work = asyncio.create_task(service.transient.synthesize([upload], method="rpn", crops=[None], parameters={}))
        assert await asyncio.to_thread(added.wait, SECONDS)
        work.cancel()
        asyncio.get_running_loop().call_soon(hung_up.set)
        with pytest.raises(asyncio.CancelledError):
            await work

    asyncio.run(hanging_up())
    assert service.waiting == 0
    assert sum(service.experiments.counts().values()) == 0
    assert stored() == set()


def test_more_crops_than_files_are_refused_and_leave_nothing_behind(
    service: Service, upload: Path, stored: Stored
) -> None:
    with pytest.raises(InvalidInputError, match="more crops"):
        asyncio.run(service.transient.synthesize([upload], method="rpn", crops=[None, None], parameters={}))
    assert not upload.exists()
    assert stored() == set()


def test_of_several_files_none_is_left_if_one_is_no_picture(service: Service, upload: Path, stored: Stored) -> None:
    broken = upload.with_name("broken")
    broken.write_bytes(b"no picture")
    with pytest.raises(UnsupportedFormatError, match="This file is not in a format that can be read"):
        asyncio.run(service.transient.synthesize([upload, broken], method="rpn", crops=[], parameters={}))
    assert not upload.exists()
    assert not broken.exists()
    assert stored() == set()

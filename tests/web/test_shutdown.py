"""A server that is told to stop ends what waits, and leaves the signals as they were."""

import asyncio
import signal
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from app.web.shutdown import on_stop_signal, unless_stopping


def request(stopping: asyncio.Event) -> Any:
    return SimpleNamespace(app=SimpleNamespace(state=SimpleNamespace(stopping=stopping)))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_signal_reaches_us_and_then_the_server_s_own_handler(number: signal.Signals) -> None:
    calls: list[str] = []
    before = signal.signal(number, lambda *_: calls.append("server"))
    try:
        with on_stop_signal(lambda: calls.append("ours")):
            signal.raise_signal(number)
        assert calls == ["ours", "server"]
        signal.raise_signal(number)
        assert calls == ["ours", "server", "server"]
    finally:
        signal.signal(number, before)


def test_a_handler_that_was_set_meanwhile_stays() -> None:
    before = signal.getsignal(signal.SIGTERM)

    def other(*_: object) -> None: ...

    try:
        with on_stop_signal(lambda: None):
            signal.signal(signal.SIGTERM, other)
        assert signal.getsignal(signal.SIGTERM) is other
    finally:
        signal.signal(signal.SIGTERM, before)


def test_outside_the_main_thread_the_signals_are_left_alone() -> None:
    seen: list[object] = []

    def run() -> None:
        with on_stop_signal(lambda: None):
            seen.append(signal.getsignal(signal.SIGTERM))

    before = signal.getsignal(signal.SIGTERM)
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert seen == [before]


async def _cancelled(seen: list[str]) -> str:
    try:
        await asyncio.Event().wait()
    finally:
        seen.append("ended")
    return "never"


def test_what_waits_is_cancelled_when_the_server_stops() -> None:
    async def scenario() -> tuple[str | None, list[str]]:
        stopping, seen = asyncio.Event(), list[str]()
        asyncio.get_running_loop().call_soon(stopping.set)
        return await unless_stopping(request(stopping), _cancelled(seen)), seen

    assert asyncio.run(asyncio.wait_for(scenario(), 5)) == (None, ["ended"])


def test_what_is_done_in_time_has_its_result_and_what_fails_its_error() -> None:
    async def done() -> str:
        return "result"

    async def fails() -> str:
        raise ValueError("wrong")

    async def scenario(waiting: Any) -> Any:
        return await unless_stopping(request(asyncio.Event()), waiting)

    assert asyncio.run(scenario(done())) == "result"
    with pytest.raises(ValueError, match="wrong"):
        asyncio.run(scenario(fails()))


def test_a_client_that_leaves_takes_its_waiting_along() -> None:
    async def scenario() -> list[str]:
        seen: list[str] = []
        task = asyncio.ensure_future(unless_stopping(request(asyncio.Event()), _cancelled(seen)))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        task.cancel()
        await asyncio.wait({task})
        return seen

    assert asyncio.run(scenario()) == ["ended"]

"""Moving windows: what fits is what a plain list of moments says, whatever the clock of the wall does."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from limits import RateLimitItemPerMinute
from limits.strategies import MovingWindowRateLimiter

from app.web import windows
from app.web.windows import MonotonicWindows
from tests.profiles import examples
from tests.still_clock import Clock

STEPS = st.lists(st.tuples(st.floats(0, 40), st.integers(1, 4)), max_size=40)


@given(steps=STEPS, most=st.integers(1, 9))
@settings(max_examples=examples(100))
def test_within_any_minute_no_more_is_taken_than_allowed(steps: list[tuple[float, int]], most: int) -> None:
    """Against a list of all that was taken; nothing is refused that would have fitted."""
    with pytest.MonkeyPatch.context() as patch:
        clock = Clock()
        patch.setattr(windows, "time", clock)
        storage = MonotonicWindows()
        limiter, item = MovingWindowRateLimiter(storage), RateLimitItemPerMinute(most)
        taken: list[tuple[float, int]] = []
        for pause, amount in steps:
            clock.now += pause
            used = sum(each for moment, each in taken if moment > clock.now - 60)
            assert limiter.get_window_stats(item, "key").remaining == most - used
            fits = used + amount <= most
            assert limiter.test(item, "key", cost=amount) is fits
            assert limiter.hit(item, "key", cost=amount) is fits
            if fits:
                taken.append((clock.now, amount))


def test_after_the_announced_wait_there_is_room(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(windows, "time", clock)
    limiter, item = MovingWindowRateLimiter(MonotonicWindows()), RateLimitItemPerMinute(2)
    for _ in range(2):
        limiter.hit(item, "key")
        clock.now += 7
    wait = limiter.get_window_stats(item, "key").reset_time - clock.now
    clock.now += wait - 0.01
    assert not limiter.test(item, "key")
    clock.now += 0.02
    assert limiter.hit(item, "key")


def test_keys_that_do_not_come_back_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(windows, "time", clock)
    storage = MonotonicWindows()
    for number in range(1000):
        storage.acquire_entry(f"key {number}", 1, 60)
    clock.now += 61
    storage.acquire_entry("another", 1, 60)
    assert storage.reset() == 1

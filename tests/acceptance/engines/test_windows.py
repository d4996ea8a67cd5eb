"""The drivers of the three engines: they notice what pages log, so that a way without complaint means something."""

from tests.acceptance.engines.window import Window
from tests.acceptance.waiting import until

FAULTS = {
    "thrown": "setTimeout(() => { throw new Error('thrown'); })",
    "rejected": "void Promise.reject(new Error('rejected'))",
    "said": "console.error('said')",
}


def test_what_a_page_logs_is_noticed(window: Window) -> None:
    """An exception, a promise that is rejected, an error of the console; each once, over a change of pages too."""
    for sign, fault in FAULTS.items():
        window.look(f"() => {{ {fault}; }}")
        found: list[str] = []
        until(lambda found=found: found.extend(window.complaints()) or found, f"{sign} to be noticed")
        assert len(found) == 1
        assert sign in found[0]
    window.look("() => console.error('before')")
    window.open("/archive")
    assert any("before" in each for each in window.complaints())
    assert window.complaints() == []

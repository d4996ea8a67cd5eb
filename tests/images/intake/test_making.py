"""Large pictures are converted in a process of their own, a few at a time, with the same bytes as here."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from app.errors import BusyError, InvalidInputError
from app.images.convert import convert, make_link_preview, make_rendition, make_thumbnails
from app.images.intake import client, making
from app.images.png_writer import encode_png


@pytest.fixture
def large(tmp_path, monkeypatch):
    monkeypatch.setattr(making, "LARGE", 0)
    monkeypatch.setattr(making, "perform", None)  # in this process nothing is made
    path = tmp_path / "large.png"
    path.write_bytes(encode_png(np.random.default_rng(1).integers(0, 65536, (300, 400, 3), np.uint16)))
    return path


def test_it_is_made_elsewhere_with_the_same_bytes(large, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    for file_format in ("png", "jpeg", "webp", "tiff"):
        making.make("convert", [large], [first], file_format=file_format, depth=8)
        assert first.read_bytes() == convert(large, file_format, 8)[0]
    making.make("rendition", [large], [first], longest_side=256)
    assert first.read_bytes() == make_rendition(large, 256)[0]
    making.make("preview", [large, large], [first])
    assert first.read_bytes() == make_link_preview(large, large)
    making.make("thumbnails", [large, large], [first, second])
    assert (first.read_bytes(), second.read_bytes()) == make_thumbnails(large, large)


def test_what_a_format_cannot_hold_is_refused_in_its_words(large, tmp_path):
    large.write_bytes(encode_png(np.zeros((2, 20_000, 1), np.uint8)))
    with pytest.raises(InvalidInputError, match="Choose PNG or TIFF") as refused:
        making.make("convert", [large], [tmp_path / "made"], file_format="webp", depth=None)
    assert refused.value.field == "format"


def test_two_at_a_time_and_a_few_wait_and_the_rest_are_told_to_come_back(large, tmp_path, monkeypatch):
    taken, free, running = threading.Barrier(making.AT_ONCE + 1, timeout=20), threading.Event(), []

    def hold(*_):
        running.append(1)
        if len(running) <= making.AT_ONCE:
            taken.wait()
        assert free.wait(20)
        return {"made": True}

    monkeypatch.setattr(client, "collect_answer", hold)

    def ask(_):
        try:
            making.make("preview", [large], [tmp_path / "made"])
        except BusyError:
            return 503
        return 200

    with ThreadPoolExecutor(20) as pool:
        answers = [pool.submit(ask, number) for number in range(20)]
        taken.wait()
        refused = 20 - making.AT_ONCE - making.WAITING
        while sum(answer.done() for answer in answers) < refused:
            pass
        assert len(running) == making.AT_ONCE
        free.set()
    assert sorted(answer.result() for answer in answers) == [200] * (20 - refused) + [503] * refused


@pytest.mark.parametrize("report", [{}, {"ended": "late"}, {"ended": "killed"}])
def test_a_converter_that_was_stopped_says_come_back(large, tmp_path, monkeypatch, report):
    monkeypatch.setattr(client, "collect_answer", lambda *_: report)
    with pytest.raises(BusyError, match="Try again"):
        making.make("preview", [large], [tmp_path / "made"])

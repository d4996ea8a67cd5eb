"""Work that is shared out over threads reports while it runs, and stops when it is told to."""

import threading

import pytest

from app.synthesis.parallel import Team, Work, row_blocks


class StopError(Exception):
    pass


def test_the_progress_is_called_while_a_long_task_runs():
    """The task ends only when it was called once more than at the beginning."""
    again, parts = threading.Event(), []

    def progress(stage, part):
        assert stage == "waiting"
        parts.append(part)
        if len(parts) == 2:
            again.set()

    with Team(1) as team:
        Work(team, progress).run("waiting", lambda item: again.wait(), [1, 2])
    assert parts[:2] == [0, 0]
    assert sorted(parts) == parts
    assert set(parts) == {0, 0.5, 1}


@pytest.mark.parametrize("threads", [1, 2])
def test_tasks_that_never_end_stop_when_the_progress_raises(threads):
    begun = []

    def progress(stage, part):
        if len(begun) == threads:
            raise StopError

    def task(item):
        begun.append(item)
        while True:
            work.checkpoint()

    with Team(threads) as team:
        work = Work(team, progress)
        with pytest.raises(StopError):
            work.run("endless", task, range(10))
    assert len(begun) == threads


def test_what_a_task_raises_comes_out():
    def task(item):
        raise StopError

    with Team(2) as team, pytest.raises(StopError):
        Work(team, lambda stage, part: None).run("failing", task, range(10))


@pytest.mark.parametrize(("height", "rows"), [(1, 64), (64, 64), (65, 64), (150, 64), (7, 3)])
def test_row_blocks_follow_one_another_and_hold_every_row(height, rows):
    blocks = row_blocks(height, rows)
    assert [row for first, last in blocks for row in range(first, last)] == list(range(height))
    assert all(last - first == rows for first, last in blocks[:-1])


@pytest.mark.parametrize("threads", [1, 3])
def test_a_team_computes_every_item_once_and_reports_up_to_one(threads):
    computed, parts = [], []
    with Team(threads) as team:
        team.run(computed.append, range(20), parts.append)
    assert sorted(computed) == list(range(20))
    assert parts == sorted(parts)
    assert parts[-1] == 1


def test_tasks_that_have_not_begun_are_dropped_when_one_fails():
    begun = []

    def task(item):
        begun.append(item)
        raise StopError

    with Team(1) as team, pytest.raises(StopError):
        team.run(task, range(1000), lambda part: None)
    assert len(begun) < 1000


def test_no_threads_are_as_good_as_one():
    computed = []
    with Team(0) as team:
        team.run(computed.append, range(3), lambda part: None)
    assert computed == [0, 1, 2]

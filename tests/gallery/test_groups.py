"""The overview page shows every registered method once, in the groups of its families."""

import pytest

from app.gallery import groups as grouping
from app.gallery.groups import GROUPS, Group, groups
from app.methods.registry import METHODS


def test_every_method_stands_in_one_group() -> None:
    names = [method.name for group in groups() for method in group.methods]
    assert sorted(names) == sorted(METHODS)


def test_every_group_names_methods_that_exist_and_says_what_they_have_in_common() -> None:
    for group in GROUPS:
        assert group.title
        assert group.text.endswith(".")
        assert [method.name for method in group.methods] == list(group.names)


def test_a_method_of_no_group_comes_last_under_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grouping, "GROUPS", (Group("Some", "Text.", ("rpn",)),))
    *_, last = groups()
    assert last.title == "More"
    assert [method.name for method in last.methods] == [name for name in METHODS if name != "rpn"]


def test_a_group_without_methods_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grouping, "GROUPS", (*GROUPS, Group("None", "Text.", ("not-there",))))
    assert [group.title for group in groups()] == [group.title for group in GROUPS]

"""Pages say when an experiment goes by itself, and crawlers what they may read."""

import re
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from urllib.robotparser import RobotFileParser

import pytest


def heading(site: Any, record: dict[str, Any]) -> str:
    page = site.client.get(f"/experiments/{record['id']}").text
    found = re.search(r'<div class="heading">.*?</div>', page, re.DOTALL)
    assert found
    return " ".join(re.sub(r"<[^>]+>", " ", found[0]).split())


def test_an_unlisted_experiment_tells_its_last_day(serve: Any, tmp_path: Path) -> None:
    with serve(tmp_path, keep_unlisted_days=30) as site:
        unlisted, listed = site.finished(listed=False), site.finished()
        ends = datetime.fromisoformat(unlisted["finished_at"]).astimezone(UTC) + timedelta(days=30)
        assert f"unlisted · kept until {ends.day} {ends:%B %Y} , then deleted" in heading(site, unlisted)
        assert "kept until" not in heading(site, listed)


def test_without_the_setting_no_page_says_so(site: Any) -> None:
    assert "kept until" not in heading(site, site.finished(listed=False))


@pytest.mark.parametrize(
    ("path", "may"),
    [
        ("/", True),
        ("/archive", True),
        ("/experiments/x", True),
        ("/methods/rpn", True),
        ("/samples/gravel_gray", True),
        ("/api/v1/experiments/x/outputs/texture?format=tiff", False),
        ("/api/v1/experiments/x/outputs.zip", False),
        ("/api/v1/samples/x/image", False),
        ("/compare/x/y", False),
    ],
)
def test_crawlers_read_pages_and_order_no_work(site: Any, path: str, may: bool) -> None:
    answer = site.client.get("/robots.txt")
    assert answer.headers["Content-Type"].startswith("text/plain")
    rules = RobotFileParser()
    rules.parse(answer.text.splitlines())
    assert rules.can_fetch("AnyCrawler", f"https://texture.example.org{path}") is may

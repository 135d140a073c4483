"""The listings of the page of papers run as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).resolve().parents[1] / "PAPERS.md").read_text(encoding="utf-8")
SECTIONS = dict(zip(re.findall(r"^## (.*)$", PAGE, re.M), PAGE.split("\n## ")[1:], strict=True))


def listings(text: str) -> list[str]:
    return re.findall(r"```python\n(.*?)```", text, re.S)


@pytest.mark.parametrize("title", SECTIONS)
def test_a_listing(title):
    names: dict[str, object] = {}
    (head,), own = listings(PAGE.split("\n## ")[0]), listings(SECTIONS[title])
    assert own and all("assert" in one for one in own), "a listing has a number to be compared with"
    for one in [head, *own]:
        exec(compile(one, title, "exec"), names)  # noqa: S102

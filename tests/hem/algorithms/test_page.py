"""The page on how to write an algorithm: what it shows is run."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parents[3] / "hem" / "algorithms" / "README.md"


def test_the_example_of_the_page_runs() -> None:
    blocks = re.findall(r"(?ms)^```python\n(.*?)^```", PAGE.read_text())
    assert len(blocks) == 1
    for text in blocks:
        exec(compile(text, str(PAGE), "exec"), {"__name__": "page"})

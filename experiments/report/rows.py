"""Rows as a table for a terminal: light to import, so that a command's first words come at once."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text


def show_rows(
    console: Console, rows: Iterable[Sequence[str]], title: str = "", numbers: Sequence[str] = (),
    colors: Mapping[str, str] | None = None,
) -> None:  # fmt: skip
    """Print a table that cuts nothing: a figure that is cut is a wrong one.

    As many columns beside each other as there is room for; the first one is repeated, without the
    rows that have nothing else. rows: the heads first. numbers: the heads that are flush right.
    colors: by regular expressions.
    """
    every = list(rows)
    widths = [max(map(cell_len, column)) + 2 for column in zip(*every, strict=True)]
    start = 1
    while start < len(widths):
        stop = start + 1
        while stop < len(widths) and widths[0] + sum(widths[start : stop + 1]) <= console.width:
            stop += 1
        whole = widths[0] + widths[start] <= console.width  # else lines are broken, and not cut
        table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
        heads, *body = ([row[0], *row[start:stop]] for row in every)
        for head in heads:
            justify: Any = "right" if head in numbers else "left"
            table.add_column(
                head, style="" if head else "bold", no_wrap=whole, overflow="fold", justify=justify
            )
        for row in body:
            if any(row[1:]):
                table.add_row(*(_colored(cell, colors or {}) for cell in row))
        if title:  # as it is, and not broken where a narrow table ends
            console.print(title, style="table.title", markup=False, highlight=False)
        console.print(table)
        start = stop


def _colored(cell: str, colors: Mapping[str, str]) -> Text:
    text = Text(cell)
    for pattern, color in colors.items():
        text.highlight_regex(pattern, color)
    return text


def two_digits(value: float) -> str:
    """A slope: 1.00, never -0.00."""
    return f"{round(value, 2) + 0:.2f}"

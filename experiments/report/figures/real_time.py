"""Single edits as they come: a run in, distributions out."""

from typing import Any

import numpy as np
import pandas as pd

from experiments.bench_real_time import COMPACT, EDITS, GROWING, RESERVED
from experiments.report import style
from experiments.report.pages import Heads, Html, numbers
from experiments.report.session import MissingError
from experiments.report.style import STYLES, Plot
from experiments.report.tables import duration
from experiments.runs import Run
from structures import NAMES, REGISTRY

LABEL = "share of edits that take longer"
PER_VERTEX = 12 + 12 + 8
"""Bytes of a position, a normal and a texture coordinate."""
MOST_OF_16_BITS = 1 << 16
FRAME = 1 / 60
"""Seconds between two frames, which a monitor shows in 16.7 ms."""


def waits(run: Run) -> Plot:
    """The share of edits that take longer, at the largest size: with room, and without."""
    cases = _edits(run)
    titles = {RESERVED: "room was made beforehand", GROWING: "arrays grow when they must"}
    with style.styled():
        figure, every = style.panels(list(titles.values()), (4.6, 3.2), 2, sharex=True, sharey=True)
        for axes, order in zip(every, titles, strict=True):
            axes.axvline(1e6 * FRAME, color=style.GRAY, linewidth=1)
            axes.set(xlabel="time of an edit, µs", ylabel="" if axes is every[1] else LABEL)
            for case in _rows(cases[cases["order"] == order]):
                slower = np.arange(len(case["samples"]), 0, -1) / len(case["samples"])
                look = {**STYLES[case["structure"]], "marker": ""}
                axes.step(1e6 * np.sort(case["samples"]), slower, where="pre", **look)
        every[0].text(1e6 * FRAME, 1, " a frame", color=style.GRAY, va="top", fontsize=7)
        every[0].legend(loc="upper right", bbox_to_anchor=(0.95, 1), fontsize=7)
    return figure


def frames(run: Run) -> Html:
    """What an edit takes, and how many a frame has time for; at the largest size of each."""
    rows = []
    for case in _rows(_edits(run)):
        seconds, uploads = np.array(case["samples"]), case["detail"]["uploads"]
        rows.append((
            REGISTRY[case["structure"]].title, case["vertices"], case["order"] == RESERVED,
            *np.percentile(seconds, [50, 99]), seconds.max(), _in_a_frame(seconds),
            np.median(uploads), max(uploads),
        ))  # fmt: skip
    heads: Heads = {
        "": str, "vertices": _count, "room": lambda there: "made" if there else "grows",
        "median": duration, "99 of 100": duration, "longest": duration,
        "edits in a frame": str, "uploaded, bytes": _count, "at most": _count,
    }  # fmt: skip
    return numbers(rows, heads)


def compactions(run: Run) -> Html:
    """How long it takes to drop what is dead, at every size."""
    cases = _cases(run, COMPACT)
    table = cases.assign(seconds=cases["samples"].map(np.median)).pivot_table(
        index="structure", columns="vertices", values="seconds", sort=False
    )
    rows = [(REGISTRY[str(it)].title, *table.loc[it]) for it in table.index]
    return numbers(rows, {"": str, **{f"{size:,} vertices": duration for size in table.columns}})


def weights(run: Run) -> Html:
    """Megabytes of a mesh that is shown and edited: what a renderer is given, and the structure.

    A renderer is given a position, a normal and a texture coordinate per vertex, and three indices
    per face, of 16 bits where these are enough.
    """
    cases = run.cases[(run.cases["experiment"] == "bench_memory") & (run.cases["skipped"] == "")]
    if cases.empty:
        raise MissingError("This run has not measured bytes.")
    cases = cases[cases["reference_bytes"] == 4].assign(bytes=cases["samples"].map(np.median))
    largest = cases.groupby("family")["vertices"].transform("max")
    meshes = cases[cases["vertices"] == largest].pivot_table(
        index=["family", "vertices", "faces"], columns="structure", values="bytes", sort=False
    )
    held = [name for name in NAMES if name in meshes]
    rows = []
    for (family, vertices, faces), sizes in zip(meshes.index, meshes[held].to_numpy(), strict=True):
        shown = vertices * PER_VERTEX + faces * 3 * (2 if vertices <= MOST_OF_16_BITS else 4)
        rows.append((family, vertices, faces, shown, *(shown + sizes)))
    heads: Heads = {"": str, "vertices": _count, "faces": _count, "renderer": _megabytes}
    return numbers(rows, {**heads, **{f"+ {REGISTRY[it].abbreviation}": _megabytes for it in held}})


def _in_a_frame(seconds: Any) -> str:
    """How many edits in a row fit into a frame, wherever it begins: in the worst one."""
    ends = np.append(0.0, np.cumsum(seconds))
    fits = np.searchsorted(ends, ends + FRAME, side="right") - 1 - np.arange(len(ends))
    whole = fits[ends + FRAME <= ends[-1]]  # frames that end before the edits do
    return _count(whole.min()) if len(whole) else f"all {_count(len(seconds))}"


def _edits(run: Run) -> pd.DataFrame:
    """The cases of each structure at its largest size."""
    cases = _cases(run, EDITS)
    largest = cases.groupby("structure")["vertices"].transform("max")
    return cases[cases["vertices"] == largest]


def _cases(run: Run, subject: str) -> pd.DataFrame:
    cases = run.cases
    mine = cases[(cases["experiment"] == "bench_real_time") & (cases["subject"] == subject)]
    mine = mine[mine["skipped"] == ""]
    if mine.empty:
        raise MissingError("This run has not measured single edits.")
    place = mine["structure"].map(NAMES.index)
    return mine.assign(place=place).sort_values(
        ["place", "vertices", "order"], ascending=[True, True, False]
    )


def _rows(cases: pd.DataFrame) -> list[dict[str, Any]]:
    return [{str(key): it for key, it in row.items()} for row in cases.to_dict("records")]


def _megabytes(value: float) -> str:
    return f"{value / 1e6:.3g} MB" if value == value else "–"


def _count(value: float) -> str:
    return f"{value:,.0f}"

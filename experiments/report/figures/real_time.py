"""What counts in real time: single edits as they come, picking, and what a mesh weighs."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from experiments.bench_picking import FOLLOWING, NEIGHBORS, RAY, REBUILT, REFITTED
from experiments.bench_real_time import COMPACT, EDITS, GROWING, RESERVED
from experiments.bench_workloads import COMPILED, FROM_PYTHON
from experiments.report import style
from experiments.report.comparisons import at_largest, bytes_held, medians
from experiments.report.figures.growth import draw
from experiments.report.pages import Heads, Html, numbers, part
from experiments.report.session import MissingError, require
from experiments.report.style import BLUE, GRAY, RED, STYLES, Plot
from experiments.report.tables import count, digits, duration
from experiments.runs import Run
from structures import NAMES, REGISTRY

PER_VERTEX = 12 + 12 + 8
"""Bytes of a position, a normal and a texture coordinate."""
FRAME = 1 / 60
"""Seconds between two frames, which a monitor shows in 16.7 ms."""
WAYS = {
    f"{RAY}, {REBUILT}": {"label": "a ray, tree rebuilt", "color": GRAY, "linestyle": "-"},
    f"{RAY}, {REFITTED}": {"label": "a ray, tree refitted", "color": GRAY, "linestyle": ":"},
    f"{FOLLOWING}, {REBUILT}": {"label": "rebuilt after an edit", "color": RED},
    f"{FOLLOWING}, {REFITTED}": {"label": "refitted after an edit", "color": BLUE},
}
"""What of a pick does not depend on the structure, and its lines."""


def waits(run: Run) -> Plot:
    """The share of edits that take longer, at the largest size: with room, and without."""
    cases = at_largest(_cases(run, EDITS), "structure")
    titles = {RESERVED: "room was made beforehand", GROWING: "arrays grow when they must"}
    with style.styled():
        figure, every = style.panels(list(titles.values()), (4.6, 3.2), 2, sharex=True, sharey=True)
        for axes, order in zip(every, titles, strict=True):
            axes.axvline(1e6 * FRAME, color=GRAY, linewidth=1)
            axes.set_xlabel("time of an edit, µs")
            for case in cases[cases["order"] == order].to_dict("records"):
                slower = np.arange(len(case["samples"]), 0, -1) / len(case["samples"])
                look = {**STYLES[case["structure"]], "marker": ""}
                axes.step(1e6 * np.sort(case["samples"]), slower, where="pre", **look)
        every[0].set_ylabel("share of edits that take longer")
        every[0].text(1e6 * FRAME, 1, " a frame", color=GRAY, va="top", fontsize=7)
        figure.legend(*every[0].get_legend_handles_labels(), loc="outside right upper", fontsize=7)
    return figure


def frames(run: Run, order: str = GROWING) -> Html:
    """At every size the median, 99 of 100 and the longest of the edits, and how many fit a frame.

    And the bytes that an edit uploads. ``order``: where arrays grow, or where room was made.
    """
    cases = _cases(run, EDITS).query("order == @order")
    table = _by_size(cases.assign(told=cases["samples"].map(_told)), "told")
    rows = []
    for name, sizes in table.iterrows():
        details = cases.loc[cases["structure"] == name, "detail"]
        uploads = np.concatenate([it["uploads"] for it in details])
        rows.append((REGISTRY[str(name)].title, *sizes, np.median(uploads), uploads.max()))
    heads: Heads = {"": str, **{f"{size:,} vertices": str for size in table}}
    return numbers(rows, {**heads, "uploaded, bytes": count, "at most": count})


def compactions(run: Run) -> Html:
    """How long it takes to drop what is dead, at every size."""
    table = _by_size(_cases(run, COMPACT, "how what is dead is dropped"), "cost")
    rows = [(REGISTRY[str(name)].title, *sizes) for name, sizes in table.iterrows()]
    return numbers(rows, {"": str, **{f"{size:,} vertices": duration for size in table}})


def keeping_up(run: Run) -> Html:
    """Up to how many vertices every edit fits into a frame, whatever the room.

    And the longest edit at the next size, or at that one where it is the last.
    """
    cases = _cases(run, EDITS)
    cases = cases.assign(longest=cases["samples"].map(max))
    cases = cases.groupby(["structure", "vertices"], sort=False)["longest"].max().reset_index()
    found: dict[tuple[int, int], dict[str, float]] = {}
    for name, mine in cases.groupby("structure", sort=False):
        kept = mine[~(mine["longest"] > FRAME).cummax()]
        size = 0 if kept.empty else int(kept["vertices"].max())
        told = mine.iloc[min(len(kept), len(mine) - 1)]
        of_size = found.setdefault((size, int(told["vertices"])), {})
        of_size[str(name)] = float(told["longest"])
    return part("keeping_up", sorted(found.items(), reverse=True))


def _by_size(cases: pd.DataFrame, column: str) -> pd.DataFrame:
    """One column of the cases: a row per structure, by size."""
    return cases.pivot_table(column, "structure", "vertices", aggfunc="first", sort=False)


def picks(run: Run) -> Plot:
    """The time of each part of a pick by size: what rays take, and the neighbors by structure."""
    cases = medians(run, "bench_picking", 1e6)
    asked, ways = cases["subject"] == NEIGHBORS, (COMPILED, FROM_PYTHON)
    lines = cases["structure"].where(asked, cases["subject"] + ", " + cases["order"])
    cases = cases.assign(panel=cases["order"].where(asked, RAY), line=lines)
    titles = {RAY: "the ray, and following an edit", **{it: f"the neighbors, {it}" for it in ways}}
    shape: dict[str, Any] = {"size": (4.6, 3.2), "sharex": True, "sharey": True, "room": 0.6}
    styles = STYLES | {line: {**look, "marker": "."} for line, look in WAYS.items()}
    shape |= {"panel": "panel", "by": "line", "styles": styles}
    return draw(cases, titles, "vertices", "picking", "time, µs", **shape)


def picks_in_words(run: Run) -> Html:
    """What a pick and what follows an edit take, at the largest size at which all is known."""
    cases = medians(run, "bench_picking", 1e6)
    require(len(cases), "measured picking")
    table = cases.pivot_table(index="vertices", columns=["subject", "order"], values="cost")
    rays = [(what, how) for what in (RAY, FOLLOWING) for how in (REBUILT, REFITTED)]
    known = table.reindex(columns=rays).dropna()
    if known.empty:
        left_out = run.skipped.query("experiment == 'bench_picking' and subject == @RAY")["skipped"]
        raise MissingError(" ".join(["This run has cast no rays.", *left_out.unique()]))
    size = known.index.max()
    asked = cases.query("subject == @NEIGHBORS and order == @COMPILED and vertices == @size")
    require(len(asked), "asked in compiled code what is around a face")
    neighbors = asked.set_index("structure")["cost"].sort_values()
    return part("picks", size, *(1e-6 * known.loc[size]), 1e-6 * neighbors)


def weights(run: Run) -> Html:
    """Megabytes of a mesh that is shown and edited: as drawn, as a render mesh, and in all.

    A renderer is given ``PER_VERTEX``, and three indices per face, of 16 bits where these are
    enough; a ``RenderMesh`` has three float32 per vertex and three int32 per face.
    """
    table = bytes_held(run, 4)
    require(len(table), "measured bytes")
    rows: list[Any] = []
    every: Any = table.T.items()
    for (family, vertices, faces), sizes in every:
        drawn = vertices * PER_VERTEX + faces * 3 * (2 if vertices <= 1 << 16 else 4)
        beside = 12 * (vertices + faces)
        megabytes = np.array([drawn, beside, *(drawn + beside + sizes)]) / 1e6
        rows.append((family, vertices, faces, *megabytes))
    titles = ["renderer", "render mesh", *(REGISTRY[str(it)].title for it in table)]
    heads: Heads = {"": str, "vertices": count, "faces": count}
    return numbers(rows, {**heads, **dict.fromkeys(titles, partial(digits, count=3))})


def _told(seconds: Any) -> str:
    """What single edits took, and how many a frame has time for."""
    times = [duration(it) for it in np.percentile(seconds, [50, 99, 100])]
    told = [it.replace(" ", "\N{NO-BREAK SPACE}") for it in times]
    return " · ".join([*told, _in_a_frame(np.array(seconds))])


def _in_a_frame(seconds: Any) -> str:
    """How many edits in a row fit into a frame, wherever it begins: in the worst one."""
    ends = np.append(0.0, np.cumsum(seconds))
    fits = np.searchsorted(ends, ends + FRAME, side="right") - 1 - np.arange(len(ends))
    whole = fits[ends + FRAME <= ends[-1]]  # frames that end before the edits do
    return count(whole.min()) if len(whole) else f"all\N{NO-BREAK SPACE}{count(len(seconds))}"


def _cases(run: Run, subject: str, what: str = "single edits") -> pd.DataFrame:
    mine = medians(run, "bench_real_time").query("subject == @subject")
    require(len(mine), f"measured {what}")
    place = mine["structure"].map(NAMES.index)
    by = ["place", "vertices", "order"]
    return mine.assign(place=place).sort_values(by, ascending=[True, True, False])

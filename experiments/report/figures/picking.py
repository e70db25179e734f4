"""Picking: a run in; what a ray, an edit and the question after a hit take."""

import pandas as pd

from experiments.bench_picking import FOLLOWING, NEIGHBORS, RAY, REBUILT, REFITTED
from experiments.report import style
from experiments.report.figures.growth import draw_lines, timed
from experiments.report.pages import Html
from experiments.report.session import MissingError
from experiments.report.style import BLUE, GRAY, RED, STYLES, Plot
from experiments.report.tables import duration
from experiments.runs import Run
from structures import REGISTRY

WAYS = {
    f"{RAY}, {REBUILT}": {"label": "a ray, tree rebuilt", "color": GRAY, "linestyle": "-"},
    f"{RAY}, {REFITTED}": {"label": "a ray, tree refitted", "color": GRAY, "linestyle": ":"},
    f"{FOLLOWING}, {REBUILT}": {"label": "rebuilt after an edit", "color": RED},
    f"{FOLLOWING}, {REFITTED}": {"label": "refitted after an edit", "color": BLUE},
}
"""What does not depend on the structure, and its lines."""


def picks(run: Run) -> Plot:
    """The time of each part of a pick by size: what rays take, and the neighbors by structure."""
    cases = _cases(run)
    asked = cases["subject"] == NEIGHBORS
    cases["part"] = cases["subject"] + ", " + cases["order"].fillna("")
    titles = ["the ray, and following an edit", "the neighbors of what was hit"]
    with style.styled():
        figure, every = style.panels(titles, (4.6, 3.2), 2, sharex=True, sharey=True)
        draw_lines(every[0], cases[~asked], "vertices", "part", WAYS, marker=".")
        draw_lines(every[1], cases[asked], "vertices", "structure", STYLES)
        for axes, label in zip(every, ("time, µs", ""), strict=True):
            axes.set(xlabel=style.VARIABLES["vertices"], ylabel=label)
        style.finish_panels(figure, every, 0.6)
    return figure


def in_words(run: Run) -> Html:
    """What a pick and what follows an edit take, at the largest size at which all is known."""
    cases = _cases(run)
    table = cases.pivot_table(index="vertices", columns=["subject", "order"], values="cost")
    rays = [(what, how) for what in (RAY, FOLLOWING) for how in (REBUILT, REFITTED)]
    known = table[[it for it in rays if it in table]].dropna()
    if len(known.columns) < len(rays) or known.empty:
        left_out = run.skipped[run.skipped["experiment"] == "bench_picking"]
        reasons = dict.fromkeys(left_out.loc[left_out["subject"] == RAY, "skipped"])
        raise MissingError(" ".join(["This run has cast no rays.", *reasons]))
    size = known.index.max()
    ray, again, rebuilt, refitted = (duration(1e-6 * it) for it in known.loc[size])
    asked = cases[(cases["subject"] == NEIGHBORS) & (cases["vertices"] == size)]
    asked = asked.set_index("structure")["cost"].sort_values()
    ends = [f"{duration(1e-6 * asked[it])} ({REGISTRY[it].title})" for it in asked.index[[0, -1]]]
    return Html(
        f"<p>At {size:,} vertices a ray takes {ray}, and {again} after refits; to follow an edit "
        f"takes {refitted} by refitting and {rebuilt} by rebuilding; and the neighbors of what was "
        f"hit take {ends[0]} to {ends[1]}.</p>"
    )


def _cases(run: Run) -> pd.DataFrame:
    cases = timed(run, "bench_picking", 1e6)
    if cases.empty:
        raise MissingError("This run has not measured picking.")
    return cases

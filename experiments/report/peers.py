"""Other libraries beside our half-edge mesh: tables for a terminal, for a page and for programs."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from rich.console import Console

from experiments import peers as libraries
from experiments.claims import CASE_ERROR, Curve, Outcome, curves, load_claims
from experiments.harness import OPERATIONS, QUERIES_TABLE
from experiments.peers import BAD_INPUT, BUILD, BULK, BYTES, LOOPED, OURS, PEERS, SINGLE
from experiments.report.pages import Html, text_table
from experiments.report.session import MissingError, project_file
from experiments.report.tables import digits, duration, show_rows
from experiments.runs import PEER_RUNS, ResultsError, Run, in_words, latest, load
from hem.complexity import MIN_SIZES, Verdict, judge
from hem.contract import QUERIES
from structures import REGISTRY

EXPERIMENT = "bench_peers"
KEPT = "results/reference/peers"
"""A run of them that is part of the project, for who has none of these libraries."""
LIKE = "half_edge"
"""The structure of ours that stands beside the libraries, and whose claims theirs are held to."""
CLAIMED = {it.subject: it.classes for it in load_claims() if it.structure == LIKE}
"""By query what it is claimed to cost, by variable."""
MISSING = "Other libraries were not measured here: hem study --peers does that."
NONE = "N/A"
NUMBERS = "bytes per vertex", "build a vertex", "times ours"
PER_ELEMENT = {"faces": "O(1)"}
"""What is claimed of a call that asks all elements, for each of them."""


@dataclass(frozen=True)
class Cell:
    """What became of one subject on one library.

    ``seconds`` and the ``ratio`` to ours, at the largest ``size`` of both. ``verdicts``: by the
    thesis' sign of what varies; ``claimed``: whether it claims anything.
    """

    seconds: float
    ratio: float
    size: int
    verdicts: Mapping[str, Verdict]
    claimed: bool

    @property
    def found(self) -> str:
        """The class found, such as ``O(n_ev)``; empty where several fit, or none."""
        answers = {sign: it.answer for sign, it in self.verdicts.items()}
        if any(not it or " or " in it for it in answers.values()):
            return ""
        grown = [it[2:-1].replace("n", sign) for sign, it in answers.items()]
        factors = [it for it in grown if it != "1"]
        return f"O({' · '.join(factors) or 1})" if grown else ""

    @property
    def text(self) -> str:
        """Such as ``O(n_ev) ✓✓ 3.1 ×``: marks by faces and valence; the time if ours has none."""
        marks = (Outcome(it.outcome).mark for it in self.verdicts.values() if self.claimed)
        taken = f"{digits(self.ratio)} ×" if self.ratio == self.ratio else duration(self.seconds)
        return " ".join(filter(None, (self.found, "".join(marks), taken)))

    def in_seconds(self, many: int = 1) -> str:
        """Such as ``30 ns O(1)``: the time of one of so ``many``, and the class."""
        return f"{duration(self.seconds / many)} {self.found}".strip()


class Peers:
    """A run as far as it is about other libraries: what was measured, and what is ``absent``."""

    def __init__(self, run: Run) -> None:
        self.run = run
        here = run.cases[run.cases["experiment"] == EXPERIMENT]
        self.cases = {str(name): cases for name, cases in here.groupby("structure")}
        self.names = [it for it in PEERS if it in self.cases]
        self.absent = [it.title for name, it in PEERS.items() if name not in self.cases]
        weighed = here[here["kind"] == BYTES].set_index("structure")
        each = weighed["samples"].str[0].astype(float) / weighed["vertices"]
        self.bytes_per_vertex = each.groupby(level=0).max().reindex(self.names)
        self.weighed_at = weighed["vertices"].groupby(level=0).max().reindex(self.names)

    def cell(self, name: str, subject: str, order: str = "") -> Cell | None:
        """One subject on a library, judged if it is a query or has sizes enough; None: no call."""
        of_run = curves(self.run)
        curve, ours = (of_run.named(EXPERIMENT, it, subject, order) for it in (name, OURS))
        if not len(curve):
            return None
        ratios = (curve.by_size / ours.by_size).dropna()
        size = int(max(ratios.index if len(ratios) else curve.by_size.index))
        claimed = PER_ELEMENT if order == BULK else CLAIMED.get(subject, {})
        verdicts = {}
        if subject in QUERIES or len(curve.by_size) >= MIN_SIZES:
            asked = self.cases[name].query("subject == @subject and order == @order")
            by_valence = Curve("valence", asked.dropna(subset="valence").sort_values("valence"))
            for sign, it in (("n_t", curve), ("n_ev", by_valence)):
                if len(it):
                    expected, latencies = claimed.get(it.variable, "O(1)"), of_run.latencies(it)
                    verdicts[sign] = judge(
                        it.sizes, it.samples, expected, latencies, latency_error=CASE_ERROR
                    )
        seconds, ratio = curve.by_size[size], ratios.get(size, np.nan)
        return Cell(float(seconds), float(ratio), size, verdicts, bool(claimed))

    def weighed_smaller(self) -> str:
        """Whose bytes are of a smaller mesh than those of the others, in a sentence, if any are."""
        most = self.weighed_at.max()
        less = self.weighed_at[self.weighed_at < most]
        few = [f"of {PEERS[str(name)].title} at {size:,.0f}" for name, size in less.items()]
        return f"Bytes are weighed at {most:,.0f} vertices, {', '.join(few)}." if few else ""

    def version(self, name: str) -> str:
        """The version that was measured."""
        return str(self.cases[name]["detail"].iloc[0]["version"])

    def trial(self, name: str, bad: str) -> tuple[str, str]:
        """What became of bad input, in a word and in more."""
        found = self.cases[name].query("subject == @bad")["detail"]
        return tuple(found.iloc[0]["found"]) if len(found) else ("", "")

    def overview(self) -> list[list[str]]:
        """Version, bytes and building, a row for each; the heads first."""
        rows = [["", "version", *NUMBERS]]
        for name in self.names:
            cell, size = self.cell(name, BUILD), self.bytes_per_vertex[name]
            built = cell.in_seconds(cell.size) if cell else "?"
            ratio = f"{digits(cell.ratio)} ×" if cell and cell.ratio == cell.ratio else "?"
            weighed = f"{size:,.0f}" if size == size else "?"
            rows.append([PEERS[name].title, self.version(name), weighed, built, ratio])
        return rows

    def compared(self, title: str) -> list[list[str]]:
        """A group of ``GROUPS``: a column per library that has any of it, at last the vertices."""
        subjects, order = GROUPS[title]
        columns = {"": [*subjects.values(), "vertices"]}
        for name in self.names:
            cells = [self.cell(name, it, order) for it in subjects]
            if any(cells):
                sizes = sorted({it.size for it in cells if it})
                told = (it and (it.in_seconds() if name == OURS else it.text) for it in cells)
                texts = [it or NONE for it in told]
                columns[PEERS[name].title] = [*texts, " … ".join(f"{it:,}" for it in sizes)]
        rows = map(list, zip(*columns.values(), strict=True))
        return [list(columns), *(row for row in rows if {*row[1:]} - {NONE})]

    def trials(self, in_full: bool = False) -> list[list[str]]:
        """What each library makes of bad input, in a word or with its own; the heads first."""
        rows = [["", *(it.title for it in BAD_INPUT.values())]]
        for name in self.names:
            told = [self.trial(name, bad)[: 2 if in_full else 1] for bad in BAD_INPUT]
            words = (": ".join(filter(None, it)).partition(";")[0] for it in told)  # no advice
            rows.append([PEERS[name].title, *words])
        return rows


QUESTIONS = QUERIES_TABLE.subjects
GROUPS: dict[str, tuple[Mapping[str, str], str]] = {
    "Queries, one after the other": (QUESTIONS, SINGLE),
    "Queries, all at once": (QUESTIONS, BULK),
    "Queries, in a compiled loop": (QUESTIONS, LOOPED),
    "Operations, one after the other": (OPERATIONS, SINGLE),
    "Operations, all at once": (OPERATIONS, BULK),
    "Operations, in a compiled loop": ({it: OPERATIONS[it] for it in libraries.BATCHED}, LOOPED),
    "Algorithms": (libraries.ALGORITHMS, ""),
    "Algorithms of Sieger & Botsch, compiled": (libraries.SIX, LOOPED),
}
"""By title what is compared: by subject the head of its row, and the order of its cases."""
READING = (
    "The growth by faces, and of queries by valence, where there were sizes enough and one class "
    "fits, and whether it is what the thesis claims of a half-edge mesh (?: cannot be told); then "
    "how many times as long as ours it takes, on the largest mesh of both. "
    "But for compiled loops all are called from Python. N/A: the library has no call for it."
)


def measured_peers(run: Run) -> Peers:
    """What a run measured of other libraries; where it did not, the newest run of them did."""
    here = Peers(run)
    return here if here.names else _newest() or here


def _newest() -> Peers | None:
    """Of the newest run of other libraries; where there is none, of that which is kept."""
    with suppress(ResultsError):
        return Peers(load(latest(PEER_RUNS)))
    with suppress(ResultsError, MissingError):
        return Peers(load(project_file(KEPT)))
    return None


def _of_folder(folder: Path | None) -> Peers:
    """Those of a run, or of the newest there is of them. Raises MissingError where it has none."""
    peers = Peers(load(folder)) if folder else _newest()
    if not peers or not peers.names:
        raise MissingError(MISSING)
    return peers


def show_peers(folder: Path | None, console: Console) -> None:
    """Print all that was measured of other libraries."""
    peers = _of_folder(folder)
    meta = peers.run.meta
    of = f"{peers.run.folder.name}, preset {meta.get('preset')}"
    console.print(f"{of}, measured on {meta['started'][:10]}", markup=False)
    shown = {"Other libraries": peers.overview(), **{it: peers.compared(it) for it in GROUPS}}
    for title, rows in {**shown, "Bad input": peers.trials()}.items():
        if len(rows) > 1:
            show_rows(console, rows, title, NUMBERS)
    console.print(" ".join([READING, peers.weighed_smaller()]), style="dim")
    if peers.absent:
        console.print(f"Not measured: {', '.join(peers.absent)}.", style="dim")


def peers_as_json(folder: Path | None) -> dict[str, Any]:
    """The same as records; NaN where there is no number."""
    peers = _of_folder(folder)
    return {
        "run": peers.run.folder.name,
        "preset": peers.run.meta.get("preset"),
        "absent": peers.absent,
        "libraries": [
            {
                "name": name,
                "title": PEERS[name].title,
                "manual": PEERS[name].site,
                "version": peers.version(name),
                "bytes_per_vertex": float(peers.bytes_per_vertex[name]),
                "bytes_at_vertices": int(peers.weighed_at.fillna(0)[name]),
                "bad_input": {bad: list(peers.trial(name, bad)) for bad in BAD_INPUT},
                "subjects": list(_records(peers, name)),
            }
            for name in peers.names
        ],
    }


def _records(peers: Peers, name: str) -> Iterator[dict[str, Any]]:
    for subjects, order in (({BUILD: ""}, ""), *GROUPS.values()):
        for subject in subjects:
            if cell := peers.cell(name, subject, order):
                outcomes = {sign: it.outcome for sign, it in cell.verdicts.items() if cell.claimed}
                yield {"subject": subject, "way": order, "seconds": cell.seconds,
                       "found": cell.found, "vertices": cell.size, "of_ours": cell.ratio,
                       "outcomes": outcomes}  # fmt: skip


def beside_ours(
    measured: pd.DataFrame, works: Mapping[str, str], shares: Collection[str]
) -> list[list[str]]:
    """Half-edges as measured, and how many times that all others take; the heads first.

    ``measured``: a row per work, size and cores, a column per program. ``shares``: the works whose
    measure is a part of the whole, not seconds.
    """
    here = measured[measured.index.isin([*works], level=0)].dropna(subset=[LIKE])
    here = here.dropna(axis=1, how="all")
    names = sorted(here.columns, key=lambda it: (it != LIKE, it not in REGISTRY, it))
    known: Mapping[str, Any] = {**PEERS, **REGISTRY}
    rows = [["", "vertices", *(known[it].title if it in known else it for it in names)]]
    every: list[Any] = sorted(here.iterrows(), key=lambda it: ([*works].index(it[0][0]), it[0][1]))
    for (work, size, cores), values in every:
        first = f"{digits(100 * values[LIKE])} %" if work in shares else duration(values[LIKE])
        ratios = values[names[1:]] / values[LIKE]
        told = [f"{digits(it)} ×" if it == it else NONE for it in ratios]
        head = works[work] + (", all cores" if cores == "all" else "")
        rows.append([head, f"{size:,}", first, *told])
    return rows


def page_table(rows: Sequence[Sequence[Any]], title: str = "") -> Html:
    """Rows on a page, their heads first, with a ``title`` in the corner. Raises MissingError."""
    heads, *body = [title or rows[0][0], *rows[0][1:]], *rows[1:]
    if not body:
        raise MissingError("This was not measured of any library.")
    return text_table(heads, [[it.replace(" ×", "\u00a0×") for it in row] for row in body])


def about(peers: Peers) -> Html:
    """Where they were measured, and what was not installed there. Raises MissingError."""
    if not peers.names:
        raise MissingError(MISSING)
    lost = f" Not measured there: {', '.join(peers.absent)}." if peers.absent else ""
    return Html("<p>{}</p>").format(f"{in_words(peers.run)}{lost} {peers.weighed_smaller()}")


def portraits(peers: Peers) -> Html:
    """How each library's manual has it used, and what it does that ours does not."""
    heads = "Library", "As its manual has it used", "Its manual", "What it does beyond ours"
    others = [PEERS[name] for name in peers.names if name != OURS]
    rows = ((it.title, _coded(it.manual), _address(it.site), _coded(it.more)) for it in others)
    return page_table([heads, *rows])


def _coded(text: str) -> Html:
    """Words for a page, with what stands between backticks as code."""
    return Html(re.sub("`(.+?)`", r"<code>\1</code>", escape(text, quote=False)))


def _address(site: str) -> Html:
    """A link in short, which may go on in the next line after every slash."""
    return Html("<wbr>").join(it for it in re.split("(?<=/)", site.removeprefix("https://")) if it)

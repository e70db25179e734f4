"""What an experiment declares of itself: everything about it stands in its one file.

Every ``bench_*.py`` has an ``EXPERIMENT``. The study, the tables, the judge, the baseline and the
report read it; nothing else needs to know of the experiment.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from experiments.harness.axes import Axis
from experiments.harness.cases import Case
from experiments.harness.measurement import Measurement
from experiments.harness.presets import Preset
from experiments.harness.timer import Timer
from hem.contract import QUERIES

KINDS = ("time", "work", "bytes")
ANYONE = "*"
"""In an experiment's claims: every structure that is not named."""


@dataclass(frozen=True)
class Table:
    """A table of the report: its name, its title, and a row per subject with the row's title.

    ``chapter``: the notebook that is about it.
    """

    name: str
    title: str
    subjects: Mapping[str, str]
    chapter: str = ""


OPERATIONS = {
    "split_edge": "Split edge",
    "split_face": "Split face",
    "collapse_edge": "Collapse edge",
    "flip_edge": "Flip edge",
    "add_face": "Add face",
    "remove_face": "Remove face",
}
"""The operations that are measured, and how a table calls them."""

RENDERED = ("rendered", "in a transaction", "render mesh built anew")
"""The orders in which operations are followed by a render mesh."""

QUERIES_TABLE = Table(
    "queries", "Table 1", {name: query.title for name, query in QUERIES.items()}, "query_scaling"
)
OPERATIONS_TABLE = Table("operations", "Operations", OPERATIONS, "operations")


@dataclass(frozen=True)
class Experiment:
    """One experiment.

    ``cases``: what there is to measure on one structure; ``measure``: checks and measures one.
    ``kind``: what they measure, but for those in the orders ``counted``, which are work.
    ``structures``: the names it runs on. ``copies``: how many structures' bytes a case takes at its
    peak. ``turn``: its place in a study, early ones first. ``table`` and ``axes``: the table whose
    claims it decides, and the order of handles that holds the measurements along each axis.
    ``just_written``: the axes whose cases run on a mesh that was copied just before, so that the
    latency measured beside them may miss what they waited for. ``baseline_orders``: the orders
    whose times enter the baseline. ``claims``: for subjects of its own, the growth class that is
    expected of each structure (or of ``ANYONE``), with ``source``: who expects it.
    """

    title: str
    kind: str
    cases: Callable[[Preset, str], Sequence[Case]]
    measure: Callable[[Case, Preset, Timer], Measurement]
    structures: tuple[str, ...]
    copies: int
    turn: int
    counted: tuple[str, ...] = ()
    table: Table | None = None
    axes: Mapping[Axis, str] = field(default_factory=dict)
    just_written: frozenset[Axis] = frozenset()
    baseline_orders: tuple[str, ...] = ()
    claims: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        """Raises ValueError for what does not fit together."""
        if self.kind not in KINDS:
            raise ValueError(f"{self.title}: kind must be one of {KINDS}, not {self.kind!r}")
        if self.axes and self.table is None:
            raise ValueError(f"{self.title}: axes need the table whose claims they decide")
        subjects = self.table.subjects if self.table else {}
        strange = set(self.claims) - set(subjects)
        if strange:
            raise ValueError(
                f"{self.title}: claims name {min(strange)!r}, which is no subject of its table"
            )
        if self.claims and not self.source:
            raise ValueError(f"{self.title}: claims need a source: who expects them")

    @property
    def name(self) -> str:
        """The name of its file, such as ``bench_queries``."""
        return self.cases.__module__.rpartition(".")[2]

    @property
    def module(self) -> str:
        """The module that measures it."""
        return self.cases.__module__

    def kind_of(self, case: Case) -> str:
        """What a case measures."""
        return "work" if case.order in self.counted else self.kind

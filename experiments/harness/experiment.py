"""What an experiment declares of itself: everything about it stands in its one file.

Every ``bench_*.py`` has an ``EXPERIMENT``, which study, tables, judge, baseline and report read.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

from experiments import require_known
from experiments.harness.cases import Case, Measurement, NothingToMeasureError
from experiments.harness.own_mesh import is_own
from experiments.harness.timer import Timer, time_rounds
from experiments.presets import Preset
from hem.contract import OPERATIONS as KNOWN
from hem.contract import QUERIES
from structures import NAMED, NAMES, REGISTRY

Keep = Callable[[Measurement], None]  # what a measurement is handed to
KINDS = ("time", "work", "bytes")
ANYONE = "*"  # in an experiment's claims: every structure that is not named

MEASURED = "split_edge", "split_face", "collapse_edge", "flip_edge", "add_face", "remove_face"
require_known("operation of hem.authoring", MEASURED, KNOWN)
OPERATIONS = {name: name.replace("_", " ").capitalize() for name in MEASURED}
"""The operations that are measured, and how a table calls them."""
SYMBOLS = {"faces": "n_t", "valence": "n_ev"}


class Axis(Enum):
    """What a claim is judged along: one measure by one variable, the other variable held.

    ``WORK_…`` counts memory accesses, ``TIME_…`` is time where most is found in the caches: by
    faces in consecutive order, by valence on a mesh that is no larger; ``RANDOM_…`` is time in
    random order. ``key``: the name in files, ``work_faces``.
    ``symbol``: the variable's in the thesis. ``exact``: whether values are counted, and so the same
    on every machine. ``label`` and ``unit``: how a plot names the measure, and the unit that values
    are shown in, multiplied by ``scale``.
    """

    WORK_FACES = "work", "faces", "memory accesses"
    WORK_VALENCE = "work", "valence", "memory accesses"
    TIME_FACES = "time", "faces", "time in order"
    TIME_VALENCE = "time", "valence", "time"
    RANDOM_FACES = "random", "faces", "time in random order"

    def __init__(self, measure: str, variable: str, label: str) -> None:
        self.measure, self.variable, self.label = measure, variable, label
        self.key = f"{measure}_{variable}"
        self.symbol = SYMBOLS[variable]
        self.exact = measure == "work"
        self.unit, self.scale = ("", 1.0) if self.exact else ("ns", 1e9)

    def label_in(self, table: str) -> str:
        """The label in a table: nothing but queries is asked in an order."""
        return self.label if self.exact or table == QUERIES_TABLE.name else self.measure


def measured_operations(preset: Preset) -> tuple[str, ...]:
    """The operations that a preset has measured."""
    return preset.operations or tuple(OPERATIONS)


@dataclass(frozen=True)
class Table:
    """A table of the report, a row per subject with its title; ``chapter``: its notebook."""

    name: str
    title: str
    subjects: Mapping[str, str]
    chapter: str = ""


QUERIES_TABLE = Table(
    "queries", "Table 1", {name: query.title for name, query in QUERIES.items()}, "query_scaling"
)
OPERATIONS_TABLE = Table("operations", "Operations", OPERATIONS, "operations")

NO_STRUCTURE = "machine"
"""Stands for a structure where none is measured."""


@dataclass(frozen=True)
class Experiment:
    """One experiment.

    ``cases``: what there is to measure on one structure; ``measure``: checks and measures one.
    ``copies``: how many structures' bytes a case takes at its peak. ``turn``: its place in a study,
    early ones first. ``kind``: what is measured, but for cases in the orders ``counted``, which are
    work. ``structures``: the names it runs on. ``table`` and ``axes``: the table whose claims it
    decides, and the order of handles that holds the measurements along each axis.
    ``just_written``: the axes whose cases run on a mesh that was copied just before, so that the
    latency measured beside them may miss what they waited for. ``baseline_orders``: the orders
    whose times enter the baseline. ``by_name``: it is measured only where it is named.
    ``compiled``: the names whose kernels have to be compiled before anything is timed. ``claims``:
    for subjects of its own, the growth class that is expected of each structure (or of ``ANYONE``),
    with ``source``: who expects it.
    """

    title: str
    cases: Callable[[Preset, str], Sequence[Case]]
    measure: Callable[[Case, Preset, Timer], Measurement]
    copies: int
    turn: int
    kind: str = "time"
    structures: tuple[str, ...] = NAMES
    counted: tuple[str, ...] = ()
    table: Table | None = None
    axes: Mapping[Axis, str] = field(default_factory=dict)
    just_written: frozenset[Axis] = frozenset()
    baseline_orders: tuple[str, ...] = ()
    by_name: bool = False
    compiled: frozenset[str] = frozenset(name for name in NAMES if REGISTRY[name].compiled)
    claims: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        """Raises ValueError for what does not fit together."""
        strange = set(self.claims) - set(self.table.subjects if self.table else ())
        claimed = {name for it in self.claims.values() for name in (*it, *self.structures)}
        unknown = claimed - {ANYONE, *NAMED}
        kinds = {axis: self.kind_of(order) for axis, order in self.axes.items()}
        amiss = [axis.key for axis, kind in kinds.items() if axis.exact != (kind == "work")]
        for wrong, why in (
            (self.kind not in KINDS, f"kind must be one of {KINDS}, not {self.kind!r}"),
            (bool(self.axes) != bool(self.table), "axes and the table they decide need each other"),
            (amiss, f"axes {amiss}: an order has to be counted for work, and timed for time"),
            (strange, f"claims name {sorted(strange)}, which are no subjects of its table"),
            (unknown, f"claims of {sorted(unknown)}, which are no structures"),
            (self.claims and not self.source, "claims need a source: who expects them"),
        ):
            if wrong:
                raise ValueError(f"{self.name}: {why}")

    @property
    def name(self) -> str:
        """The name of its file, such as ``bench_queries``."""
        return self.cases.__module__.rpartition(".")[2]

    @cached_property
    def test(self) -> Callable[..., None]:
        """The test that measures a case: what pytest finds in its file, see ``conftest``."""

        def time(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
            keep(self.measured(case, preset, timer))

        def count(case: Case, preset: Preset, keep: Keep) -> None:
            keep(self.measured(case, preset, time_rounds))

        return time if self.kind == "time" else count

    def measured(self, case: Case, preset: Preset, timer: Timer) -> Measurement:
        """A case as measured; skipped where a mesh of one's own has nothing to measure."""
        try:
            return self.measure(case, preset, timer)
        except NothingToMeasureError as error:
            if not is_own(case.family, case.size):
                raise
            return case.result(self.kind_of(case.order), None, skipped=str(error))

    def expected(self, subject: str, structure: str) -> str | None:
        """The growth class that it expects of a subject on a structure; None for nothing."""
        return self.claims[subject].get(structure, self.claims[subject].get(ANYONE))

    def kind_of(self, order: str | None) -> str:
        """What a case in such an order measures."""
        return "work" if order in self.counted else self.kind

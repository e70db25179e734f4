"""A workload: a table of how often what is asked and done, per build or per frame."""

import csv
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import MISSING, dataclass, fields, replace
from math import inf
from pathlib import Path
from typing import Any, Self

from experiments import require_known
from hem import Recording
from hem.contract import ANEW, BESIDE, CHECKED, COMPILED, OPERATIONS, PYTHON, QUERIES, is_edit
from structures import REGISTRY

KNOWN = (*QUERIES, *OPERATIONS, *(f"{CHECKED}{it}" for it in OPERATIONS), *BESIDE, ANEW)
"""What a row may count."""

PER_FACE = {"": 0.0, "vertex": 0.5, "edge": 1.5, "face": 1.0}
"""Elements per face of a large closed mesh."""

BUILD, FRAME = "build", "frame"
LOST = {"collapse_edge": -2, "remove_face": -1}
"""Faces that an operation takes away."""
NUMBERS = "times", "in_order", "frames", "builds", "vertices", "seconds"


@dataclass(frozen=True)
class Row:
    """How often something is asked or done: ``times``, or so often for ``each`` element.

    ``in_order``: the share of it that is near to what was asked before; the rest is at random.
    ``caller``: ``compiled``, as in an algorithm or a batch, or ``python``: one call each.
    """

    what: str
    times: float
    each: str = ""
    per: str = BUILD
    in_order: float = 0.0
    caller: str = COMPILED

    def __post_init__(self) -> None:
        allowed: dict[str, Any] = {
            "what": KNOWN, "each": [*PER_FACE], "per": (BUILD, FRAME), "caller": (COMPILED, PYTHON)
        }  # fmt: skip
        for name, known in allowed.items():
            if getattr(self, name) not in known:
                there = ", ".join(map(repr, known))
                raise ValueError(f"{name} is {getattr(self, name)!r}; there are {there}")
        if not (self.times >= 0 and 0 <= self.in_order <= 1):
            raise ValueError("times is a number from 0 on, in_order a share from 0 to 1")

    @property
    def per_frame(self) -> bool:
        """Whether it is asked in every frame."""
        return self.per == FRAME

    @property
    def share_of_faces(self) -> float:
        """How many elements of its kind there are per face; 0 where it is as often on any mesh."""
        return PER_FACE[self.each]

    @property
    def edits(self) -> bool:
        """Whether there is more of it where there are more edits."""
        return is_edit(self.what) or self.what == ANEW

    @property
    def gain(self) -> int:
        """Faces that one of them adds to the mesh."""
        growth = OPERATIONS[self.what].growth[1] if self.what in OPERATIONS else 0
        return growth or LOST.get(self.what, 0)

    def count(self, faces: float, frames: float) -> float:
        """How often on a mesh of so many faces."""
        many = self.share_of_faces * faces if self.each else 1.0
        return self.times * many * (frames if self.per_frame else 1.0)


@dataclass(frozen=True)
class Measured:
    """What the whole workload takes on one structure, as its user has measured it.

    What is left of it beside queries and operations is the program's own, on any structure.
    """

    structure: str
    vertices: float
    seconds: float

    def __post_init__(self) -> None:
        compiled = [name for name, it in REGISTRY.items() if it.compiled]  # as its program was
        require_known("structure", [self.structure], compiled)
        if not self.vertices > 0:
            raise ValueError(f"it was measured on a mesh of some vertices, not {self.vertices:g}")


@dataclass(frozen=True)
class Workload:
    """``builds``: how often the mesh is built, ``frames``: how many there are after each build.

    0 builds: it is there already, and building it is not counted.
    """

    title: str
    rows: tuple[Row, ...]
    frames: float = 1.0
    builds: float = 1.0
    measured: Measured | None = None

    @property
    def often(self) -> float:
        """How often all its rows come: as often as it is built, or once."""
        return self.builds or 1.0

    def more_edits(self, times: float) -> Self:
        """The same with so many times the operations."""
        edited = (replace(it, times=it.times * times) if it.edits else it for it in self.rows)
        return replace(self, rows=tuple(edited))


def recorded(recording: Recording, title: str = "Recorded", each: str = "") -> Workload:
    """A workload as it was recorded; ``each``: an element in proportion to which it grows."""
    rows = (Row(it.what, it.times / recording.many(each), each, BUILD, it.in_order, it.caller)
            for it in recording.rows)  # fmt: skip
    return Workload(title, tuple(rows), builds=0.0)


def find_workload(name: str) -> Workload:
    """A preset, or a file: TOML as those of the presets, or CSV as ``hem.record`` saves it.

    Raises ValueError that says what is wrong and where, OSError where a file cannot be read.
    """
    if name in PRESETS:
        return PRESETS[name]
    path = Path(name)
    if not path.is_file():
        raise ValueError(
            f"there is no workload {name!r}: name a .toml or .csv file, or one of "
            f"{', '.join(PRESETS)}"
        )
    given: dict[str, Any] = {"title": path.stem}
    try:
        if path.suffix.lower() == ".csv":
            with path.open(newline="", encoding="utf-8-sig") as lines:
                rows = csv.DictReader(lines, restkey="a cell too many")
                return _workload({**given, "builds": 0, "rows": list(rows)})
        return _workload({**given, **tomllib.loads(path.read_text("utf-8-sig"))})
    except (ValueError, TypeError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from error


def _workload(given: Mapping[str, Any]) -> Workload:
    known = {it.name for it in fields(Workload)}
    if unknown := sorted(set(given) - known):
        raise ValueError(f"{', '.join(unknown)} is nothing that a workload has: {sorted(known)}")
    if not isinstance(given.get("title", ""), str):
        raise ValueError(f"its title is a text, not {given['title']!r}")
    if not (isinstance(given.get("rows"), list) and given["rows"]):
        raise ValueError("it has no rows, such as [[rows]] with what and times")
    rows = tuple(_read(Row, f"row {place}", it) for place, it in enumerate(given["rows"], 1))
    measured = _read(Measured, "[measured]", given["measured"]) if "measured" in given else None
    return Workload(**{**_numbers(given), "rows": rows, "measured": measured})


def _read(kind: Any, where: str, given: Mapping[str, Any]) -> Any:
    """A table of a file; ValueError that says what is wrong with it, and where it stands."""
    known = {it.name: it.default is MISSING for it in fields(kind)}
    if not isinstance(given, Mapping):
        raise ValueError(f"{where} is a table; there are {', '.join(known)}")
    wrong = [f"nothing is called {it!r}" for it in given if it not in known]
    wrong += [f"{it!r} is missing" for it, needed in known.items() if needed and it not in given]
    if wrong:
        raise ValueError(f"{where}: {' and '.join(wrong)}; there are {', '.join(known)}")
    try:
        return kind(**_numbers(given))
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from error


def _numbers(given: Mapping[str, Any]) -> dict[str, Any]:
    """The same with numbers for texts, as in a CSV."""
    found = dict(given)
    for name in (it for it in NUMBERS if it in found):
        with suppress(ValueError, TypeError):
            found[name] = float(given[name])
        if not (isinstance(found[name], float) and 0 <= found[name] < inf):
            raise ValueError(f"{name} is a number from 0 on, not {given[name]!r}")
    return found


_TEXT = Path(__file__).with_name("workloads.toml").read_text("utf-8")
PRESETS = {name: _workload(it) for name, it in tomllib.loads(_TEXT).items()}
"""Usual workloads by name."""

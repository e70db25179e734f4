"""The structures for a mesh and a workload, the best first, and where that changes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import hem
from experiments import require_known
from experiments.advice.prices import Forecast, Prices, predict
from experiments.advice.workload import Workload
from hem.contract import ANEW, PYTHON, is_edit
from structures import REGISTRY, Structure, build

ALIKE = 1.1
"""Within this factor two structures are alike."""

FACTORS = tuple(float(2.0**k) for k in range(1, 13))
SIZES = np.geomspace(50, 5_000_000, 51)
"""Vertices at which the best structure is looked for."""

BUILT_OF_OBJECTS = 20_000
"""Faces up to which a structure of objects is built to be weighed."""


def _holds_borders(kind: type[Structure]) -> bool:
    """Whether a structure holds meshes that have borders."""
    try:
        build(kind.name, hem.generate("grid", 100))
    except hem.MeshError:
        return False
    return True


NEEDS: dict[str, tuple[str, Callable[[type[Structure]], bool]]] = {
    "edges": ("records no edges", lambda it: not it.emulated),
    "borders": ("holds closed meshes only", _holds_borders),
    "polygons": ("holds triangles only", lambda it: it.holds_polygons),
    "attributes": ("keeps no values on edges", lambda it: not it.emulated),
    "edits": ("looks at the whole mesh for an edit", lambda it: not (it.searches or it.rebuilds)),
}
"""By name: what is wrong with a structure that cannot, and whether it can. ``edits`` is for what
is drawn while it is edited."""


@dataclass(frozen=True)
class Limits:
    """The most bytes, and the most seconds that the slowest kind of edit may take: its median."""

    bytes: float = np.inf
    edit: float = np.inf

    def __post_init__(self) -> None:
        if not (self.bytes >= 0 and self.edit >= 0):
            raise ValueError("the most bytes, and the most that an edit may take, are from 0 on")


@dataclass(frozen=True)
class Option:
    """A structure that could be taken: what it would take, and what keeps it behind the best.

    ``edit``: what the slowest kind of edit takes in the median, in seconds, called from Python; NaN
    where the run does not tell.
    """

    forecast: Forecast
    bytes: int
    edit: float
    behind: str = ""


@dataclass(frozen=True)
class Advice:
    """Options, the best first and then the quickest; why not the others; where it changes.

    ``regular``: whether prices are those on regular meshes.
    """

    faces: int
    regular: bool
    workload: Workload
    options: list[Option]
    refused: dict[str, str]
    flips: list[dict[str, Any]]


def advise(
    prices: Prices, workload: Workload, mesh: Any, limits: Limits | None = None,
    needs: Sequence[str] = (),
) -> Advice:  # fmt: skip
    """Rank the structures that can hold a mesh, are what is needed and stay within the limits.

    By prices on meshes as regular as it is, where there are such.

    What the workload was measured on stays first as long as nothing is quicker by ``ALIKE``.
    Raises ValueError for a need that there is not.
    """
    require_known("need", needs, NEEDS)
    limits = limits or Limits()
    triangles = mesh.triangulated() if isinstance(mesh, hem.PolygonMesh) else mesh
    faces, prices = len(triangles.triangles), prices.like(triangles.triangles)
    options, refused, beyond = [], {}, {}
    for name in REGISTRY:
        wrong, taken = _unfit(prices, workload, name, needs), 0
        try:
            taken = _bytes(name, mesh, faces)
        except hem.MeshError as error:
            wrong.append(f"cannot hold it: {error}")
        edit = _edit(prices, workload, name, faces)
        beyond[name] = _beyond(limits, taken, edit)
        if wrong:
            refused[name] = "; ".join(wrong + beyond[name])
        else:
            options.append(Option(predict(prices, workload, name, faces), taken, edit))
    refused |= _told_less_of(options)
    weights = {name: it.bytes for it in options if (name := it.forecast.structure) not in refused}
    refused |= {name: "; ".join(beyond[name]) for name in weights if beyond[name]}
    options = [it for it in options if it.forecast.structure not in refused]
    costs = {it.forecast.structure: it.forecast.seconds for it in options}
    first = best(costs, workload.measured.structure if workload.measured else "")
    options.sort(key=lambda it: (it.forecast.structure != first, it.forecast.seconds))
    named = [replace(it, behind=_behind(options[0].forecast, it.forecast)) for it in options]
    found = flips(prices, workload, weights, faces, limits, first) if first else []
    return Advice(faces, not prices.family, workload, named, refused, found)


def _unfit(prices: Prices, workload: Workload, name: str, needs: Sequence[str]) -> list[str]:
    """Why a structure is none for a workload, on whatever mesh."""
    wrong = [NEEDS[it][0] for it in dict.fromkeys(needs) if not NEEDS[it][1](REGISTRY[name])]
    if name not in prices.structures:
        wrong.append("the run has not measured it")
    if workload.measured and not REGISTRY[name].compiled:
        wrong.append("is interpreted, and the measured whole was compiled")
    return wrong


def _told_less_of(options: Sequence[Option]) -> dict[str, str]:
    """The structures of which the run lacks prices that it has of others, and why not them.

    What is told of none of them makes none of them look cheaper.
    """
    of_none = set.intersection(*(set(it.forecast.untold) for it in options)) if options else set()
    found = {}
    for it in options:
        if missing := [what for what in it.forecast.untold if what not in of_none]:
            found[it.forecast.structure] = f"the run does not tell what {', '.join(missing)} takes"
    return found


def _bytes(name: str, mesh: Any, faces: int) -> int:
    """Exactly, by building it; of objects in proportion to a small mesh."""
    if REGISTRY[name].compiled or faces <= BUILT_OF_OBJECTS:
        return sum(build(name, mesh).memory(names=True).values())
    build(REGISTRY[name].claims.like or name, mesh)  # in arrays, which hold the same meshes
    small = hem.generate("torus", 1000)
    return round(sum(build(name, small).memory().values()) * faces / len(small.triangles))


def _beyond(limits: Limits, taken: float, edit: float) -> list[str]:
    """What is more than it may be; what is limited and not known is, too."""
    wrong = []
    if taken > limits.bytes:
        wrong.append(f"takes {taken:,} bytes of {limits.bytes:,.0f}")
    if edit > limits.edit:
        wrong.append(f"an edit takes {1e3 * edit:.3g} ms of {1e3 * limits.edit:.3g}")
    if np.isnan(edit) and limits.edit < np.inf:
        wrong.append("the run does not tell what an edit takes")
    return wrong


def _edit(prices: Prices, workload: Workload, name: str, faces: float) -> float:
    """Seconds of the slowest kind of edit in a workload; NaN where the run does not tell."""
    edits = {it.what for it in workload.rows if is_edit(it.what)}
    try:
        anew = prices.price(name, ANEW, faces).seconds if edits else 0.0
        found = [prices.price(name, it, faces, caller=PYTHON).seconds + anew for it in edits]
    except KeyError:
        return np.nan
    return max(found, default=0.0)


def _behind(best: Forecast, other: Forecast) -> str:
    """What costs a structure most that the best one does not pay."""
    if other.seconds <= ALIKE * best.seconds:
        return ""
    more = {it: cost - best.parts.get(it, 0.0) for it, cost in other.parts.items()}
    return max(more, key=lambda it: more[it])


def best(costs: Mapping[str, float], held: str = "") -> str:
    """The quickest structure, or the one that is ``held`` where none is quicker by ``ALIKE``.

    Changing costs work, and what was measured is surer than what is predicted.
    """
    least = min(costs, key=lambda it: costs[it], default="")
    return held if held in costs and costs[held] <= ALIKE * costs[least] else least


def flips(
    prices: Prices, workload: Workload, weights: Mapping[str, float], faces: float, limits: Limits,
    first: str,
) -> list[dict[str, Any]]:  # fmt: skip
    """Where another structure than ``first`` is the best: at how many vertices, or more edits.

    Only where it is ahead by more than ``ALIKE``, or ``first`` is beyond the limits; "" where all
    are. ``weights``: the bytes of those that suit but for the limits. Sizes are those measured.
    """

    def best_of(given: Workload, many: float) -> str:
        within = (
            name
            for name, taken in weights.items()
            if not _beyond(limits, taken * many / max(faces, 1), _edit(prices, given, name, many))
        )
        return best({it: predict(prices, given, it, many).seconds for it in within}, first)

    low, high = prices.measured
    sizes = [n for n in SIZES if low <= 2 * n <= high]
    ways = [
        ("vertices", [(n, workload, 2 * n) for n in sizes if 2 * n >= faces]),
        ("vertices", [(n, workload, 2 * n) for n in reversed(sizes) if 2 * n < faces]),
    ]
    if any(is_edit(it.what) for it in workload.rows):
        for factors in (FACTORS, [1 / it for it in FACTORS]):
            ways.append(("edits", [(it, workload.more_edits(it), faces) for it in factors]))
    found = []
    for kind, points in ways:
        for x, given, many in points:
            other = best_of(given, many)
            if other != first:
                found.append({"of": kind, "at": float(x), "best": other})
                break
    return found

"""What a case will take of memory, before it takes it.

Estimated from what a small mesh takes in the same structure, which is in proportion to its
vertices; a case that would take more than a part of what there is is left out and says so.
"""

from __future__ import annotations

import os
import re
from functools import lru_cache
from pathlib import Path

import hem
import structures
from experiments.harness.cases import Case
from experiments.harness.presets import HUBS
from structures import REGISTRY

SHARE = 0.7
"""The part of the available memory that a case may take."""

VARIABLE = "HEM_MEMORY"
"""Environment variable that says how much memory there is, such as ``500M``, ``8G`` or bytes."""

SMALL = 400
MESH_BYTES = {"torus": 300, HUBS: 300}
OTHER_MESH_BYTES = 1_600
"""Bytes per vertex of a mesh while it is made, renumbered and checked: the sphere's and more."""

OBJECTS_BYTES = 2_500
"""Bytes per vertex of what is as printed: objects, with the render mesh beside them."""

BUILDING = 3
"""How much more than what remains of it a compiled structure takes while it is built."""

CHASE_COPIES = 3
UNITS = {"": 1, "K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}
CGROUPS = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
    ),
)


def why_too_large(case: Case, copies: int) -> str:
    """Why a case had better be left out; empty if it fits."""
    needed, there = estimate(case, copies), available()
    if needed <= SHARE * there:
        return ""
    return (
        f"would take some {megabytes(needed)} of memory; "
        f"{megabytes(there)} are available, of which a case may take {SHARE:.0%}"
    )


def estimate(case: Case, copies: int) -> int:
    """Bytes that a case takes at its peak, about; more rather than less.

    ``copies``: how many structures' bytes its experiment holds at a time; 0 where a case is just so
    many bytes.
    """
    if not copies:
        return CHASE_COPIES * case.size
    compiled = case.structure in REGISTRY and REGISTRY[case.structure].compiled
    each = per_vertex(case.structure, case.reference_bytes)
    building = BUILDING * each if compiled else each
    mesh = MESH_BYTES.get(case.family, OTHER_MESH_BYTES)
    return int(vertices(case) * (mesh + building + copies * each))


@lru_cache(maxsize=32)
def per_vertex(structure: str, reference_bytes: int = 4) -> float:
    """Bytes per vertex that remain of a structure, as it says itself of a small mesh."""
    if structure not in REGISTRY:
        return OBJECTS_BYTES
    small = structures.build(structure, hem.generate("torus", SMALL), reference_bytes)
    return sum(small.memory().values()) / small.n_vertices


def vertices(case: Case) -> int:
    """How many vertices the mesh of a case will have, about."""
    if case.family in hem.SAMPLES:
        return len(case.mesh().points)
    return case.size // 2 if case.family == HUBS else case.size


def available() -> int:
    """Bytes that this process may still take: by the system, its control group, or as told.

    Raises ValueError if what ``HEM_MEMORY`` says is no size.
    """
    told = os.environ.get(VARIABLE)
    if told:
        return size_of(told)
    return min([_free(), *_left_in_cgroups()])


def size_of(text: str) -> int:
    """``"500M"`` → bytes. Raises ValueError."""
    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?", text.strip(), re.IGNORECASE)
    if not found:
        raise ValueError(f"{VARIABLE} is a size such as 500M or 8G, not {text!r}")
    return int(float(found[1]) * UNITS[found[2].upper()])


def megabytes(size: float) -> str:
    """Bytes for reading."""
    return f"{size / UNITS['M']:,.0f} MiB"


def _free() -> int:
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
    except OSError:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    kilobytes = {line.partition(":")[0]: line.split()[1] for line in lines}
    return 1024 * int(kilobytes.get("MemAvailable") or kilobytes["MemFree"])


def _left_in_cgroups() -> list[int]:
    left = []
    for limit, used in CGROUPS:
        try:
            values = Path(limit).read_text().strip(), Path(used).read_text().strip()
        except OSError:
            continue
        if values[0] != "max":
            taken = int(values[1]) - _given_back(Path(used).with_name("memory.stat"))
            left.append(max(0, int(values[0]) - taken))
    return left


def _given_back(stat: Path) -> int:
    """Bytes of a control group that hold copies of files, and are let go where they are needed."""
    try:
        counts = dict(line.split() for line in stat.read_text().splitlines())
    except (OSError, ValueError):
        return 0
    return int(counts.get("total_inactive_file") or counts.get("inactive_file") or 0)

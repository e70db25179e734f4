"""What a case will take of memory, in proportion to a small mesh: too large a case is skipped."""

import os
import re
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

import psutil

import hem
import structures
from experiments.harness.cases import Case
from experiments.presets import HUBS
from structures import REGISTRY

SHARE = 0.7  # the part of the available memory that a case may take
VARIABLE = "HEM_MEMORY"  # says how much memory there is: `500M`, `8G` or bytes
SMALL = 400
MESH_BYTES = {"torus": 300, HUBS: 300}
OTHER_MESH_BYTES = 1_600  # per vertex while a mesh is made and checked: the sphere's and more
OBJECTS_BYTES = 2_500  # per vertex of objects as published, with their render mesh
BUILDING = 3  # how much more than what remains of it a compiled structure takes while it is built
CHASE_COPIES = 3
UNITS = {"": 1, "K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}
CGROUP = "/sys/fs/cgroup"
CGROUPS = (
    (f"{CGROUP}/memory.max", f"{CGROUP}/memory.current"),
    (f"{CGROUP}/memory/memory.limit_in_bytes", f"{CGROUP}/memory/memory.usage_in_bytes"),
)


def why_too_large(case: Case, copies: int) -> str:
    """Why a case had better be skipped; empty if it fits."""
    needed, there = estimate(case, copies), available()
    if needed <= SHARE * there:
        return ""
    left = f"{there / UNITS['M']:,.0f} MiB are available, of which a case may take {SHARE:.0%}"
    return f"would take some {needed / UNITS['M']:,.0f} MiB of memory; {left}"


def estimate(case: Case, copies: int) -> int:
    """Bytes that a case takes at its peak, about; more rather than less.

    ``copies``: how many structures' bytes its experiment holds; 0 where a case is so many bytes.
    """
    if not copies:
        return CHASE_COPIES * case.size
    compiled = case.structure in REGISTRY and REGISTRY[case.structure].compiled
    each = _per_vertex(case.structure, case.reference_bytes)
    mesh = MESH_BYTES.get(case.family, OTHER_MESH_BYTES)
    vertices = case.vertices or len(case.mesh().points)
    return int(vertices * (mesh + (BUILDING if compiled else 1) * each + copies * each))


@lru_cache(maxsize=32)
def _per_vertex(structure: str, reference_bytes: int) -> float:
    """Bytes per vertex that remain of a structure, as it says itself of a small mesh."""
    if structure not in REGISTRY:
        return OBJECTS_BYTES
    small = structures.build(structure, hem.generate("torus", SMALL), reference_bytes)
    return sum(small.memory(names=True).values()) / small.n_vertices


def available() -> int:
    """Bytes that system and control group leave, or as told; ValueError if that is no size."""
    told = os.environ.get(VARIABLE)
    return size_of(told) if told else min([psutil.virtual_memory().available, *_left_in_cgroups()])


def size_of(text: str) -> int:
    """``"500M"`` → bytes. Raises ValueError."""
    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?", text.strip(), re.IGNORECASE)
    if not found:
        raise ValueError(f"{VARIABLE} is a size such as 500M or 8G, not {text!r}")
    return int(float(found[1]) * UNITS[found[2].upper()])


def _left_in_cgroups() -> list[int]:
    """What control groups still allow; copies of files are let go where memory is needed."""
    left = []
    for limit, used in CGROUPS:
        with suppress(OSError):
            most, taken = Path(limit).read_text().strip(), int(Path(used).read_text())
            stat = Path(used).with_name("memory.stat")
            counts = dict(map(str.split, stat.read_text().splitlines() if stat.exists() else []))
            files = int(counts.get("total_inactive_file") or counts.get("inactive_file") or 0)
            if most != "max":
                left.append(max(0, int(most) - taken + files))
    return left

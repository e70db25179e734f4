"""What ran where: the facts that a run carries besides its measurements."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from experiments.runs.results import SCHEMA, Run
from experiments.runs.steadiness import noise

LIBRARIES = ("numpy", "numba", "scipy", "pandas", "pymeshlab", "pytest-benchmark")


def describe(profile: str) -> dict[str, Any]:
    """The head of a run: schema, profile, time, commit, machine and versions."""
    return {
        "schema": SCHEMA,
        "profile": profile,
        "started": now(),
        **source(),
        "machine": machine(),
        "versions": {
            "python": platform.python_version(),
            **{library: version(library) for library in LIBRARIES},
        },
    }


def source() -> dict[str, Any]:
    """The commit that is run, and whether anything was changed since."""
    commit = _git("rev-parse", "HEAD")
    dirty = bool(_git("status", "--porcelain")) if commit else None
    return {"commit": commit or "unknown", "dirty": dirty}


def resumed() -> dict[str, Any]:
    """When a run is gone on with, and by which commit."""
    return {"at": now(), **source()}


def now() -> str:
    """The time, UTC, to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def machine() -> dict[str, Any]:
    """The processor, its caches and the memory."""
    return {
        "cpu": _cpu(),
        "cores": os.cpu_count(),
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "caches": _caches(),
        "platform": f"{platform.system()} {platform.release()} {platform.machine()}",
        "python": sys.implementation.name,
    }


def in_words(run: Run) -> str:
    """What a run was, where it was measured, and how calm it was there."""
    meta = run.meta
    versions = ", ".join(f"{name} {number}" for name, number in meta.get("versions", {}).items())
    state = {True: " with changes that are not committed", False: "", None: ""}[meta.get("dirty")]
    finished = f"to {meta['finished']}" if "finished" in meta else "and not finished"
    return (
        f"Preset {meta.get('profile')}, from {meta.get('started')} {finished}, at commit "
        f"{str(meta.get('commit'))[:10]}{state}. "
        f"{_measured_by(run)}. {versions}. {len(run.cases):,} cases, each checked against the "
        f"triangle list before it was measured. {noise(run).words}"
    )


def _measured_by(run: Run) -> str:
    if run.machines:
        return f"Measured by {len(run.machines)} machines, whose times are not compared"
    it = run.meta.get("machine", {})
    caches = ", ".join(f"{level} {size}" for level, size in it.get("caches", {}).items())
    return (
        f"{it.get('cores')} cores of {it.get('cpu')} ({caches}), "
        f"{it.get('memory_bytes', 0) / 2**30:.0f} GiB, {it.get('platform')}"
    )


def _cpu() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown"


def _caches() -> dict[str, str]:
    """Data caches of the first core by level, such as ``{"L1": "32K"}``; Linux only."""
    found = {}
    for cache in sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        if (cache / "type").read_text().strip() != "Instruction":
            level = (cache / "level").read_text().strip()
            found[f"L{level}"] = (cache / "size").read_text().strip()
    return found


def _git(*arguments: str) -> str:
    here = Path(__file__).parent
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=here, capture_output=True, text=True, check=True, timeout=10
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()

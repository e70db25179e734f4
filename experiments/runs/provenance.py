"""What ran where: the facts that a run carries besides its measurements."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from datetime import UTC, datetime
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import psutil

from experiments.runs.run import Run
from experiments.runs.steadiness import noise
from experiments.runs.store import SCHEMA

LIBRARIES = ("numpy", "numba", "scipy", "pandas", "pymeshlab", "pytest-benchmark")


def describe(preset: str) -> dict[str, Any]:
    """The head of a run: schema, preset, time, commit, machine and versions."""
    head = {"schema": SCHEMA, "preset": preset, "started": now(), **source()}
    return {**head, "machine": machine(), "versions": _versions()}


def source() -> dict[str, Any]:
    """The commit that is run, and whether anything was changed since."""
    commit = git("rev-parse", "HEAD")
    return {
        "commit": commit or "unknown",
        "dirty": bool(git("status", "--porcelain")) if commit else None,
    }


def git(*arguments: str) -> str:
    """What git says of the checkout this runs in; empty where it says nothing."""
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=Path(__file__).parent, capture_output=True, text=True,
            check=True, timeout=10,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()


def now() -> str:
    """The time, UTC, to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def machine() -> dict[str, Any]:
    """The processor, its caches and the memory."""
    return {
        "cpu": _cpu(),
        "cores": os.cpu_count(),
        "memory_bytes": psutil.virtual_memory().total,
        "caches": _caches(),
        "platform": f"{platform.system()} {platform.release()} {platform.machine()}",
        "python": sys.implementation.name,
    }


def machine_id(machine: dict[str, Any]) -> str:
    """Eight hexadecimal digits that are the same as long as the machine is.

    Of processor, cores, caches, GiB of memory, system and architecture; not of what an update or a
    restart changes, such as the release of the kernel or some reserved megabytes.
    """
    system = str(machine.get("platform", "")).split()
    facts = {
        "cpu": machine.get("cpu"),
        "cores": machine.get("cores"),
        "memory_gib": round((machine.get("memory_bytes") or 0) / 2**30),
        "caches": machine.get("caches"),
        "platform": [*system[:1], *system[-1:]],
        **{key: machine[key] for key in ("machines",) if machine.get(key)},
    }
    return sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:8]


def in_words(run: Run) -> str:
    """What a run was, where it was measured, and how calm it was there."""
    meta = run.meta
    versions = ", ".join(f"{name} {number}" for name, number in meta.get("versions", {}).items())
    changes = " with changes that are not committed" if meta.get("dirty") else ""
    finished = f"to {meta['finished']}" if "finished" in meta else "and not finished"
    return (
        f"Preset {meta.get('preset')}, from {meta.get('started')} {finished}, at commit "
        f"{str(meta.get('commit'))[:10]}{changes}. "
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


def _versions() -> dict[str, str]:
    versions = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:  # some are optional
            continue
    return versions


def _cpu() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown"


def _caches() -> dict[str, str]:
    """Data caches of the first core by level, such as ``{"L1": "32K"}``; Linux only."""
    caches = {}
    for cache in sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        if (cache / "type").read_text().strip() != "Instruction":
            level = (cache / "level").read_text().strip()
            caches[f"L{level}"] = (cache / "size").read_text().strip()
    return caches

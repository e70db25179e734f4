"""What ran where: the facts that a run carries besides its measurements."""

import json
import os
import platform
import re
import subprocess
import sys
from contextlib import suppress
from datetime import UTC, datetime
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from subprocess import DEVNULL
from typing import Any

import psutil

from experiments.runs.store import SCHEMA

LIBRARIES = ("numpy", "numba", "scipy", "pandas", "pymeshlab", "pytest-benchmark")


def describe(preset: str) -> dict[str, Any]:
    """The head of a run: schema, preset, time, commit, machine and versions."""
    versions = {"python": platform.python_version()}
    for name in LIBRARIES:
        with suppress(PackageNotFoundError):  # some are optional
            versions[name] = version(name)
    # Nothing is told of a project that this is only installed in.
    commit = git("rev-parse", "HEAD") if git("ls-files", Path(__file__).name) else ""
    return {
        "schema": SCHEMA, "preset": preset, "started": now(), "commit": commit or "unknown",
        "dirty": bool(git("status", "--porcelain")) if commit else None,  # changed since
        "machine": machine(), "versions": versions,
    }  # fmt: skip


def git(*arguments: str) -> str:
    """What git says of the checkout this runs in; empty where it says nothing."""
    command = ["git", "-C", str(Path(__file__).parent), *arguments]
    try:
        return subprocess.check_output(command, stderr=DEVNULL, text=True, timeout=60).strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def now() -> str:
    """The time, UTC, to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def machine() -> dict[str, Any]:
    """The processor, its caches and the memory."""
    return {
        "cpu": _cpu(), "cores": os.cpu_count(), "memory_bytes": psutil.virtual_memory().total,
        "caches": _caches(),
        "platform": f"{platform.system()} {platform.release()} {platform.machine()}",
        "python": sys.implementation.name,
    }  # fmt: skip


def machine_id(machine: dict[str, Any]) -> str:
    """Eight hexadecimal digits of what no update or restart of the machine changes."""
    system = str(machine.get("platform", "")).split()
    facts = {it: machine.get(it) for it in ("cpu", "cores", "caches")}
    facts["memory_gib"] = round((machine.get("memory_bytes") or 0) / 2**30)
    facts["platform"] = [*system[:1], *system[-1:]]
    if machine.get("machines"):
        facts["machines"] = machine["machines"]
    return sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:8]


def _cpu() -> str:
    info = Path("/proc/cpuinfo")
    text = info.read_text() if info.exists() else ""
    named = re.search(r"^model name\s*: *(.+?) *$", text, re.MULTILINE)
    return named[1] if named else platform.processor() or "unknown"


def _caches() -> dict[str, str]:
    """Data caches of the first core by level, such as ``{"L1": "32K"}``; Linux only."""
    caches = {}
    for cache in sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        if (cache / "type").read_text().strip() != "Instruction":
            level = (cache / "level").read_text().strip()
            caches[f"L{level}"] = (cache / "size").read_text().strip()
    return caches

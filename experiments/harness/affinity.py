"""On which core a measurement runs: one, where the system allows it, and the calmest."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path
from time import sleep

WATCHED_SECONDS = 0.1


@lru_cache(maxsize=1)
def allowed() -> list[int]:
    """The cores this process was given; none where the system does not say."""
    return sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else []


def pin() -> int | None:
    """Keep this process, and threads it starts later, on the calmest core -> which, or None.

    None where the system has no such call or refuses it; then the process moves about as before.
    """
    cores = allowed()
    if not cores:
        return None
    try:
        os.sched_setaffinity(0, cores)
        core = calmest(cores)
        os.sched_setaffinity(0, {core})
    except OSError:
        return None
    return core


def calmest(cores: list[int], seconds: float = WATCHED_SECONDS) -> int:
    """The core that was idle for longest just now; the last one where nobody counts."""
    before = idle_ticks()
    sleep(seconds)
    after = idle_ticks()
    return max(cores, key=lambda core: (after.get(core, 0) - before.get(core, 0), core))


def idle_ticks() -> dict[int, int]:
    """By core, for how long it was idle since the machine started; Linux only, else empty."""
    try:
        lines = [line.split() for line in Path("/proc/stat").read_text().splitlines()]
    except OSError:
        return {}
    rows = [row for row in lines if row and row[0].startswith("cpu") and row[0][3:].isdigit()]
    return {int(row[0][3:]): int(row[4]) for row in rows if len(row) > 4}

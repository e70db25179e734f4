"""From a run to the one line that the history keeps of it: a claim, a few figures."""

from __future__ import annotations

import json
import subprocess
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from experiments.claims.growth import MEMORY, Claim, load_claims
from experiments.claims.judged import SOURCES, Evidence, judged, short
from experiments.runs.results import ResultsError, Run

SCHEMA = 2


def record(run: Run) -> dict[str, Any]:
    """The line of a run. Raises ResultsError if it is not finished.

    Of each claim, as far as it was measured: ``outcome`` by work, which decides (of memory: by
    bytes), and ``outcome_time``; ``slopes`` with their intervals, by measure and variable;
    ``work``, accesses at ``work_faces``, the largest mesh; ``seconds`` at ``time_faces``, the
    largest one that was timed, of ``time_sizes``; ``relative``: the time in memory accesses, which
    take what they took beside the measurement; ``bytes`` per vertex.
    """
    meta = run.meta
    if "finished" not in meta:
        raise ResultsError(f"{run.folder} is not finished; go on with: hem study --resume")
    return {
        "schema": SCHEMA,
        "run": run.folder.resolve().name,
        "commit": meta["commit"],
        "committed": committed(meta["commit"]),
        **{key: meta[key] for key in ("dirty", "started")},
        "profile": meta["preset"],
        "structures": list(meta.get("structures", ())),
        "machine": identified(meta["machine"]),
        "versions": meta["versions"],
        "claims": _claims(run),
    }


def identified(machine: dict[str, Any]) -> dict[str, Any]:
    """A machine as a run describes it, with its ``id``."""
    return {"id": machine_id(machine), **machine}


def machine_id(machine: dict[str, Any]) -> str:
    """Eight hexadecimal digits that are the same as long as the machine is.

    Of processor, cores, caches, GiB of memory, system and architecture; not of what an update or a
    restart changes, such as the release of the kernel or some reserved megabytes.
    """
    platform = str(machine.get("platform", "")).split()
    facts = {
        "cpu": machine.get("cpu"),
        "cores": machine.get("cores"),
        "memory_gib": round((machine.get("memory_bytes") or 0) / 2**30),
        "caches": machine.get("caches"),
        "platform": [*platform[:1], *platform[-1:]],
    }
    if machine.get("machines"):
        facts["machines"] = machine["machines"]
    return sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:8]


def committed(commit: str) -> str | None:
    """The date of a commit of this repository, ISO 8601, or None where it is not known."""
    command = ["git", "show", "--no-patch", "--format=%cI", f"{commit}^{{commit}}"]
    try:
        done = subprocess.run(
            command, cwd=Path(__file__).parent, capture_output=True, text=True, check=True,
            timeout=10,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() or None


def _claims(run: Run) -> dict[str, Any]:
    evidence, claims = Evidence(run), load_claims()
    rows = judged(run, claims).to_dict("records")
    figures = {
        f"{it.table}/{it.structure}/{it.subject}": _figures(run, evidence, it, row)
        for it, row in zip(claims, rows, strict=True)
    }
    return {name: found for name, found in figures.items() if found}


def _figures(run: Run, evidence: Evidence, claim: Claim, row: dict[Any, Any]) -> dict[str, Any]:
    if claim.subject == MEMORY:
        size = row["bytes_per_vertex"]
        return {"outcome": row["outcome"], "bytes": short(size)} if np.isfinite(size) else {}
    verdicts = {
        f"{measure}_{variable}": row[f"{measure}_{variable}"]
        for measure, variable in SOURCES
        if row[f"{measure}_{variable}"]
    }
    if not verdicts:
        return {}
    slopes = {
        name: [short(it) for it in (found.slope, found.slope_low, found.slope_high)]
        for name, found in verdicts.items()
    }
    outcomes = {"outcome": row["outcome"], "outcome_time": row["outcome_time"]}
    times = {} if run.machines else _time(evidence, claim)
    return outcomes | {"slopes": slopes} | _work(evidence, claim) | times


def _work(evidence: Evidence, claim: Claim) -> dict[str, Any]:
    cases = evidence.curve("work", "faces", claim.structure, claim.subject, claim.table)
    if cases.empty:
        return {}
    case = cases.iloc[-1]
    return {"work": short(np.mean(case["samples"])), "work_faces": int(case["faces"])}


def _time(evidence: Evidence, claim: Claim) -> dict[str, Any]:
    """Seconds at the largest size, and the median over all sizes of seconds per memory access.

    At any one size where the caches end, the latency differs between runs by a factor of two or
    more; the median over the sizes came back within 2 % (standard deviation, nine runs).
    """
    measure = "random" if claim.table == "queries" else "time"
    cases = evidence.curve(measure, "faces", claim.structure, claim.subject, claim.table)
    if cases.empty:
        return {}
    seconds = np.array([np.median(samples) for samples in cases["samples"]])
    found = {
        "seconds": short(seconds[-1]),
        "time_faces": int(cases["faces"].iloc[-1]),
        "time_sizes": len(cases),
    }
    latency = cases["latency"].to_numpy(float)
    if np.isnan(latency).any():
        between = evidence.latency(cases["working_set"].to_numpy(float))
        if between is None:
            return found
        latency = np.where(np.isnan(latency), between, latency)
    return found | {"relative": short(np.exp(np.median(np.log(seconds / latency))))}

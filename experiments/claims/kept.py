"""Judged claims kept beside a run, so that a table, a report and a check judge it once.

``derived/judged.json`` holds what follows from the measurements and from the code that judges; it
is read only as long as both are what they were, and written anew otherwise.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import hem.complexity
from experiments.claims.claim import Claim
from experiments.claims.outcome import Outcome
from experiments.claims.verdicts import JudgedClaim
from experiments.harness import Axis
from hem.complexity import Verdict
from hem.whole_files import write_whole

NAME = "judged.json"
NUMBERS = ("work", "seconds", "bytes_per_vertex")


def read_judged(folder: Path, claims: Iterable[Claim]) -> list[JudgedClaim] | None:
    """What was kept of a run; None where nothing was, or of other files or by other code."""
    try:
        content = json.loads((folder / "derived" / NAME).read_text("utf-8"))
        if content["of"] != _state(folder):
            return None
        return [_judged(claim, content["claims"][claim.key]) for claim in claims]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def keep_judged(folder: Path, judged: Iterable[JudgedClaim]) -> None:
    """Keep them; who may not write beside the run may read it all the same."""
    rows = {it.claim.key: _plain(it) for it in judged}
    with suppress(OSError):
        write_whole(
            folder / "derived" / NAME, json.dumps({"of": _state(folder), "claims": rows}, indent=1)
        )


def _state(folder: Path) -> str:
    """A digest of the run's files and of the code that judges them."""
    digest = hashlib.sha256()
    code = [Path(__file__).parent, Path(str(hem.complexity.__file__)).parent]
    sources = [path for room in code for path in sorted(room.glob("*.*")) if path.is_file()]
    measured = sorted(path for path in folder.glob("*.json*") if path.is_file())
    for path in (*sources, *measured):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _plain(judged: JudgedClaim) -> dict[str, Any]:
    return {
        "outcome": judged.outcome,
        "outcome_time": judged.outcome_time,
        "found": judged.found,
        "reason": judged.reason,
        "verdicts": {axis.key: asdict(verdict) for axis, verdict in judged.verdicts.items()},
        "values": judged.values.tolist(),
        **{name: getattr(judged, name) for name in NUMBERS},
    }


def _judged(claim: Claim, row: dict[str, Any]) -> JudgedClaim:
    return JudgedClaim(
        claim=claim,
        outcome=Outcome(row["outcome"]),
        outcome_time=Outcome(row["outcome_time"]),
        found=row["found"],
        reason=row["reason"],
        verdicts={
            axis: Verdict(**row["verdicts"][axis.key])
            for axis in Axis
            if axis.key in row["verdicts"]
        },
        values=np.array(row["values"], float),
        **{name: row[name] for name in NUMBERS},
    )

"""A run judged once: what follows from it is kept beside it for tables, report and check.

``derived/judged.json`` holds what follows from the measurements, the claims and the code that
judges; it is read only as long as all are what they were, and written anew otherwise.
"""

import hashlib
import json
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

import hem.complexity
from experiments.claims.cells import load_claims
from experiments.claims.claim import Claim, JudgedClaim, Outcome
from experiments.claims.quantities import judge_sentences, sentence_claims
from experiments.claims.verdicts import judge_cells
from experiments.harness import Axis
from experiments.runs import Run
from hem.complexity import Verdict
from hem.whole_files import write_whole


@lru_cache(maxsize=4)
def judge_run(run: Run) -> list[JudgedClaim]:
    """Every cell of every table, then every sentence: judged once, which takes some seconds."""
    claims = [*load_claims(), *sentence_claims()]
    path, state = run.folder / "derived" / "judged.json", _state(run.folder, claims)
    with suppress(OSError, ValueError, KeyError, TypeError):
        content = json.loads(path.read_text("utf-8"))
        if content["of"] == state:
            return list(map(_judged, claims, content["claims"]))
    judged = [*judge_cells(run), *judge_sentences(run)]
    if "finished" in run.meta and run.folder.exists():
        with suppress(OSError):
            write_whole(path, json.dumps({"of": state, "claims": list(map(_plain, judged))}))
    return judged


def _state(folder: Path, claims: list[Claim]) -> str:
    """A digest of the run, of the claims wherever they stand, and of the code that judges."""
    digest = hashlib.sha256(repr(claims).encode())
    code = [Path(__file__).parent, Path(str(hem.complexity.__file__)).parent]
    for room, pattern in ((code[0], "*.*"), (code[1], "*.*"), (folder, "*.json*")):
        for path in sorted(filter(Path.is_file, room.glob(pattern))):
            digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _plain(judged: JudgedClaim) -> dict[str, Any]:
    verdicts = {axis.key: vars(verdict) for axis, verdict in judged.verdicts.items()}
    made = {"claim": judged.claim.key, "verdicts": verdicts, "values": judged.values.tolist()}
    return {**vars(judged), **made}


def _judged(claim: Claim, row: dict[str, Any]) -> JudgedClaim:
    kept = row["verdicts"]
    read = {
        "claim": claim,
        "outcome": Outcome(row["outcome"]),
        "outcomes": {measure: Outcome(it) for measure, it in row["outcomes"].items()},
        "verdicts": {axis: Verdict(**kept[axis.key]) for axis in Axis if axis.key in kept},
        "values": np.array(row["values"], float),
    }
    return JudgedClaim(**{**row, **read})

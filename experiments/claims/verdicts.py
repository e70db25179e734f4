"""From a run to judged claims: by work and by time, in each variable apart; once per run.

Work counts are exact, so they decide; time is judged beside them. Asked in consecutive order, a
query finds what it needs in the caches, and time shows its steps. Asked at random it waits for
memory, which is slower the larger the mesh. Constant costs are judged in proportion to the
reference beside them, the same code where its work cannot grow. What is claimed to grow goes
through more memory than that; it, and what has no reference, is judged by the memory's latency.
Times of a machine that was too busy accuse no claim.

Claims are judged on one family, whose vertices all have the same valence, and whose work is
counted. Others are timed alone, so that what holds there is told by time.

``derived/judged.json`` in a run is read as long as measurements, claims and code are the same.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

import hem.complexity
from experiments.claims.cells import load_claims
from experiments.claims.claim import BOUND, MEMORY, Claim, Exactly, Growth, JudgedClaim, Outcome
from experiments.claims.curves import TOO_BUSY, Curve, Curves, axes_of, curves
from experiments.claims.quantities import judge_sentences, sentence_claims
from experiments.harness import HUBS, QUERIES_TABLE, Axis
from experiments.runs import Run, experiments
from hem.complexity import Verdict, judge
from hem.whole_files import write_whole

CASE_ERROR = 0.15
"""How far cases of one curve stray, beyond what their own rounds tell: each takes milliseconds, and
other tenants slow the machine's caches for longer. A reference is a case, and strays as much."""

NEAR = "near "  # said before the closest class where costs do not tell which it is
FLAT = 0.5  # slope in n_ev below which what grows comes on top of a larger part that does not


def judge_cells(run: Run, claims: Sequence[Claim] | None = None) -> list[JudgedClaim]:
    """Every cell of every table, or these."""
    judges = {Growth: _judge_growth, Exactly: _judge_bytes}
    every = load_claims() if claims is None else claims
    return [judges[type(claim.expects)](curves(run), claim) for claim in every]


def _judge_bytes(of_run: Curves, claim: Claim) -> JudgedClaim:
    """What is claimed is of two faces per vertex, as on a torus."""
    found, faces = of_run.bytes_per_vertex(claim.structure), of_run.faces_per_vertex
    measured, reason = not np.isnan(found), ""
    outcome = Outcome.UNDETERMINED
    if not claim.claims_something:
        outcome = Outcome.NO_CLAIM
    elif Exactly(found) == claim.expects:
        outcome = Outcome.CONSISTENT
    elif measured and faces == 2:
        outcome = Outcome.VIOLATED
    elif measured and Exactly(round(found)) == claim.expects:
        outcome, reason = Outcome.CONSISTENT, "To the byte."
    elif measured:
        reason = f"The claim is of two faces per vertex, and this mesh has {faces:.4g}."
    values = np.array([found] if measured else [])
    return JudgedClaim(claim, outcome, f"{found:,.4g}" if measured else "?", reason, values=values)


def _judge_growth(of_run: Curves, claim: Claim) -> JudgedClaim:
    axes, classes = axes_of(claim.table), claim.classes
    cases = {axis: of_run.of(claim, axis) for axis in Axis}
    verdicts = {
        axis: _verdict(of_run, claim.table, axis, cases[axis], classes.get(axis.variable, "O(1)"))
        for axis in axes
        if len(cases[axis])
    }
    outcomes = {
        measure: Outcome.worst(
            verdicts[axis].outcome if axis in verdicts else Outcome.UNDETERMINED
            for axis in axes
            if axis.measure == measure and axis.variable in classes
        )
        for measure in dict.fromkeys(axis.measure for axis in axes)
    }
    counted = any(axis.exact for axis in axes)
    measure = "work" if counted else "time"
    timed = Axis.RANDOM_FACES if Axis.RANDOM_FACES in axes else Axis.TIME_FACES
    found = _class_found([axis for axis in axes if axis.measure == measure], verdicts)
    reason = " ".join(it.reason for axis, it in verdicts.items() if axis.exact == counted)
    return JudgedClaim(
        claim, outcomes[measure], found, reason, outcomes if claim.claims_something else {},
        verdicts, work=cases[Axis.WORK_FACES].largest, seconds=cases[timed].largest,
    )  # fmt: skip


def _verdict(of_run: Curves, table: str, axis: Axis, curve: Curve, expected: str) -> Verdict:
    """Judge a claim along one axis; O(1) where none is made, as the class found is what matters."""
    # What reads nothing at all costs something all the same: the call.
    samples = [np.maximum(it, 1) if axis.exact else it for it in curve.samples]
    constant = expected.removeprefix(BOUND) == "O(1)"
    reference = of_run.reference(curve) if constant and not axis.exact else None
    latency = None if axis.exact or reference is not None else of_run.latencies(curve)
    every = [it for it in experiments().values() if it.table and it.table.name == table]
    verdict = judge(
        curve.sizes, samples, expected.removeprefix(BOUND), latency,
        reference=reference, exact=axis.exact,
        latency_error=CASE_ERROR * (1 if reference is None else np.sqrt(2)),
        unseen=reference is None and any(axis in it.just_written for it in every),
        bound="upper" if expected.startswith(BOUND) else "tight",
    )  # fmt: skip
    if of_run.too_busy and not axis.exact and verdict.outcome == "violated":
        return replace(verdict, outcome="undetermined", reason=TOO_BUSY)
    return verdict


def _class_found(axes: Sequence[Axis], verdicts: Mapping[Axis, Verdict]) -> str:
    """What was measured in the table's own terms, such as ``O(n_ev)``; ``?`` where it was not.

    Beside a scan of all faces the few of one vertex are not named, as there are always more.
    """
    if not axes or not verdicts.keys() >= set(axes):
        return "?"
    grows = [axis for axis in axes if verdicts[axis].best != "O(1)"]
    if len(grows) > 1:
        grows = [it for it in grows if it.variable == "faces" or verdicts[it].slope >= FLAT]
    classes = [(axis.symbol, verdicts[axis].classes or [verdicts[axis].best]) for axis in grows]
    told = [[name[2:-1].replace("n", symbol) for name in names] for symbol, names in classes]
    found = " or ".join(f"O({' · '.join(factors) or '1'})" for factors in product(*told))
    return found if all(verdicts[axis].classes for axis in axes) else NEAR + found


def class_told(verdict: Verdict) -> str:
    """The class that costs tell, or two; where they tell none, which one comes nearest."""
    return verdict.answer or NEAR + verdict.best


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
    claims_here, whole = Path(__file__).parent, Path(str(hem.__file__)).parent.parent
    # Sentences build today's structures and count in their code; tables stand in experiments.
    code = "hem", "structures", "experiments/harness", "experiments/runs"
    rooms = [(whole / it, "**/*.py") for it in code]
    rooms += [(whole / "experiments", "bench_*.py"), (claims_here, "*.*"), (folder, "run.json")]
    rooms.append((folder, "**/*.jsonl"))  # of every machine
    for room, pattern in rooms:
        for path in sorted(filter(Path.is_file, room.glob(pattern))):
            digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _plain(judged: JudgedClaim) -> dict[str, Any]:
    verdicts = {axis.key: vars(verdict) for axis, verdict in judged.verdicts.items()}
    made = {"claim": judged.claim.key, "verdicts": verdicts, "values": judged.values.tolist()}
    return {**vars(judged), **made}


def _judged(claim: Claim, row: dict[str, Any]) -> JudgedClaim:
    kept = row["verdicts"]
    row |= {
        "claim": claim,
        "outcome": Outcome(row["outcome"]),
        "outcomes": {measure: Outcome(it) for measure, it in row["outcomes"].items()},
        "verdicts": {axis: Verdict(**kept[axis.key]) for axis in Axis if axis.key in kept},
        "values": np.array(row["values"], float),
    }
    return JudgedClaim(**row)


BY_TIME = Axis.TIME_FACES, Axis.RANDOM_FACES
DETERMINED = {Outcome.CONSISTENT, Outcome.VIOLATED}


class Family(NamedTuple):
    """A family: its largest mesh as a case of the run, and the judged claims on its queries."""

    name: str
    largest: pd.Series
    claims: list[JudgedClaim]

    def outcomes(self, axis: Axis) -> dict[str, Outcome]:
        """What became of every claim along an axis, by its key."""
        found = {it.claim.key: it.verdicts.get(axis) for it in self.claims}
        return {key: Outcome(it.outcome) for key, it in found.items() if it is not None}

    def against(self, other: "Family", axis: Axis) -> Iterator[JudgedClaim]:
        """The claims that hold on one of the two families, and are violated on the other."""
        mine, others = self.outcomes(axis), other.outcomes(axis)
        for it in self.claims:
            if {mine.get(it.claim.key), others.get(it.claim.key)} == DETERMINED:
                yield it


def judge_families(run: Run, judged: Sequence[JudgedClaim]) -> list[Family]:
    """All families whose queries were timed, the one that ``judged`` is of first.

    Where there are several, that one is judged anew by as much as the others have: every second
    size, and no reference. So what comes out otherwise is due to the meshes.
    """
    first = curves(run).judged_family
    timed = run.cases[run.cases["experiment"].isin(("bench_queries", "bench_latency"))]
    timed = timed[timed["family"] != HUBS]
    queries = [it for it in judged if it.claim.table == QUERIES_TABLE.name]
    asked = [it for it in queries if it.claim.claims_something and it.claim.subject != MEMORY]
    largest = timed[timed["experiment"] == "bench_queries"].sort_values("vertices")
    meshes = {name: of_family.iloc[-1] for name, of_family in largest.groupby("family")}
    mine = timed["family"] == first
    fewer = timed[mine].assign(reference=np.nan)
    fewer = fewer[fewer["vertices"].isin(sorted(set(fewer["vertices"]))[::2])]
    timed = pd.concat([timed[~mine], fewer]) if len(meshes) > 1 else timed
    families = []
    for name in sorted(meshes, key=lambda it: (it != first, it)):
        others = timed["family"].isin([it for it in meshes if it != name])
        alone = Run(run.folder, run.meta, timed[~others].reset_index(drop=True), run.skipped)
        found = judge_cells(alone, [it.claim for it in asked]) if len(meshes) > 1 else asked
        families.append(Family(str(name), meshes[name], found))
    return families

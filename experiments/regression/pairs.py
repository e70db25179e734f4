"""Every case of two runs, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from experiments.regression.findings import CaseKey, Kind
from experiments.regression.snapshots import describe_claim
from experiments.runs import Run, experiments
from structures import NAMED

Row = Mapping[Any, Any]
"""A case as a row of a run."""


class Pair(NamedTuple):
    """A case of two runs; None where one of them has none of it. ``why``: the reason, if known."""

    case: CaseKey
    kind: Kind
    before: Row | None
    after: Row | None
    why: str = ""


def claim_of(case: CaseKey) -> str:
    """The claim that a case bears on, in words: of its table, or on its structure's memory."""
    declared = experiments().get(case.experiment)
    if declared is not None and declared.table is not None:
        return describe_claim(f"{declared.table.name}/{case.structure}/{case.subject}")
    return describe_claim(f"queries/{case.structure}/memory")


def pair_cases(before: Run, after: Run) -> list[Pair]:
    """A pair for every case of either, and for those that the second run skipped."""
    old, new, skipped = (_by_id(rows) for rows in (before.cases, after.cases, after.skipped))
    pairs = []
    for key in sorted({*old, *new, *skipped}):
        row = new.get(key) or old.get(key) or skipped[key]
        why = str(skipped[key]["skipped"]) if key in skipped else ""
        pairs.append(Pair(_case_of(row), Kind(row["kind"]), old.get(key), new.get(key), why))
    return pairs


def _by_id(cases: Any) -> dict[tuple[str, ...], Row]:
    return {
        (row["experiment"], row["structure"], row["id"]): row for row in cases.to_dict("records")
    }


def _case_of(row: Row) -> CaseKey:
    texts = (row[name] for name in ("experiment", "structure", "subject", "family"))
    numbers = (row[name] for name in ("faces", "valence", "reference_bytes"))
    faces, valence, reference_bytes = (int(it) if it and it == it else 0 for it in numbers)
    words = [it if isinstance(it, str) else "" for it in (*texts, row["order"])]  # NaN: none
    experiment, structure, subject, family, order = words
    return CaseKey(experiment, structure, subject, family, faces, valence, order, reference_bytes)


def skip_objects(pairs: list[Pair], before: Run, after: Run) -> tuple[list[Pair], list[str]]:
    """The pairs without the bytes of Python's own objects, where Pythons differ; and a note."""
    was, now = (str((it.meta.get("versions") or {}).get("python", "")) for it in (before, after))
    if was.rpartition(".")[0] == now.rpartition(".")[0]:
        return pairs, []
    note = f"Python {now}, the baseline has {was}: the bytes of its objects are not compared"
    return [it for it in pairs if it.kind != Kind.BYTES or not _is_of_objects(it.case)], [note]


def _is_of_objects(case: CaseKey) -> bool:
    """Whether Python's own objects are weighed, which take other sizes in other versions."""
    return case.structure in NAMED and not NAMED[case.structure].compiled

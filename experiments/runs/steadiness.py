"""How steady the machine was during a run, over its timed cases."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from experiments.harness import disturbed
from experiments.harness.steadiness import BUSY
from experiments.runs.run import Run


@dataclass(frozen=True)
class Noise:
    """How steady the machine was during a run, over its timed cases.

    ``cases``: how many said so; ``disturbed``: how many were even when they were repeated;
    ``repeated``: how many were measured more than once; ``probe_spread``: the 90th percentile of
    the probes over their fastest, less one; ``worst``: the processes with most disturbed cases.
    """

    cases: int
    disturbed: int
    repeated: int
    probe_spread: float
    worst: dict[str, int] = field(default_factory=dict)

    @property
    def share(self) -> float:
        """The disturbed part of the timed cases."""
        return self.disturbed / max(self.cases, 1)

    @property
    def too_busy(self) -> bool:
        """Whether the machine was too busy to judge by time."""
        return self.share > BUSY

    @property
    def words(self) -> str:
        """All that in a sentence or two."""
        if not self.cases:
            return "The run timed nothing that could be disturbed."
        found = (
            f"{self.disturbed:,} of {self.cases:,} timed cases ({self.share:.0%}) were disturbed, "
            f"{self.repeated:,} were repeated; a fixed loop took up to {self.probe_spread:.0%} "
            "longer than at its fastest in nine of ten probes."
        )
        if not self.too_busy:
            return f"The machine was steady: {found}"
        most = ", ".join(f"{name} ({count})" for name, count in self.worst.items())
        return f"The machine was too busy to judge by time: {found} Most: {most}."


def noise(run: Run) -> Noise:
    """How steady the machine was during a run; no cases for runs that did not watch."""
    cases = run.cases
    timed = cases[(cases["kind"] == "time") & cases["noise"].map(bool)]
    seen = list(timed["noise"])
    bad = timed[[disturbed(it) for it in seen]] if seen else timed
    names = (bad["experiment"] + " on " + bad["structure"]).value_counts().head(3)
    return Noise(
        cases=len(seen),
        disturbed=len(bad),
        repeated=sum(it.get("measured", 1) > 1 for it in seen),
        probe_spread=_spread(seen),
        worst={str(name): int(count) for name, count in names.items()},
    )


def _spread(seen: list[dict[str, Any]]) -> float:
    if not seen:
        return 0.0
    over = [it[when] / it["fastest"] - 1 for it in seen for when in ("before", "after")]
    return float(np.quantile(over, 0.9))

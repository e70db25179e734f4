"""Does a measured cost grow as claimed? NumPy alone is needed.

`judge(sizes, samples, "O(log n)")` gives a `Verdict`: consistent, violated or undetermined, and
the reason. `measure(f, make_input).judge("O(n)")` measures a function first.
"""

from hem.complexity.estimates import slope
from hem.complexity.files import Curve, read_curves
from hem.complexity.judge import MIN_SIZES, Bound, Outcome, Verdict, judge
from hem.complexity.measure import BUDGET, measure
from hem.complexity.measured import InParts, Measured
from hem.complexity.models import MODELS, NAMES
from hem.complexity.notation import canonical, parse

__all__ = [
    "BUDGET", "MIN_SIZES", "MODELS", "NAMES", "Bound", "Curve", "InParts", "Measured", "Outcome",
    "Verdict", "canonical", "judge", "measure", "parse", "read_curves", "slope",
]  # fmt: skip

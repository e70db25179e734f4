"""Does a measured cost grow as claimed? NumPy alone is needed.

`judge(sizes, samples, "O(log n)")` gives a `Verdict`: consistent, violated or undetermined, and
the reason.
"""

from hem.complexity.estimates import slope
from hem.complexity.judge import Bound, Outcome, Verdict, judge
from hem.complexity.models import MODELS, NAMES
from hem.complexity.notation import canonical, parse

__all__ = ["MODELS", "NAMES", "Bound", "Outcome", "Verdict", "canonical", "judge", "parse", "slope"]

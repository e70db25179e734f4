"""Which experiments there are: every ``bench_*.py``, by its declaration."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from pkgutil import iter_modules

import experiments as package
from experiments.harness import Experiment, Table


@lru_cache(maxsize=1)
def experiments() -> dict[str, Experiment]:
    """Every experiment by the name of its file, in the order of a study.

    Raises ValueError naming the file that declares none, or one with another's table.
    """
    names = [it.name for it in iter_modules(package.__path__) if it.name.startswith("bench_")]
    declared = {name: _declared(name) for name in names}
    return dict(sorted(declared.items(), key=lambda it: (it[1].turn, it[0])))


def tables() -> dict[str, Table]:
    """Every table that an experiment decides claims of, by name."""
    return {it.table.name: it.table for it in experiments().values() if it.table is not None}


def _declared(name: str) -> Experiment:
    module = import_module(f"experiments.{name}")
    declared = getattr(module, "EXPERIMENT", None)
    if not isinstance(declared, Experiment):
        raise ValueError(
            f"{module.__file__} declares no experiment: it needs EXPERIMENT = Experiment(…), "
            "see experiments/harness/experiment.py"
        )
    if declared.module != module.__name__:
        raise ValueError(
            f"{module.__file__}: the cases of EXPERIMENT are those of {declared.module}"
        )
    return declared

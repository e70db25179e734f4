"""Which experiments there are: every ``bench_*.py``, by its declaration."""

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

import experiments as package
from experiments import carried
from experiments.harness import Experiment, Table

PART_OF = {"bench_valence": "bench_queries"}
"""Experiments that are a part of another by now: older runs have them, and commands may say so."""


@cache
def experiments() -> dict[str, Experiment]:
    """Every experiment by file, in a study's order; ValueError names one that lacks something."""
    declared: dict[str, Experiment] = {}
    for name in (it.name for it in iter_modules(package.__path__) if it.name.startswith("bench_")):
        module = import_module(f"experiments.{name}")
        experiment = getattr(module, "EXPERIMENT", None)
        if not isinstance(experiment, Experiment):
            raise ValueError(
                f"{module.__file__} declares no experiment: it needs EXPERIMENT = Experiment(…), "
                "see experiments/harness/experiment.py"
            )
        if experiment.name != name:
            raise ValueError(f"{module.__file__}: EXPERIMENT has the cases of {experiment.name}")
        tests = [it for called, it in vars(module).items() if called.startswith("test_")]
        if experiment.test not in tests:
            raise ValueError(
                f"{module.__file__} has nothing for pytest to run: it needs "
                f"{name.replace('bench', 'test', 1)} = EXPERIMENT.test"
            )
        declared[name] = experiment
    return dict(sorted(declared.items(), key=lambda it: (it[1].turn, it[0])))


def tables() -> dict[str, Table]:
    """Every table that an experiment decides claims of, by name; ValueError where they clash."""
    found: dict[str, Table] = {}
    decided: dict[tuple[str, str], str] = {}
    of_them = {name: it.table for name, it in experiments().items() if it.table}
    for experiment, table in of_them.items():
        if table.chapter and not (carried("notebooks") / f"{table.chapter}.ipynb").exists():
            raise ValueError(f"{experiment}: {table.chapter!r}, its chapter, is no notebook")
        if found.setdefault(table.name, table) != table:
            named = " and ".join(it for it, one in of_them.items() if one.name == table.name)
            raise ValueError(f"{named} have different tables called {table.name!r}")
        for axis in experiments()[experiment].axes:
            other = decided.setdefault((table.name, axis.key), experiment)
            if other != experiment:
                raise ValueError(f"{other} and {experiment} both decide {table.name} by {axis.key}")
    return found

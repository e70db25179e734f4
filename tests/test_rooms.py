"""Nobody goes past a door: what a room's ``__init__`` names is all that others import from it."""

import ast
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FILES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts): path
    for top in ("hem", "structures", "experiments")
    for path in (ROOT / top).rglob("*.py")
}
ROOMS = {name.removesuffix(".__init__") for name in FILES if name.endswith(".__init__")}
BY_FILE = {"hem", "structures", "experiments.peers.libraries", "experiments.report.figures"}
"""Where each file is a thing of its own, and asked for by its name."""


def past_doors(name: str) -> list[str]:
    """What a module imports from within other rooms, beside what their doors name."""
    room, found = name.rpartition(".")[0], []
    for it in ast.walk(ast.parse(FILES[name].read_text("utf-8"))):
        if isinstance(it, ast.Import):  # by its whole name a file is seen from anywhere
            whole = (one.name for one in it.names if one.name not in ROOMS and one.name in FILES)
            found += [one for one in whole if one.rpartition(".")[0] not in BY_FILE]
        if not isinstance(it, ast.ImportFrom) or not it.module or it.level:
            continue
        if it.module in ROOMS:
            if "." not in it.module or f"{room}.".startswith(f"{it.module}."):
                continue
            door = import_module(it.module)
            public = getattr(door, "__all__", None) or vars(door)
            named = {*public, *(door.__doc__ or "").split("`")}
            found += [
                f"{it.module}.{one.name}"
                for one in it.names
                if one.name not in named and f"{it.module}.{one.name}" not in ROOMS
            ]
        elif it.module in FILES:
            other = it.module.rpartition(".")[0]
            if other not in BY_FILE and not f"{room}.".startswith(f"{other}."):
                found.append(it.module)
    return found


@pytest.mark.parametrize("top", ["hem", "structures", "experiments"])
def test_others_import_from_a_room_and_not_from_its_files(top: str) -> None:
    past = {name: past_doors(name) for name in FILES if name.partition(".")[0] == top}
    assert not {name: found for name, found in past.items() if found}


LONG = {
    "cli/advise.py: advise": "half of it are the options and the help of the command",
    "cli/study.py: run_study": "the same",
    "algorithms/collapsing.py: simplifying": "one compiled loop, with a way out at every step",
    "operations/collapse_edge.py: rule": "every reason to refuse, in the order of what they cost",
    "complexity/files.py: read_curves": "every mistake of a file is told in words of its own",
    "complexity/judge.py: judge": "half of it says what its options mean",
    "complexity/measure.py: measure": "the same",
    "bodies/voronoi.py: voronoi": "the same, and what is counted",
}
"""The functions of more than 40 lines, help included, and why each is left so."""


def test_functions_are_short_but_for_some_that_have_a_reason() -> None:
    found = {
        f"{path.parent.name}/{path.name}: {it.name}"
        for path in FILES.values()
        for it in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(it, ast.FunctionDef) and (it.end_lineno or 0) - it.lineno >= 40
    }
    assert found == LONG.keys()

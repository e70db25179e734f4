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

"""What holds of every command: help with an example, completion, JSON where a program may read."""

import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command
from typer.testing import CliRunner

import hem
from experiments.advice import NEEDS
from experiments.advice import PRESETS as WORKLOADS
from experiments.cli import app
from experiments.cli.study import EXPERIMENTS
from experiments.presets import PRESETS
from experiments.runs import experiments
from structures import NAMED, NAMES, REGISTRY

runner = CliRunner()
ROOT: Any = get_command(app)


def commands(group: Any = ROOT, path: tuple[str, ...] = ()) -> dict[tuple[str, ...], Any]:
    """Every command that does something, by the words that it is called with."""
    found: dict[tuple[str, ...], Any] = {}
    for name, command in group.commands.items():
        inside = hasattr(command, "commands")
        found |= commands(command, (*path, name)) if inside else {(*path, name): command}
    return found


EVERY = commands()
SHOWN = {path: it for path, it in EVERY.items() if path[0] != "reference"}  # an old word
READABLE = {path for path, it in SHOWN.items() if any("--json" in p.opts for p in it.params)}


@pytest.mark.parametrize("path", SHOWN, ids=" ".join)
def test_help_says_what_a_command_does_and_shows_an_example_that_is_one(path):
    done = runner.invoke(app, [*path, "--help"])
    assert done.exit_code == 0
    command = SHOWN[path]
    for parameter in command.params:
        assert parameter.name == "help" or parameter.help, parameter.name
    examples = re.findall(r"(?m)^ *Example: `hem (.+)`$", command.help)
    assert examples
    assert "Example: hem " in done.stdout
    for example in examples:
        words = shlex.split(example)
        assert tuple(words[: len(path)]) == path
        assert command.make_context("hem", words[len(path) :]).params


def test_the_help_of_a_study_tells_how_much_each_preset_measures():
    told = " ".join(runner.invoke(app, ["study", "--help"]).stdout.split())
    for name, preset in PRESETS.items():
        assert f"{name}: {preset.what}" in told


def complete(*words: str) -> list[str]:
    """What bash is offered for the last of the words."""
    asked = {"_HEM_COMPLETE": "complete_bash", "COMP_WORDS": " ".join(("hem", *words))}
    asked["COMP_CWORD"] = str(len(words))
    done = runner.invoke(app, [], prog_name="hem", env=asked)
    return done.stdout.split()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["che"], ["check"]),
        (["study", "--preset", ""], PRESETS),
        (["study", "--structure", ""], NAMED),
        (["study", "--mesh", "bun"], ["bunny"]),
        (["study", "--experiment", "bu"], ["build"]),
        (["advise", "--workload", ""], WORKLOADS),
        (["advise", "--need", ""], NEEDS),
        (["check", "--structure", "winged"], [it for it in NAMED if it.startswith("winged")]),
        (["info", ""], [*hem.SAMPLES, *hem.FAMILIES]),
        (["fracture", "bunny", "--material", "gl"], ["glass"]),
    ],
)
def test_a_shell_is_offered_the_names_that_there_are(words, offered):
    assert set(complete(*words)) == set(offered)


def test_the_experiments_that_a_shell_is_offered_are_those_that_there_are():
    assert {f"bench_{it}" for it in EXPERIMENTS} == set(experiments())


def test_a_shell_is_offered_every_command():
    assert set(complete("")) == {path[0] for path in SHOWN}


def test_programs_can_read_what_tells_of_runs_and_meshes():
    told = {"table", "info", "meshes", "check", "judge", "advise"}
    assert {path[0] for path in READABLE} >= told
    assert ("history", "show") in READABLE


def printed(*arguments: str) -> Any:
    done = runner.invoke(app, arguments)
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_info_in_json_says_what_the_structures_say(tmp_path: Path):
    mesh = hem.generate("torus", 400)
    told = printed("info", "torus:400", "--json")
    assert (told["vertices"], told["faces"]) == (len(mesh.points), len(mesh.triangles))
    assert [it["name"] for it in told["structures"]] == list(NAMES)
    for row in told["structures"]:
        assert row["bytes"] == sum(REGISTRY[row["name"]].build(mesh, 4).memory().values())
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    rows = printed("info", str(tmp_path / "quad.obj"), "--json")["structures"]
    assert {it["name"] for it in rows if it["bytes"]} == {
        name for name in NAMES if REGISTRY[name].holds_polygons
    }
    assert all((it["bytes"] is None) == bool(it["refusal"]) for it in rows)


def test_meshes_in_json_lists_every_family_and_model():
    told = printed("meshes", "--size", "400", "--json")
    assert {it["name"] for it in told["families"]} == set(hem.FAMILIES)
    assert {it["name"]: it["faces"] for it in told["models"]} == {
        name: len(hem.sample(name).triangles) for name in hem.SAMPLES
    }


def test_the_table_in_json_has_what_the_terminal_shows(base_folder):
    told = printed("table", str(base_folder), "--json", "--all")
    assert told["run"] == base_folder.name
    shown = runner.invoke(app, ["table", str(base_folder), "--all"]).stdout
    titles = {it["title"] for it in told["claims"]}
    assert all(title in shown for title in titles)
    some = printed("table", str(base_folder), "--json")["claims"]
    assert 0 < len(some) < len(told["claims"])
    shown = runner.invoke(app, ["table", str(base_folder), "--all", "--slopes"]).stdout
    for axis in (axis for it in told["claims"] for axis in it["axes"]):
        low, high = (f"{round(axis[key], 2) + 0:.2f}" for key in ("slope_low", "slope_high"))
        assert f"{low}…{high}" in shown

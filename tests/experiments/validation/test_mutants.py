"""Faults to inject: each still fits the sources, and a wrong one is an error."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.validation.mutants import GATES, copied_tree, load_mutants
from tests.extent import exhaustive

HERE = Path(__file__).parents[3]
ENTRY = """
[none]
structure = "half_edge"
gate = "{gate}"
file = "hem/authoring/records.py"
old = "{old}"
new = "another text"
"""


@pytest.mark.parametrize("mutant", load_mutants(), ids=lambda mutant: mutant.name)
def test_every_fault_changes_the_source_it_is_for(mutant, tmp_path):
    path = tmp_path / mutant.file
    path.parent.mkdir(parents=True)
    shutil.copy(HERE / mutant.file, path)
    mutant.apply(tmp_path)
    assert path.read_text() != (HERE / mutant.file).read_text()
    compile(path.read_text(), mutant.file, "exec")


ASK = """
import hem, structures
from hem.contract import QUERIES
s = structures.build({name!r}, hem.generate("torus", 200))
for query in QUERIES.values():
    getattr(s, query.name)(int(s.handles(query.source)[0]))
"""


@exhaustive
@pytest.mark.parametrize("mutant", load_mutants(), ids=lambda mutant: mutant.name)
def test_every_fault_can_be_compiled(mutant, tmp_path):
    """What cannot is caught by nothing: it cannot even be measured."""
    for room in ("hem", "structures"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(HERE / room, tmp_path / room, ignore=ignored)
    mutant.apply(tmp_path)
    code = ASK.format(name=mutant.structure)
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr[-2000:]


@exhaustive
def test_the_copy_has_all_that_the_gate_reads():
    """Else it refuses every fault alike, and the copy without one."""
    command = [sys.executable, "-m", "experiments.cli", "check", "--structure", "indexed"]
    with copied_tree() as tree:
        done = subprocess.run(command, cwd=tree, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_there_is_a_fault_for_every_gate():
    assert {mutant.gate for mutant in load_mutants()} == set(GATES)


def test_a_fault_that_no_longer_fits_is_an_error(tmp_path):
    (mutant,) = load_mutants(ENTRY.format(gate="work", old="no such text"))
    with pytest.raises(ValueError, match=r"0 times in hem/authoring/records\.py"):
        mutant.apply(tmp_path)


def test_a_gate_that_does_not_exist_is_an_error():
    with pytest.raises(ValueError, match="no gate is called 'luck'"):
        load_mutants(ENTRY.format(gate="luck", old="x"))

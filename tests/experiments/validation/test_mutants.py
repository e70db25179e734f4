"""Faults to inject: each still fits the sources, and a wrong one is an error."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from experiments.validation.mutants import GATES, MutantError, load_mutants

HERE = Path(__file__).parents[3]
ENTRY = """
[[mutant]]
name = "none"
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


def test_there_is_a_fault_for_every_gate():
    assert {mutant.gate for mutant in load_mutants()} == set(GATES)


def test_a_fault_that_no_longer_fits_is_an_error(tmp_path):
    (mutant,) = load_mutants(ENTRY.format(gate="work", old="no such text"))
    with pytest.raises(MutantError, match=r"0 times in hem/authoring/records\.py"):
        mutant.apply(tmp_path)


def test_a_gate_that_does_not_exist_is_an_error():
    with pytest.raises(MutantError, match="no gate is called 'luck'"):
        load_mutants(ENTRY.format(gate="luck", old="x"))

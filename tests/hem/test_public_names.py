"""The door of ``hem``: its names, and how little they need."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

import hem
from hem import algorithms

ALONE = """
import sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        if top not in sys.stdlib_module_names and top not in {allowed!r}:
            raise ImportError(f"{{name}} is not to be imported")

sys.meta_path.insert(0, Blocked())
"""


def run_alone(code: str, *allowed: str) -> str:
    """What ``code`` prints in a Python that has these third-party packages alone."""
    program = ALONE.format(allowed={"hem", *allowed}) + code
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("name", hem.__all__)
def test_every_public_name_is_there(name):
    assert name in dir(hem)
    assert getattr(hem, name) is getattr(hem, name)


def test_a_name_that_is_not_public_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'generates'"):
        hem.generates  # noqa: B018


def test_importing_hem_needs_no_other_package():
    assert run_alone("import hem; print(len(hem.__all__))") == str(len(hem.__all__))


def test_the_judge_needs_numpy_alone():
    code = "from hem.complexity import judge; print(judge.__name__)"
    assert run_alone(code, "numpy") == "judge"


@pytest.mark.parametrize("name", algorithms.__all__)
def test_every_algorithm_says_what_it_costs_and_where_it_is_from(name):
    it = getattr(algorithms, name)
    if callable(it):
        assert re.search(r"\bCost\b", it.__doc__)
        assert re.search(r"Source: (thesis \d|.* \(\d{4}\))", it.__doc__)

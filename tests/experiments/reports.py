"""A report for tests, made once: of a run that is made up."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path

from experiments.report import write
from tests.experiments.runs import write_run


@cache
def made_up() -> Path:
    """The folder of the pages of a whole report."""
    folder = Path(tempfile.mkdtemp(prefix="hem-report-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return write(write_run(folder / "run"), folder / "html").parent

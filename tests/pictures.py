"""Tests that draw are skipped where nothing can."""

from __future__ import annotations

import pytest

from hem.errors import NotInstalledError
from hem.fracture.show import load_pyvista


def require_pictures() -> None:
    """Skip the test, or all of a module, where PyVista is missing or cannot draw."""
    try:
        load_pyvista()
    except NotInstalledError as missing:
        pytest.skip(str(missing))

"""Tests that draw are skipped where nothing can."""

from __future__ import annotations

import pytest

from hem.fracture.show import PicturesMissingError, load_pyvista


def require_pictures() -> None:
    """Skip the test, or the whole module, where PyVista is missing or cannot draw."""
    try:
        load_pyvista()
    except PicturesMissingError as missing:
        pytest.skip(str(missing), allow_module_level=True)

"""A run in; figures, tables and pages out.

The chapters are the notebooks: they open a run with ``open_run`` and show the figures and tables of
this room. ``write_report`` executes them all and writes the pages, ``write_pdf`` one document,
``write_readme`` the page that is committed, and ``show_claims`` prints the claims in a terminal.
Everything is imported when it is first asked for: to draw takes heavy packages. What commands print
is asked for by the names of its files: ``findings``, ``history_tables``, ``fracture_scenes``,
``pages``.
"""

import multiprocessing
from importlib import import_module
from typing import Any

_PLACES = {
    "pages": (
        "Answer", "Html", "about_history", "about_run", "abstract", "browser", "chapter_list",
        "claim_tables", "closing", "errata", "frame_table", "legend", "reasons", "sentences",
        "slopes", "tally", "text_table", "traced", "verdicts",
    ),
    "peers": (
        "about", "beside_ours", "measured_peers", "page_table", "peers_as_json", "portraits",
        "show_peers",
    ),
    "readme": ("write_readme",),
    "rows": ("show_rows", "two_digits"),
    "session": ("MissingError", "claim_link", "link", "open_run", "project_file"),
    "site": ("write_pdf", "write_report"),
    "style": ("show_figures",),
    "tables": (
        "abbreviations", "claims_as_json", "digits", "duration", "show_claims", "table_1_in_words",
    ),
    "uses": ("advice_sliders",),
}  # fmt: skip
"""The public names by their file."""

__all__ = [name for names in _PLACES.values() for name in names]


def __getattr__(name: str) -> Any:
    """A public name, imported now.

    Where processes can be forked, one imports what they share, beside this one's own imports.
    """
    file = next((file for file, names in _PLACES.items() if name in names), "")
    if not file:
        raise AttributeError(f"experiments.report has no {name!r}")
    if file == "site" and "forkserver" in multiprocessing.get_all_start_methods():
        from multiprocessing import forkserver

        multiprocessing.set_forkserver_preload([f"{__name__}.site"])
        forkserver.ensure_running()
    return getattr(import_module(f"experiments.report.{file}"), name)

"""The report as one document to print: all pages one after another, printed by a browser."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from experiments.report.page import head

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
BROWSER_VARIABLE = "HEM_BROWSER"
"""The environment variable that names another program."""

FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--disable-extensions", "--hide-scrollbars",
)  # fmt: skip
"""A browser without a window that keeps to itself. What it opens are our own files."""

PATIENCE = 180
"""Seconds until a browser that does not print is given up."""


class PrintError(ValueError):
    """The report cannot be printed here."""


def find_browser() -> str | None:
    """The program that prints: what the environment names, or a Chromium on the path."""
    named = os.environ.get(BROWSER_VARIABLE)
    return shutil.which(named) if named else next(filter(None, map(shutil.which, BROWSERS)), None)


def browser() -> str:
    """The program that prints. Raises PrintError saying what to install."""
    found = find_browser()
    if found is None:
        raise PrintError(
            "a PDF is printed by Chromium or Chrome, and neither was found: install one (on Debian "
            f"and Ubuntu: apt install chromium), or name its program in {BROWSER_VARIABLE}; or "
            "open the report in any browser and print it from there"
        )
    return found


def printed(document: Path, output: Path) -> Path:
    """Print a page that is on disk -> ``output``. Raises PrintError with what the browser said."""
    with tempfile.TemporaryDirectory(prefix="hem-print-") as profile:
        command = [
            browser(), *FLAGS, f"--user-data-dir={profile}", "--no-pdf-header-footer",
            "--virtual-time-budget=20000", f"--print-to-pdf={output}", document.resolve().as_uri(),
        ]  # fmt: skip
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=PATIENCE, check=False
            )
        except subprocess.TimeoutExpired as late:
            raise PrintError(f"{command[0]} did not print within {PATIENCE} s") from late
    if not output.exists():
        said = done.stderr.strip()[-500:]
        raise PrintError(f"{command[0]} printed nothing (exit code {done.returncode}): {said}")
    return output


def sections(front: str, chapters: dict[str, str], claims: str, back: str) -> dict[str, str]:
    """The parts of a report in the order in which they are printed: the claims at the end."""
    return {"index": _unfolded(front), **_chapters(chapters), "all": _unfolded(claims + back)}


def document(title: str, parts: dict[str, str]) -> str:
    """The parts as one page, each on a new sheet of paper; links between them stay links."""
    shown = "\n".join(
        f'<section class="chapter" id="page-{name}">{_leading(body)}</section>'
        for name, body in parts.items()
    )
    return f"<!doctype html>\n{head(title)}\n<body><main>{shown}</main></body></html>\n"


def _chapters(chapters: dict[str, str]) -> dict[str, str]:
    """The chapters with ids that are their own: on a page each they need not be."""
    return {
        name: re.sub(r'(<[^>]*\s(?:id="|href="#))', rf"\g<1>{name}--", body)
        for name, body in chapters.items()
    }


def _leading(body: str) -> str:
    """Links to another page lead to its section; those to files beside the pages become words."""
    body = re.sub(r'href="(\w+)\.html"', r'href="#page-\1"', body)
    body = body.replace('href="index.html#', 'href="#')
    return re.sub(r'<a href="claims/[^"]*">([^<]*)</a>', r"\1", body)


def _unfolded(body: str) -> str:
    return re.sub(r"<details(?! open)", "<details open", body).replace(' loading="lazy"', "")

"""The report as one document to print: the browser prints a page with all pages on it."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
BROWSER_VARIABLE = "HEM_BROWSER"  # the environment variable that names another program
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--disable-extensions", "--hide-scrollbars",
)  # fmt: skip
"""A browser without a window that keeps to itself. What it opens are our own files."""

PATIENCE = 300  # seconds until a browser that does not print is given up


class PrintError(ValueError):
    """The report cannot be printed here."""


def find_browser() -> str | None:
    """The program that prints: what the environment names, or a Chromium on the path."""
    named = os.environ.get(BROWSER_VARIABLE)
    return shutil.which(named) if named else next(filter(None, map(shutil.which, BROWSERS)), None)


def require_browser() -> str:
    """The program that prints. Raises PrintError saying what to install."""
    if browser := find_browser():
        return browser
    raise PrintError(
        "a PDF is printed by Chromium or Chrome, and neither was found: install one (on Debian and "
        f"Ubuntu: apt install chromium), or name its program in {BROWSER_VARIABLE}; or open the "
        "report in any browser and print it from there"
    )


def print_pdf(page: Path, output: Path) -> Path:
    """Print a page that is on disk -> ``output``. Raises PrintError with what the browser said."""
    with tempfile.TemporaryDirectory(prefix="hem-print-", ignore_cleanup_errors=True) as profile:
        command = [
            require_browser(), *FLAGS, f"--user-data-dir={profile}", "--no-pdf-header-footer",
            "--generate-pdf-document-outline", "--virtual-time-budget=20000",
            f"--print-to-pdf={output}", page.resolve().as_uri(),
        ]  # fmt: skip
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        except subprocess.TimeoutExpired as late:
            raise PrintError(f"{command[0]} did not print within {PATIENCE} s") from late
    if not output.exists():
        said = done.stderr.strip()[-500:]
        raise PrintError(f"{command[0]} printed nothing (exit code {done.returncode}): {said}")
    return output

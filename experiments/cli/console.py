"""Where the commands print, and how they tell a user's mistakes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import typer
from rich.console import Console
from rich.markup import escape

console = Console()
errors = Console(stderr=True)


@contextmanager
def user_errors() -> Iterator[None]:
    """Turn what a user can mend into one line and exit code 1: what is missing here, too."""
    try:
        yield
    except (ValueError, OSError, ImportError) as error:
        errors.print(f"[bold red]hem:[/] {escape(str(error))}", highlight=False, soft_wrap=True)
        raise typer.Exit(1) from error

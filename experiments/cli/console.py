"""What the commands share: where they print, which run they mean, how they tell mistakes."""

import json
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from io import TextIOWrapper
from itertools import chain
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from typer import Argument, Option
from typer.core import TyperGroup

if os.environ.get("COLUMNS") == "0":  # nobody knows the width, and rich would print nothing
    del os.environ["COLUMNS"]


console = Console(highlight=False)
CLOSED = 141  # exit code where nobody reads on, as a shell has it
errors = Console(stderr=True, highlight=False, soft_wrap=True)


def completed(module: str, *names: str) -> Callable[[str], list[str]]:
    """What completes a word to names of a module, which is imported when a shell asks."""

    def complete(incomplete: str) -> list[str]:
        known = chain(*(getattr(import_module(module), it) for it in names))
        return [it for it in known if it.startswith(incomplete)]

    return complete


AsJson = Annotated[bool, Option("--json", help="Print JSON instead.")]
RunArgument = Annotated[
    Path | None, Argument(help="The folder of a run; the newest if it is not given.")
]
Structures = Annotated[
    list[str] | None, Option(
        "--structure", help="Measure just this one; may be repeated.",
        autocompletion=completed("structures", "NAMED"),
    ),
]  # fmt: skip
OfMesh: dict[str, Any] = {
    "help": "A mesh file, a model (bunny), or a family and size (sphere:2000).",
    "autocompletion": completed("hem.sources", "SAMPLES", "FAMILIES"),
}
"""What a mesh is named by."""
Repair = Annotated[bool, Option("--repair", help="Repair what is not manifold first.")]


def print_json(content: Any) -> None:
    """For other programs, in UTF-8 and on standard output; NaN and infinity as null."""
    strict = json.loads(json.dumps(content), parse_constant=lambda _: None)
    text = json.dumps(strict, indent=1, ensure_ascii=False)
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(encoding="utf-8")
    sys.stdout.write(text + "\n")


def run_folder(run: Path | None) -> Path:
    """The folder that was given, or the newest run's. Raises ValueError if there is none."""
    if run is None:
        from experiments.runs import latest

        return latest()
    if not run.is_dir():  # told before anything heavy is imported
        raise ValueError(f"{run} holds no run: there is no such folder; make one with: hem study")
    return run


@contextmanager
def user_errors(code: int = 1) -> Iterator[None]:
    """Turn what a user can mend into a line and an exit code; all errors, where it is not 1."""
    try:
        yield
    except (BrokenPipeError, SystemExit) as error:  # whoever read, `| head`, has what he wants
        # Rich makes it an exit with 1, which some commands mean.
        if BrokenPipeError not in (type(error), type(error.__context__)):
            raise
        with suppress(OSError):  # for what is left to print, if it is a file at all
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(CLOSED) from None
    except (ValueError, OSError, ImportError) as error:
        told: object = error
        if isinstance(error, OSError) and error.filename is not None:
            told = f"{error.filename}: {error.strerror}"
        errors.print(f"[bold red]hem:[/] {escape(str(told))}")
        raise typer.Exit(code) from error
    except Exception as error:
        if code == 1 or isinstance(error, typer.Exit):
            raise
        errors.print(f"hem: it could not be done: {error!r}", markup=False)
        raise typer.Exit(code) from error


class Commands(TyperGroup):
    """Commands that tell a user's mistakes, and what is warned of, in one line each."""

    def make_context(self, *args: Any, **more: Any) -> Any:
        """Read the command line, and print the help that it asks for."""
        with user_errors():
            return super().make_context(*args, **more)

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        for stream in (sys.stdout, sys.stderr):  # a sign that a terminal lacks loses no verdict
            if isinstance(stream, TextIOWrapper):
                stream.reconfigure(errors="replace")
        with user_errors(), warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: errors.print(
                f"[bold yellow]hem:[/] {escape(str(message))}"
            )
            return super().invoke(ctx)

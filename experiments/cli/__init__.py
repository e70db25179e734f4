"""The command line: ``hem study``, ``table``, ``report``, ``meshes``, ``info``, ``fracture``,
``check``, ``baseline update``, ``history``, ``judge``, ``advise``.

A command imports what it needs when it is run, so that help and mistakes are quick.
"""

from importlib.metadata import version
from pathlib import Path
from typing import Annotated

try:
    import typer
    from typer import Option
except ModuleNotFoundError as error:  # the library alone was installed
    raise SystemExit("hem: the commands need more: pip install 'hem-mesh[study]'") from error

from experiments.cli.advise import advise
from experiments.cli.check import baseline_app, check
from experiments.cli.console import AsJson, Commands, RunArgument, console, print_json, run_folder
from experiments.cli.fracture import fracture
from experiments.cli.history import history
from experiments.cli.judge import judge_file
from experiments.cli.meshes import info, meshes
from experiments.cli.study import PRESETS_TOLD, run_study

app = typer.Typer(
    cls=Commands,
    help="Triangle-mesh data structures, measured and held against what a thesis claims of them.",
    no_args_is_help=True,
    rich_markup_mode="markdown",  # which fills the lines of a paragraph
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
PAGE, PAGES, DOCUMENT = Path("report"), Path("report/html"), Path("report/report.pdf")
"""Where the report goes."""


@app.callback(invoke_without_command=True)
def _options(show_version: Annotated[bool, Option("--version", help="Say which.")] = False) -> None:
    if show_version:
        console.print(f"hem {version('hem-mesh')}")
        raise typer.Exit


app.command("study", epilog=PRESETS_TOLD)(run_study)


@app.command("table")
def show_table(
    run: RunArgument = None,
    every: Annotated[bool, Option("--all", help="All structures, and the listings.")] = False,
    slopes: Annotated[bool, Option("--slopes", help="The slopes and their intervals.")] = False,
    peers: Annotated[bool, Option("--peers", help="Other libraries beside ours.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print what the thesis claims of each structure, with the verdicts of a run.

    With --peers what was measured of other libraries, by `hem study --peers`.

    Example: `hem table --all --slopes`
    """
    from experiments import report

    if peers and (every or slopes):
        raise ValueError("--all and --slopes are of our structures; leave them out with --peers")
    folder = None if peers and run is None else run_folder(run)
    if peers and as_json:
        print_json(report.peers_as_json(folder))
    elif peers:
        report.show_peers(folder, console)
    elif as_json:
        print_json(report.claims_as_json(run_folder(run), every))
    else:
        report.show_claims(run_folder(run), console, every, slopes)


@app.command("report")
def write_report(
    run: RunArgument = None,
    output: Annotated[
        Path | None,
        Option(help=f"Where it goes. Default: {PAGES}, with --pdf {DOCUMENT}, with --page {PAGE}."),
    ] = None,
    page: Annotated[
        bool,
        Option("--page", help="Just the page that is committed, and README.md beside its folder."),
    ] = False,
    pdf: Annotated[bool, Option("--pdf", help="One document to print; needs Chromium.")] = False,
) -> None:
    """Run the notebooks on a run and write the report: pages that open from disk.

    Example: `hem report results/runs/NAME --output pages`
    """
    if page and pdf:
        raise ValueError("--page and --pdf write different things; ask for one of them")
    folder = run_folder(run)
    from experiments import report

    if page:
        done = f"Page written: {report.write_readme(folder, output or PAGE)}"
    elif pdf:
        done = f"Document written: {report.write_pdf(folder, output or DOCUMENT)}"
    else:
        front = report.write_report(folder, output or PAGES)
        done = f"Report written. Open {front.resolve().as_uri()}"
    console.print(done, markup=False, soft_wrap=True)


for command in (meshes, info, advise, fracture):
    app.command()(command)
app.add_typer(history, name="history")
app.command()(check)
app.command("judge")(judge_file)
app.add_typer(baseline_app, name="baseline")
app.add_typer(baseline_app, name="reference", hidden=True)

"""``hem study``: measure every structure, resume after anything, say whether time can be judged."""

import shlex
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any

import typer
from rich.markup import escape
from typer import Option

from experiments import presets, require_known
from experiments.cli.console import OfMesh, Repair, Structures, completed, console, errors
from experiments.presets import PRESETS

DEFAULT = "quick"  # the preset of a study that names none
FILES = Path(__file__).parents[1].glob("bench_*.py")
EXPERIMENTS = sorted(it.stem.removeprefix("bench_") for it in FILES)  # without importing them
PRESETS_TOLD = "\n".join(["Presets:\n", *(f"- {name}: {it.what}" for name, it in PRESETS.items())])
MESH_TOLD = (
    f"Measure on this mesh, and on versions of it: up to {presets.COARSER} coarser ones, down to "
    f"{presets.SMALLEST} vertices; finer ones up to {presets.FINE_ENOUGH:,} vertices, or one up to "
    f"{presets.LARGEST:,}. Accesses are counted up to {presets.LARGEST_COUNTED:,}."
)


# fmt: off
def run_study(
    preset: Annotated[str | None, Option(
        "--preset", "--profile", help=f"How much, see below. Default: {DEFAULT}.",
        autocompletion=completed("experiments.presets", "PRESETS"))] = None,
    resume: Annotated[bool, Option("--resume", help="Resume the newest unfinished run.")] = False,
    run: Annotated[Path | None, Option(help="With --resume: which, finished or not.")] = None,
    output: Annotated[Path | None, Option(
        help="Where the runs are kept (results/runs, peers in it).")] = None,
    structure: Structures = None,
    experiment: Annotated[list[str] | None, Option(
        help="Run just this one; may be repeated.",
        autocompletion=completed(__name__, "EXPERIMENTS"))] = None,
    peers: Annotated[bool, Option(
        "--peers", help="Other libraries beside ours, and nothing else.")] = False,
    mesh: Annotated[str | None, Option(
        **OfMesh | {"help": MESH_TOLD})] = None,
    repair: Repair = False,
    seed: Annotated[int | None, Option(help="Of the order of the cases.")] = None,
    pin: Annotated[bool | None, Option(help="Whether to stay on one core (yes).")] = None,
    workers: Annotated[str | None, Option(help="A Dask scheduler, tcp://host:port.")] = None,
) -> None:
    # fmt: on
    """Measure every structure. The results go to a new folder, case by case.

    With --mesh on a mesh of your own, coarser and finer versions of it, where a slope is wanted: a
    file, a model (bunny), or a family and size (sphere:2000). Structures that cannot hold it are
    skipped.

    With --peers other libraries, as many as are installed; the extra peers has them.

    A case that would not fit into memory is skipped and says so; HEM_MEMORY=8G pretends that there
    is so much.

    Example: `hem study --mesh model.ply --structure half_edge`
    """
    if run and not resume:
        raise ValueError(f"to resume {run}, say --resume as well")
    require_known("preset", [preset or DEFAULT], PRESETS)  # before anything heavy is imported
    from experiments.harness import memory
    from experiments.runs import PEER_RUNS, RUNS, cluster, experiments, latest, study

    memory.available()  # whether HEM_MEMORY can be read
    if peers and mesh is not None:
        raise ValueError("other libraries are measured on meshes of their own: leave out --mesh")
    if workers is not None:
        if mesh is not None:
            raise ValueError("--mesh is measured on this machine: leave out --workers")
        cluster.require(workers)
    if repair and mesh is None:
        raise ValueError("--repair is about a mesh: say --mesh as well")
    output = output or (PEER_RUNS if peers else RUNS)
    if peers and not resume:
        experiment = [*(experiment or []), *_other_libraries(structure)]
    options: dict[str, Any] = {"preset": preset, "seed": seed, "pin": pin}
    options |= {"structures": structure, "experiments": experiment}
    given = {key: it for key, it in options.items() if it not in (None, [])}
    if resume:
        if mesh is not None:
            raise ValueError("a run is resumed on the mesh it was begun with: leave out --mesh")
        folder = run or latest(output, unfinished=True)
        _require_as_begun(folder, given, workers)
    else:
        given |= {"mesh": mesh, "repair": repair}
        folder = study.begin(given.pop("preset", DEFAULT), output, **given)
    chosen = [experiments()[it] for it in study.begun(folder)["experiments"]]
    of_peers = any(it.by_name for it in chosen)
    in_tables = not chosen or any(it.table or it.kind == "bytes" for it in chosen)
    there = PEER_RUNS if of_peers else RUNS  # where the commands look
    named = "" if output == there and not run else f" {shlex.quote(str(folder))}"
    commands = ["hem table --peers"] if of_peers else [*["hem table"] * in_tables, "hem report"]
    _measure(folder, workers, ", ".join(f"{it}{named}" for it in commands))


def _other_libraries(chosen: list[str] | None) -> list[str]:
    """The experiments on libraries; names what is not installed. ValueError if all is."""
    from experiments.peers import OURS, PEERS, installed, missing
    from experiments.runs import experiments

    require_known("library", chosen or [], PEERS)
    for title, command in missing(chosen or PEERS).items():
        errors.print(f"{title} is not installed, and skipped ({command})")
    if not set(installed()) & set(chosen or PEERS) - {OURS}:
        raise ValueError("none of these libraries is installed")
    return [name for name, it in experiments().items() if it.by_name]


def _require_as_begun(folder: Path, given: dict[str, Any], workers: str | None) -> None:
    """Raise ValueError for options that would change how a run was begun."""
    from experiments.runs import study

    meta = study.begun(folder)
    meta["preset"] = study.preset_of(meta)
    if "experiments" in given:
        given["experiments"] = study.called(given["experiments"])
    for key, value in given.items():
        if value != meta[key]:
            option = "no-pin" if key == "pin" and not value else key.removesuffix("s")
            raise ValueError(f"{folder} is resumed as it was begun: leave out --{option}")
    if not workers and any(folder.glob("machine-*")):
        raise ValueError(f"{folder} is of a cluster: resume it with --workers tcp://…")


def _measure(folder: Path, workers: str | None, now: str) -> None:
    """Measure what a run lacks, and say how it went and what to do ``now``."""
    from experiments.cli.progress import show_progress
    from experiments.runs import CannotWriteError, cluster, load, noise, resume_command, study

    begin = perf_counter()
    resuming = resume_command(folder) + (f" --workers {workers}" if workers else "")
    console.print(f"Measuring into {folder}", markup=False, soft_wrap=True)
    try:
        with show_progress(study.plan(folder), folder) as observer:
            if workers:
                cluster.run(folder, workers, observer)
            else:
                study.run(folder, observer)
    except KeyboardInterrupt:
        told = f"Stopped. What is finished is in {folder}; resume with: {resuming}"
        errors.print(told, markup=False)
        raise typer.Exit(130) from None
    except study.StudyFailedError as failure:
        errors.print(f"[bold red]Some cases failed.[/] Try them again with: {escape(resuming)}\n")
        errors.print(str(failure), markup=False)
        raise typer.Exit(1) from None
    except CannotWriteError as error:
        raise ValueError(f"{error}. What is finished is kept; resume with: {resuming}") from error
    run = load(folder)
    if len(run.skipped):
        console.print(f"{len(run.skipped)} cases were skipped; hem report says which and why.")
    seen = noise(run)
    console.print(seen.words, style="yellow" if seen.too_busy else None)
    done = f"Done in {perf_counter() - begin:.0f} s. Now: {now}"
    console.print(done, markup=False, soft_wrap=True)

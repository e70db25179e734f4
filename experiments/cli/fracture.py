"""The command ``hem fracture``: break a model, and keep pieces, pictures and numbers."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from experiments.cli.console import console, errors, user_errors

Size = tuple[int, int]


def fracture(
    model: Annotated[
        str,
        typer.Argument(help="A mesh file, a model (bunny), or a family and size (sphere:2000)."),
    ],
    impact: Annotated[
        str | None,
        typer.Option(help="Where it is struck: x,y,z. Default: left of the middle, in view."),
    ] = None,
    direction: Annotated[
        str | None, typer.Option(help="Where the blow goes: x,y,z. Default: into the surface.")
    ] = None,
    material: Annotated[
        str, typer.Option(help="What it is of: glass, ceramic, stone, wood, ice.")
    ] = "glass",
    materials: Annotated[
        Path | None, typer.Option(help="A toml file of other materials to choose from.")
    ] = None,
    force: Annotated[float, typer.Option(help="How hard it is struck, in J/kg.")] = 10.0,
    method: Annotated[
        str | None,
        typer.Option(help="voronoi, tetra or surface. Default: voronoi, or surface if open."),
    ] = None,
    structure: Annotated[
        str, typer.Option(help="What holds the mesh, for tetra and surface.")
    ] = "half_edge",
    seed: Annotated[int, typer.Option(help="Other seeds, other shards.")] = 0,
    scale: Annotated[
        float, typer.Option(help="Multiply the model first; its unit is taken as a meter.")
    ] = 1.0,
    repair: Annotated[
        bool, typer.Option("--repair", help="Mend what is not manifold first.")
    ] = False,
    wrap: Annotated[
        bool, typer.Option("--wrap", help="Make a body around the model first.")
    ] = False,
    up: Annotated[
        str | None, typer.Option(help="Which axis points up: x, y or z. Default: the model's.")
    ] = None,
    format: Annotated[
        list[str] | None, typer.Option(help="glb, obj or ply; may be repeated.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="The folder to write to. Default: fractured/MODEL.")
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(help="How long the pieces fly. Default: until they rest.")
    ] = None,
    animation: Annotated[
        bool, typer.Option(help="Whether to make the animation, which takes the longest.")
    ] = True,
    size: Annotated[
        str, typer.Option(help="Of the animation, and of each half of the picture, in pixels.")
    ] = "640x480",
) -> None:
    """Break a model: pieces, a picture, an animation of them flying, and all in numbers."""
    with user_errors():
        # What can be wrong at a glance is told before anything is computed.
        where = vector(impact, "--impact")
        way = vector(direction, "--direction")
        pixels = _size(size)
        formats = _formats(format)
        known = _material(material, materials)
        _require(force, seconds, scale, up)
        folder = _folder(out, model)

        from experiments.report import fracture_scenes

        mesh, axis = fracture_scenes.model(model, wrap, scale, repair)
        axis = up or axis
        closed = fracture_scenes.is_closed(mesh)
        chosen = method or ("voronoi" if closed else "surface")
        broken = fracture_scenes.break_up(
            mesh, chosen, known, force,
            impact=where, direction=way, seed=seed, structure=structure, up=axis,
        )  # fmt: skip
        if method is None and not closed:
            console.print(f"{model} is open: its surface is broken (or a body of it, with --wrap)")
        try:
            files = _written(broken, model, folder, formats, seconds, pixels, animation)
        except KeyboardInterrupt:
            errors.print("Stopped; nothing was written.")
            raise typer.Exit(130) from None
        _say(broken, folder, files)


def vector(text: str | None, option: str) -> tuple[float, float, float] | None:
    """The three numbers of a text, ``x,y,z``. Raises ValueError that names the option."""
    if text is None:
        return None
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise ValueError(
            f"{option} is three numbers with commas between, as in 0.1,0.2,0.3, not {text!r}"
        ) from None
    if not all(abs(part) < float("inf") for part in (x, y, z)):
        raise ValueError(f"{option} is three finite numbers, not {text!r}")
    return x, y, z


def _size(text: str) -> Size:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() for part in parts):
        raise ValueError(f"--size is a width and a height in pixels, as in 640x480, not {text!r}")
    width, height = (int(part) for part in parts)
    if not (64 <= width <= 4096 and 64 <= height <= 4096 and 0.25 <= width / height <= 4):
        raise ValueError(f"--size is 64 … 4096 pixels either way and not too narrow, not {text!r}")
    return width, height


def _formats(given: list[str] | None) -> list[str]:
    from hem.fracture.files import writer

    chosen = list(dict.fromkeys(given or ["glb"]))
    for format in chosen:
        writer(format)
    return chosen


def _material(name: str, path: Path | None) -> Any:
    from hem.fracture import MATERIALS, material, materials

    return material(name, MATERIALS if path is None else MATERIALS | materials(path))


def _require(force: float, seconds: float | None, scale: float, up: str | None) -> None:
    if not 0 < force < float("inf"):
        raise ValueError(f"--force is a positive number of J/kg, not {force:g}; try 1, 10 or 100")
    if seconds is not None and not 0 < seconds <= 60:
        raise ValueError(f"--seconds is more than 0 and at most 60, not {seconds:g}")
    if not 1e-9 <= scale <= 1e9:
        raise ValueError(f"--scale is a positive number, not {scale:g}")
    if up not in (None, "x", "y", "z"):
        raise ValueError(f"--up is x, y or z, not {up!r}")


def _folder(out: Path | None, model: str) -> Path:
    from hem.fracture.files import require_writable

    folder = out or Path("fractured") / Path(model.replace(":", "-")).stem
    require_writable(folder)
    return folder


def _written(
    broken: Any,
    model: str,
    folder: Path,
    formats: list[str],
    seconds: float | None,
    pixels: Size,
    animation: bool,
) -> list[str]:
    """Make everything beside the folder and move it there at the end -> what there is."""
    from PIL import Image

    from experiments.report.fracture_scenes import enough_seconds
    from hem.fracture.files import describe, save_pieces, whole
    from hem.fracture.show.scene import still

    with whole(folder) as beside:
        stage = broken.stage()
        for format in formats:
            save_pieces(broken.fracture, beside, format, stage.up)
        numbers = describe(broken.fracture, broken.blow, broken.motion, model)
        numbers["up"] = broken.up
        numbers["held"] = broken.held
        Image.fromarray(still(stage, pixels)).save(beside / "fracture.png", optimize=True)
        if animation:
            lasts = seconds or enough_seconds(stage)
            numbers["animation"] = _animated(broken, stage, lasts, pixels, beside)
        text = json.dumps(numbers, indent=1, allow_nan=False)
        (beside / "fracture.json").write_text(text + "\n")
        return sorted(path.name for path in beside.iterdir())


def _animated(
    broken: Any, stage: Any, seconds: float, pixels: Size, folder: Path
) -> dict[str, Any]:
    from hem.fracture.show.scene import FRAMES_A_SECOND, made, save_gif

    flight = broken.flight(stage, seconds)
    slowed = len(flight.times) / FRAMES_A_SECOND / seconds
    text = f"{broken.fracture.material.name}, {broken.blow.force:g} J/kg"
    with _progress(len(flight.times)) as report:
        images = made(stage, flight, pixels, text, report)
    save_gif(images, folder / "fracture.gif")
    return {
        "file": "fracture.gif",
        "seconds": seconds,
        "frames": len(images),
        "frames_a_second": FRAMES_A_SECOND,
        "slowed_on_average": slowed,
        "times_s": flight.times.round(6).tolist(),
        "at_rest": int(flight.at_rest.sum()),
    }


@contextmanager
def _progress(total: int) -> Iterator[Callable[[int], None]]:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeRemainingColumn as Left

    columns = TextColumn("Animation"), BarColumn(), MofNCompleteColumn(), TextColumn("left"), Left()
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total)
        yield lambda done: bar.update(task, completed=done)


def _say(broken: Any, folder: Path, files: list[str]) -> None:
    found = broken.fracture
    masses = sorted(found.mass.masses)
    parts = f"{len(found.shards):,} shards" + (
        f" and {len(found.rest):,} parts of the rest" if len(found.rest) > 1
        else " and the rest" if len(found.rest) else ""
    )  # fmt: skip
    points = ", ".join(f"{count:,} {name}" for name, count in found.counts.items())
    x, y, z = found.impact
    console.print(
        f"Broken by {found.method}: {parts}, of {masses[0]:.3g} … {masses[-1]:.3g} kg, "
        f"{sum(masses):.4g} kg in all ({found.material.name})\n"
        f"Struck at {x:.4g},{y:.4g},{z:.4g} with {broken.blow.force:g} J/kg; "
        f"break points: {points}\n"
        f"In {folder}: {', '.join(files)}",
        highlight=False,
        soft_wrap=True,
        markup=False,
    )

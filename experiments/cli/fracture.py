"""The command ``hem fracture``: break a model, and keep pieces, pictures and numbers."""

import json
import signal
from collections.abc import Callable, Sequence
from contextlib import suppress
from enum import StrEnum
from math import isfinite
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

from experiments.cli.console import OfMesh, Repair, completed, console, errors

Method = StrEnum("Method", ["voronoi", "tetra", "surface"])
Format = StrEnum("Format", ["glb", "obj", "ply"])
Axis = StrEnum("Axis", ["x", "y", "z"])
Size = tuple[int, int]


def _parser(
    kind: Callable[[str], Any], separator: str, fits: Callable[..., bool], words: str
) -> Callable[[str], tuple[Any, ...]]:
    """What reads numbers that ``fits`` accepts, or raises BadParameter with the words."""

    def parse(text: str) -> tuple[Any, ...]:
        with suppress(TypeError, ValueError):
            values = tuple(kind(part) for part in text.lower().split(separator))
            if fits(*values):
                return values
        raise typer.BadParameter(f"{words}: {text!r}")

    return parse


# fmt: off
POINT: Any = {"metavar": "X,Y,Z", "parser": _parser(
    float, ",", lambda x, y, z: isfinite(x + y + z),
    "three numbers with commas between, as in 0.1,0.2,0.3")}
PIXELS: Any = {"metavar": "WIDTHxHEIGHT", "parser": _parser(
    int, "x", lambda w, h: min(w, h) >= 64 and max(w, h) <= 4096 and 0.25 <= w / h <= 4,
    "a width and a height of 64 … 4096 pixels, not too narrow, as in 640x480")}
Model = Annotated[str, Argument(**OfMesh)]
Impact = Annotated[Any, Option(**POINT, help="Where it is struck. Default: in view, to the left.")]
Direction = Annotated[Any, Option(**POINT, help="Where the blow goes. Default: into the surface.")]
OfMaterial = Annotated[str, Option(help="What it is of: glass, ceramic, stone, wood, ice.",
    autocompletion=completed("hem.fracture", "MATERIALS"))]
Materials = Annotated[Path | None, Option(help="A toml file of other materials to choose from.")]
Force = Annotated[float, Option(min=1e-9, max=1e9, help="How hard it is struck, in J/kg.")]
HowBroken = Annotated[Method | None, Option(
    help="How it breaks. Default: voronoi, or surface if open.")]
Holder = Annotated[str, Option(help="What holds the mesh, for tetra and surface.",
    autocompletion=completed("structures", "NAMES"))]
Seed = Annotated[int, Option(min=0, help="Other seeds, other shards.")]
Scale = Annotated[float, Option(min=1e-9, max=1e9,
    help="Multiply the model first; its unit is taken as a meter.")]
Wrap = Annotated[bool, Option("--wrap", help="Make a body around the model first.")]
Up = Annotated[Axis | None, Option(help="Which axis points up. Default: the model's.")]
Formats = Annotated[list[Format] | None, Option(
    help="Of the pieces' files; may be repeated. Default: glb.")]
Out = Annotated[Path | None, Option(help="The folder to write to. Default: fractured/MODEL.")]
Seconds = Annotated[float | None, Option(min=0.01, max=60,
    help="How long the pieces fly. Default: until they rest.")]
Animation = Annotated[bool, Option(help="Whether to make the animation, which takes the longest.")]
Pixels = Annotated[Any, Option(**PIXELS,
    help="Of the animation, and of each half of the picture, in pixels.")]


def fracture(
    model: Model, impact: Impact = None, direction: Direction = None,
    material: OfMaterial = "glass", materials: Materials = None, force: Force = 10.0,
    method: HowBroken = None, structure: Holder = "half_edge", seed: Seed = 0, scale: Scale = 1.0,
    repair: Repair = False, wrap: Wrap = False, up: Up = None, format: Formats = None,
    out: Out = None, seconds: Seconds = None, animation: Animation = True, size: Pixels = "640x480",
) -> None:
    """Break a model: pieces, a picture, an animation of them flying, and all in numbers.

    Example: `hem fracture bunny --material glass --force 10 --out broken`
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # what job systems send
    try:
        from experiments.report import fracture_scenes
        from hem import fracture as breaking

        # What can be wrong at a glance is told before anything is computed.
        own = breaking.materials(materials) if materials else {}
        known = breaking.material(material, breaking.MATERIALS | own)
        folder = out or Path("fractured") / Path(model.replace(":", "-")).stem
        breaking.require_writable(folder)
        mesh, axis = fracture_scenes.model(model, wrap, scale, repair)
        usual = Method.surface if mesh.summary().border_edges else Method.voronoi
        broken = fracture_scenes.break_up(
            mesh, method or usual, known, force,
            impact=impact, direction=direction, seed=seed, structure=structure, up=up or axis,
        )
        if method is None and usual is Method.surface:
            told = f"{model} is open: its surface is broken (or a body of it, with --wrap)"
            console.print(told, markup=False)
        asked = {"scale": scale, "wrap": wrap, "repair": repair, "structure": structure}
        formats = format or [Format.glb]
        files = _write(broken, model, asked, folder, formats, seconds, size, animation)
    except KeyboardInterrupt:
        errors.print("Stopped; nothing was written.")
        raise typer.Exit(130) from None
    _print_summary(broken, folder, files)
    if older := sorted({it.name for it in folder.iterdir()} - set(files)):
        told = f"In {folder} from before, and not of this fracture: {', '.join(older)}"
        errors.print(told, markup=False)
# fmt: on


def _write(
    broken: Any, model: str, asked: dict[str, Any], folder: Path, formats: Sequence[str],
    seconds: float | None, size: Size, animation: bool,
) -> list[str]:  # fmt: skip
    """Make everything beside the folder and move it there at the end -> the files' names."""
    from PIL import Image

    from hem.fracture import describe, save_pieces, whole

    with whole(folder) as beside:
        scene = broken.scene()
        for format in dict.fromkeys(formats):
            save_pieces(broken.fracture, beside, format, scene.up)
        numbers = describe(broken.fracture, broken.blow, broken.motion, model)
        numbers |= asked | {"up": broken.up, "held": broken.held}
        Image.fromarray(scene.still(size)).save(beside / "fracture.png", optimize=True)
        if animation:
            flight = broken.flight(scene, seconds)
            numbers["animation"] = _animate(broken, scene, flight, size, beside)
        (beside / "fracture.json").write_text(json.dumps(numbers, indent=1, allow_nan=False) + "\n")
        return sorted(path.name for path in beside.iterdir())


def _animate(broken: Any, scene: Any, flight: Any, size: Size, folder: Path) -> dict[str, Any]:
    from rich.progress import track

    from hem.fracture.show import FRAMES_PER_SECOND, save_animation

    caption = f"{broken.fracture.material.name}, {broken.blow.force:g} J/kg"
    frames, count = scene.frames(flight, size, caption), len(flight.times)
    seconds = float(flight.times[-1])
    images = list(track(frames, "Animation", count, console=console, transient=True))
    save_animation(images, folder / "fracture.gif")
    return {
        "file": "fracture.gif", "seconds": seconds, "frames": count,
        "frames_a_second": FRAMES_PER_SECOND,
        "slowed_on_average": count / FRAMES_PER_SECOND / seconds,
        "times_s": flight.times.round(6).tolist(), "at_rest": int(flight.at_rest.sum()),
    }  # fmt: skip


def _print_summary(broken: Any, folder: Path, files: list[str]) -> None:
    made, masses = broken.fracture, sorted(broken.fracture.mass.masses)
    rest = f" and {len(made.rest):,} parts of the rest" if len(made.rest) > 1 else " and the rest"
    points = ", ".join(f"{count:,} {name}" for name, count in made.counts.items())
    x, y, z = made.impact
    console.print(
        f"Broken by {made.method}: {len(made.shards):,} shards{rest if made.rest else ''}, "
        f"of {masses[0]:.3g} … {masses[-1]:.3g} kg, {sum(masses):.4g} kg in all "
        f"({made.material.name})\n"
        f"Struck at {x:.4g},{y:.4g},{z:.4g} with {broken.blow.force:g} J/kg; "
        f"break points: {points}\n"
        f"In {folder}: {', '.join(files)}",
        soft_wrap=True, markup=False,
    )  # fmt: skip

"""``hem fracture`` as a newcomer types it, and the demo's page."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import hem as package
from experiments.cli import demo
from experiments.report.fracture_scenes import break_up, default_impact, model
from hem.fracture import MATERIALS
from hem.fracture.show.scene import on_surface
from tests.experiments.cli.calls import output_of, words
from tests.extent import exhaustive, waiting_for
from tests.pictures import require_pictures


@pytest.fixture(scope="module", autouse=True)
def _pictures() -> None:
    require_pictures()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing"], "there is no model 'nothing': name a file, or one of bunny"),
        (["nothing.ply"], "there is no such file"),
        (["empty.ply"], "the file is empty"),
        (["sphere:many"], "after the colon stands a number of vertices"),
        (["sphere:3"], "reachable are 12"),
        (["sphere", "--impact", "a,b"], "three numbers with commas"),
        (["sphere", "--impact", "1,2"], "three numbers with commas"),
        (["sphere", "--impact", "nan,0,0"], "three numbers with commas"),
        (["sphere", "--impact", "40,0,0"], "more than half the diagonal"),
        (["plate", "--impact", "40,0,0"], "more than half of its size"),
        (["sphere", "--direction", "0,0"], "three numbers with commas"),
        (["sphere", "--direction", "0,0,0"], "a direction has some length"),
        (["sphere", "--force", "0"], "Invalid value for '--force'"),
        (["sphere", "--force", "-1"], "Invalid value for '--force'"),
        (["sphere", "--force", "inf"], "Invalid value for '--force'"),
        (["sphere", "--material", "glas"], "did you mean 'glass'?"),
        (["sphere", "--materials", "none.toml"], "cannot read materials from none.toml"),
        (["sphere", "--method", "hammer"], "'hammer' is not one of"),
        (["sphere", "--structure", "heap"], "there is no structure 'heap', only indexed"),
        (["sphere", "--format", "glb", "--format", "stl"], "'stl' is not one of"),
        (["sphere", "--seed", "-1"], "Invalid value for '--seed'"),
        (["sphere", "--size", "640"], "a width and a height"),
        (["sphere", "--size", "64x9999"], "64 … 4096"),
        (["sphere", "--seconds", "0"], "Invalid value for '--seconds'"),
        (["sphere", "--up", "w"], "'w' is not one of"),
        (["sphere", "--scale", "0"], "Invalid value for '--scale'"),
        (["sphere", "--out", "empty.ply"], "is a file, not a folder"),
        (["plate", "--method", "voronoi"], "the mesh is open"),
        (["plate", "--method", "tetra"], "the mesh is open"),
    ],
)
def test_a_mistake_is_explained_and_nothing_is_written(arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("empty.ply").touch()
    code, output = words("fracture", *arguments)
    assert code in (1, 2)
    assert said in output
    assert [path.name for path in tmp_path.iterdir()] == ["empty.ply"]


def test_a_sphere_breaks_into_all_that_is_promised(tmp_path):
    out = tmp_path / "new" / "folder"
    every = [option for name in ("glb", "obj", "ply") for option in ("--format", name)]
    output = output_of(
        "fracture", "sphere:162", "--material", "stone", "--force", "2", "--size", "96x72",
        "--seconds", "0.5", "--out", str(out), *every,
    )  # fmt: skip
    assert "Broken by voronoi" in output
    names = {path.name for path in out.iterdir()}
    assert names == {
        "fracture.gif", "fracture.json", "fracture.png", "pieces", "pieces.glb", "pieces.obj",
    }  # fmt: skip
    told = json.loads((out / "fracture.json").read_text())
    assert len(list((out / "pieces").iterdir())) == told["totals"]["pieces"] > 3
    assert told["totals"]["volume_m3"] == pytest.approx(4 / 3 * np.pi, rel=0.1)
    with Image.open(out / "fracture.gif") as film:
        assert film.size == (96, 72)
        assert film.info["loop"] == 0
        # Pillow makes one of frames that are alike.
        assert 20 < film.n_frames <= told["animation"]["frames"]
        first = np.asarray(film.convert("RGB")).astype(int)
        film.seek(film.n_frames - 1)
        assert np.abs(np.asarray(film.convert("RGB")) - first).max() > 50
    assert told["animation"]["times_s"][-1] == 0.5
    with Image.open(out / "fracture.png") as picture:
        assert picture.size == (192, 72)


@pytest.mark.parametrize(
    ("arguments", "method"),
    [
        (["plate"], "surface"),
        pytest.param(
            ["plate:100", "--structure", "plankton", "--direction", "0,0,-1", "--scale", "2"],
            "surface",
            marks=exhaustive,
        ),
        (["sphere:162", "--method", "tetra", "--impact", "0,1,0"], "tetra"),
        pytest.param(["terrain:100", "--wrap"], "voronoi", marks=exhaustive),
    ],
)
def test_every_method_can_be_had_and_the_same_call_gives_the_same(arguments, method, tmp_path):
    small = "--no-animation", "--size", "96x72"
    for name in ("one", "two"):
        output = output_of("fracture", *arguments, *small, "--out", str(tmp_path / name))
        assert f"Broken by {method}" in output
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert files == ["fracture.json", "fracture.png", "pieces.glb"]
    for name in files:
        one, two = ((tmp_path / it / name).read_bytes() for it in ("one", "two"))
        assert one == two, name
    told = json.loads((tmp_path / "two" / "fracture.json").read_text())
    assert told["scale"] == (2 if "--scale" in arguments else 1)
    assert told["structure"] == ("plankton" if "plankton" in arguments else "half_edge")
    assert (told["wrap"], told["repair"]) == ("--wrap" in arguments, False)
    totals, held = told["totals"], [told["pieces"][i] for i in told["held"]]
    assert bool(held) == (method == "surface")
    assert not any(it["kinetic_energy_J"] or any(it["velocity_m_s"]) for it in held)
    assert np.dot(totals["momentum_kg_m_s"], told["direction"]) > 0
    assert totals["kinetic_energy_J"] < told["force_J_kg"] * totals["mass_kg"]


def test_materials_of_ones_own_are_read(tmp_path):
    (tmp_path / "own.toml").write_text(
        "[jelly]\ndensity = 1000.0\nthickness = 0.01\ncircles = [3]\nscale = 0.1\nsites = 3.0\n"
        'reach = 0.3\nburst = 0.1\ncolor = "#cc3355"\n'
    )
    output_of(
        "fracture", "sphere:42", "--materials", str(tmp_path / "own.toml"), "--material", "jelly",
        "--no-animation", "--size", "96x72", "--out", str(tmp_path / "out"),
    )  # fmt: skip
    told = json.loads((tmp_path / "out" / "fracture.json").read_text())
    assert told["material"]["name"] == "jelly"


@pytest.mark.parametrize("by", waiting_for([signal.SIGTERM], [signal.SIGINT, signal.SIGTERM]))
def test_a_run_that_is_stopped_leaves_a_folder_as_it_was(by, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "fracture.json").write_text("before")
    command = [sys.executable, "-m", "experiments.cli", "fracture", "sphere:162", "--out", str(out)]
    # The picture is there soon; what comes after it takes long.
    child = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not list(out.glob(".hem-*/new/fracture.png")):
        assert child.poll() is None
        time.sleep(0.05)
    child.send_signal(by)
    _, said = child.communicate(timeout=300)
    assert child.returncode == 130
    assert "nothing was written" in said
    assert [path.name for path in out.iterdir()] == ["fracture.json"]
    assert (out / "fracture.json").read_text() == "before"


def test_a_run_that_is_stopped_while_it_breaks_says_so(tmp_path, monkeypatch):
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("experiments.report.fracture_scenes.break_up", stopped)
    code, output = words("fracture", "sphere:162", "--out", str(tmp_path / "out"))
    assert code == 130
    assert "nothing was written" in output
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["bunny", "teapot", "plate", "sphere:642"])
def test_the_default_impact_is_on_the_surface_and_goes_into_it(name):
    mesh, up = model(name)
    point, way = default_impact(mesh, up)
    edges = np.linalg.norm(np.ptp(mesh.points, axis=0))
    near = np.linalg.norm(mesh.points - point, axis=1).min()
    assert near < 0.1 * edges
    assert np.linalg.norm(way) == pytest.approx(1)
    middle = (mesh.points.max(axis=0) + mesh.points.min(axis=0)) / 2
    assert (middle - point) @ way >= -1e-6


def test_skin_is_told_from_the_walls_of_cuts():
    mesh, up = model("sphere:642")
    broken = break_up(mesh, "voronoi", MATERIALS["ice"], 1.0, up=up)
    for piece in broken.fracture.pieces:
        corners = piece.points[piece.triangles].astype(float)
        far = np.linalg.norm(corners, axis=2).min(axis=1)
        skin = on_surface(corners, mesh)
        assert (far[skin] > 0.98).all()
        assert (~skin[far < 0.9]).all()


@exhaustive
def test_the_demo_is_one_page_that_needs_no_network(tmp_path):
    case = {**demo.CASES[-1], "forces": (0.5, 2)}
    page = demo.write(tmp_path / "demo", [case], size=(64, 64))
    text = page.read_text(encoding="utf-8")
    assert "://" not in text
    assert "hem fracture plate:144 --material glass --method surface --force 0.5" in text
    for force in ("0_5", "2"):
        assert f'src="glass-plate-{force}/fracture.gif"' in text
        with Image.open(page.parent / f"glass-plate-{force}" / "fracture.gif") as film:
            assert film.size == (64, 64)
            assert film.n_frames > 5


def test_importing_the_package_stays_light():
    code = (
        "import sys, hem, experiments.cli.fracture; "
        "heavy = 'pyvista', 'trimesh', 'PIL', 'manifold3d', 'hem.fracture'; "
        "print([module for module in heavy if module in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
    assert package.__name__ == "hem"

"""The wheel holds what the checkout reads and works without it; what is imported is declared."""

from __future__ import annotations

import ast
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from importlib.metadata import packages_distributions
from itertools import chain
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest

import hem
from experiments.peers import PEERS
from tests.extent import exhaustive

ROOT = Path(__file__).parents[1]
PACKAGES = ("hem", "structures", "experiments")
FOLDERS = ("notebooks", "results/reference")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


GUARD = ROOT / "docs/guard.md"


def shown(page: Path, titled: bool = False) -> list[tuple[str, str]]:
    """Title and content of the blocks of Python that have a title, or of those that have none."""
    found = re.findall(r'(?ms)^```python(?: title="(.*?)")?\n(.*?)^```', page.read_text())
    return [(title, text) for title, text in found if bool(title) is titled]


def names(requirements: list[str]) -> set[str]:
    """The distributions that requirements name, in the spelling of the index."""
    return {normal(re.split(r"[\[<>=; ]", line)[0]) for line in requirements}


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


CORE = names(PROJECT["dependencies"])
EXTRAS = {extra: names(lines) for extra, lines in PROJECT["optional-dependencies"].items()}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """Built from a copy without a checkout."""
    source, built = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("built")
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    for folder in (*PACKAGES, *FOLDERS):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / folder, source / folder, ignore=ignored)
    code = f"from setuptools.build_meta import build_wheel; build_wheel({str(built)!r})"
    subprocess.run([sys.executable, "-c", code], cwd=source, check=True, capture_output=True)
    return next(built.glob("*.whl"))


@pytest.fixture(scope="module")
def site(wheel) -> Path:
    """A folder with the project as pip would install it."""
    shutil.unpack_archive(wheel, wheel.parent / "site", "zip")
    return wheel.parent / "site"


Installed = Callable[..., str]


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Installed:
    """What runs a program of an environment in which the wheel alone was installed, far away."""
    place, folder = tmp_path_factory.mktemp("environment"), tmp_path_factory.mktemp("elsewhere")
    subprocess.run([sys.executable, "-m", "venv", str(place)], check=True)
    unset = {"PYTHONPATH", "VIRTUAL_ENV", "HEM_RUN", "HEM_HISTORY"}
    environment = {key: it for key, it in os.environ.items() if key not in unset}
    hem.save(hem.generate("torus", 400), folder / "model.ply")
    hem.save(hem.PolygonMesh(np.eye(4, 3), [(0, 1, 2, 3)]), folder / "house.obj")

    def run(program: str, *arguments: str, code: int = 0) -> str:
        done = subprocess.run(
            [str(place / "bin" / program), *arguments], cwd=folder, env=environment, text=True,
            capture_output=True,
        )  # fmt: skip
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout + done.stderr

    wanted = f"{wheel}[study,fracture,viz]"
    run("pip", "install", "--quiet", wanted, "--constraint", str(ROOT / "constraints.txt"))
    return run


def files(root: Path) -> set[str]:
    found = (path for path in root.rglob("*") if path.is_file())
    return {str(path.relative_to(root)) for path in found if "__pycache__" not in path.parts}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_wheel_holds_every_file_of_the_packages(site, package):
    assert files(site / package) >= files(ROOT / package)


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_wheel_holds_the_notebooks_and_the_baseline(site, folder):
    assert files(site / "experiments/carried" / folder) == files(ROOT / folder)


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["--version"], 0, f"hem {PROJECT['version']}"),
        (["-h"], 0, "Usage"),
        (["table"], 1, "there is no run in results/runs; start one with: hem study"),
        (["report"], 1, "there is no run in results/runs; start one with: hem study"),
    ],
)
def test_an_installed_hem_runs_in_an_empty_folder(site, tmp_path, arguments, code, said):
    command = [sys.executable, "-m", "experiments.cli", *arguments]
    done = subprocess.run(
        command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(site)}, text=True,
        capture_output=True,
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    assert said in " ".join((done.stdout + done.stderr).split())


def test_an_installed_study_finds_its_notebooks_and_its_baseline(site, tmp_path):
    code = (
        "from experiments import carried; print(*map(carried, ['notebooks', 'results/reference']))"
    )
    found = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(site)},
        text=True, capture_output=True, check=True,
    ).stdout.split()  # fmt: skip
    assert found == [str(site / "experiments/carried" / folder) for folder in FOLDERS]


@exhaustive
def test_an_installed_study_measures_and_reports_away_from_the_checkout(installed):
    where = installed("python", "-c", "import hem, experiments; print(hem.__file__)")
    assert not Path(where.strip()).is_relative_to(ROOT)
    said = installed("hem", "study", "--preset", "smoke")  # compiles all of it, for minutes
    assert "Now: hem table, hem report" in said
    told = json.loads(installed("hem", "table", "--json"))
    claimed = {"indexed", "triangle_neighbor", "winged_edge", "half_edge"}  # by the thesis
    assert {it["structure"] for it in told["claims"]} == claimed
    page = unquote(urlsplit(installed("hem", "report").split()[-1]).path)
    assert len(list(Path(page).parent.glob("*.html"))) > 5


@exhaustive
def test_an_installed_hem_judges_costs_and_advises_on_a_mesh(installed):
    costs = "n,steps\n" + "".join(f"{n},{2 * n}\n" for n in (1, 10, 100, 1000))
    installed("python", "-c", f"open('costs.csv', 'w').write({costs!r})")
    judged = installed("hem", "judge", "costs.csv", "--expected", "O(n)", "--exact")
    assert "consistent" in judged
    assert "Predicted from the baseline" in installed("hem", "advise", "model.ply")


@exhaustive
def test_an_installed_plugin_tells_pytest_what_grows(installed):
    text = dict(shown(GUARD, titled=True))["test_growth.py"]
    write = "import sys; open('test_growth.py', 'w').write(sys.argv[1])"
    installed("python", "-c", write, text)
    options = ("--complexity-violated", "pass", "-W", "ignore")  # a busy machine fails nothing
    said = installed("python", "-m", "pytest", "test_growth.py", *options)
    assert "2 passed" in said
    assert "test_sorting: " in said


@exhaustive
@pytest.mark.parametrize(
    "page",
    [ROOT / "README.md", *sorted([*ROOT.glob("docs/*.md"), *ROOT.glob("hem/*/README.md")])],
    ids=str,
)
def test_the_examples_of_a_page_run_where_hem_is_installed(installed, page):
    code = "\n".join(text for _, text in shown(page))
    if code:
        installed("python", "-c", code)


def test_without_the_study_the_command_says_what_to_install():
    code = "import sys; sys.modules['typer'] = None; import experiments.cli"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, text=True, capture_output=True)
    assert done.returncode == 1
    assert done.stderr == "hem: the commands need more: pip install 'hem-mesh[study]'\n"


def imported(folder: str, *, at_import: bool = False) -> Iterator[tuple[str, str]]:
    """Every distribution that a package imports, lazily or only ``at_import``, with the file."""
    known = {it.module.partition(".")[0]: [it.distribution] for it in PEERS.values()}
    known["warp"] = ["warp-lang"]
    owners = known | packages_distributions()  # libraries need not be installed
    for path in (ROOT / folder).rglob("*.py"):
        tree = ast.parse(path.read_text())
        for node in tree.body if at_import else ast.walk(tree):
            modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                modules = [node.module or ""]
            for top in {module.partition(".")[0] for module in modules}:
                if top not in sys.stdlib_module_names and top not in PACKAGES:
                    yield normal(owners.get(top, [top])[0]), str(path.relative_to(ROOT))


@pytest.mark.parametrize("package", ["hem", "structures"])
def test_meshes_and_structures_need_the_core_alone(package):
    # Asked for by name, with an extra; or by pytest itself.
    outside = re.compile(r"hem/fracture/(show|bodies)/|hem/complexity/pytest_plugin\.py")
    found = {(d, path) for d, path in imported(package, at_import=True) if not outside.match(path)}
    assert {(name, path) for name, path in found if name not in CORE} == set()


def test_the_judge_needs_numpy_and_nothing_else_of_ours():
    found = {(it, path) for it, path in imported("hem/complexity") if "pytest_plugin" not in path}
    assert {it for it, _ in found} == {"numpy"}, found
    text = "".join(path.read_text("utf-8") for path in (ROOT / "hem/complexity").glob("*.py"))
    ours = re.findall(r"(?m)^\s*(?:from|import) ((?:hem|structures|experiments)\b[\w.]*)", text)
    assert {".".join(it.split(".")[:2]) for it in ours} == {"hem.complexity"}


@pytest.mark.parametrize("package", PACKAGES)
def test_whatever_is_imported_is_declared(package):
    declared = CORE.union(*EXTRAS.values())
    assert {(name, path) for name, path in imported(package) if name not in declared} == set()


def test_an_optional_package_is_brought_by_the_extra_that_the_error_names():
    sources = [path.read_text("utf-8") for path in (ROOT / "hem").rglob("*.py")]
    loaded = re.findall(r'load_optional\("(\w+)", "(\w+)"\)', "".join(sources))
    assert {extra for _, extra in loaded} == {"fracture", "viz"}
    assert [(name, extra) for name, extra in loaded if name not in EXTRAS[extra]] == []


def test_version_and_date_are_the_same_wherever_they_are_told():
    citation = (ROOT / "CITATION.cff").read_text()
    cited = re.findall(r'(?m)^(?:version|date-released): "?([^"\n]+)', citation)
    newest = re.search(r"(?m)^## (\S+), (\S+)$", (ROOT / "CHANGELOG.md").read_text())
    assert cited == [*newest.groups()]
    assert newest[1] == PROJECT["version"]


def test_whatever_is_declared_is_held_by_the_constraints():
    lines = (ROOT / "constraints.txt").read_text().splitlines()
    held = names([line for line in lines if line and not line.startswith("#")])
    assert CORE.union(*EXTRAS.values()) - held - {"hem-mesh", "setuptools"} == set()


def test_every_lower_bound_is_said_so_that_the_oldest_versions_can_be_tried():
    lines = [*PROJECT["dependencies"], *chain(*PROJECT["optional-dependencies"].values())]
    assert [line for line in lines if ">=" not in line and "hem-mesh[" not in line] == []


def test_an_experiment_knows_how_to_measure_and_nothing_of_what_becomes_of_it():
    grimp = pytest.importorskip("grimp")
    graph = grimp.build_graph("experiments")
    benches = {path.stem for path in (ROOT / "experiments").glob("bench_*.py")}
    for bench in benches:
        imports = graph.find_modules_directly_imported_by(f"experiments.{bench}")
        assert {name.split(".")[1] for name in imports} <= benches | {"harness", "peers"}
        users = graph.find_modules_that_directly_import(f"experiments.{bench}")
        assert "harness" not in {name.split(".")[1] for name in users}

"""Whatever the README, the pages of the site and the docstrings show is run."""

from __future__ import annotations

import ast
import doctest
import re
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.main import get_command
from typer.testing import CliRunner

import hem
import structures
from experiments.cli import app
from tests.extent import exhaustive, waiting_for

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
PAGES = {path.name: path.read_text() for path in sorted((ROOT / "docs").glob("*.md"))}
TEXT = "\n".join([README, (ROOT / "CONTRIBUTING.md").read_text(), *PAGES.values()])


def blocks_of(text: str) -> list[tuple[str, str]]:
    """Language and content of each; what has the title of a file is not meant to run by itself."""
    found = re.findall(r"(?ms)^```(\w*)([^\n]*)\n(.*?)^```", text)
    return [(language, content) for language, titled, content in found if not titled]


BLOCKS = blocks_of(TEXT)
LINES = [line.partition("#")[0].split() for _, text in BLOCKS for line in text.splitlines()]
COMMANDS = [list(it) for it in dict.fromkeys(tuple(it[1:]) for it in LINES if it[:1] == ["hem"])]
QUICK = [it for it in COMMANDS if it[0] in ("info", "meshes")]
FILES = dict(re.findall(r'(?ms)^```python title="([^"/]+)"\n(.*?)^```', TEXT))
PYTEST = re.findall(r"`?python -m (pytest [^`#\n]+)", TEXT)


def docstrings() -> Iterator[tuple[str, str]]:
    """Every docstring of the library, and whose it is."""
    for file in sorted(
        file for room in ("hem", "structures") for file in ROOT.glob(f"{room}/**/*.py")
    ):
        module = file.relative_to(ROOT).as_posix()
        for node in documented(ast.parse(file.read_text())):
            yield f"{module}:{getattr(node, 'name', '')}", ast.get_docstring(node) or ""


def documented(node: ast.Module | ast.ClassDef | ast.FunctionDef) -> Iterator[Any]:
    """A module, class or function, and those in it; to look for them deeper takes long."""
    yield node
    for inner in node.body:
        if isinstance(inner, ast.ClassDef | ast.FunctionDef):
            yield from documented(inner)


def code_in(text: str) -> str:
    """The indented blocks behind a double colon that are Python, and no drawings."""
    code = ""
    for block in re.findall(r"(?m)^.*::\n\n((?:(?: {4}.*)?\n)+)", text + "\n"):
        try:
            code += ast.unparse(ast.parse(textwrap.dedent(block))) + "\n"
        except SyntaxError:
            continue
    return code


DOCSTRINGS = list(docstrings())
SESSIONS = {name: text for name, text in DOCSTRINGS if ">>>" in text}
LITERAL = {name: code for name, text in DOCSTRINGS if "::\n" in text and (code := code_in(text))}


@pytest.fixture(autouse=True)
def names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """A folder with the files that examples read, and what they have imported."""
    monkeypatch.chdir(tmp_path)
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    hem.save(hem.PolygonMesh(square, [(0, 1, 2, 3)]), "house.obj")
    hem.save(hem.generate("torus", 400), "model.ply")
    return {"hem": hem, "structures": structures, "np": np}


def test_the_python_of_the_readme_runs_from_top_to_bottom(names: dict[str, Any]) -> None:
    blocks = [text for language, text in blocks_of(README) if language == "python"]
    assert len(blocks) >= 2
    for text in blocks:
        shown = [line for line in text.splitlines() if line]
        exec(compile("\n".join(shown), "README.md", "exec"), names)
    assert names["broken"].shards
    assert names["verdict"].outcome == "consistent"


WITH_PYTHON = [name for name in PAGES if "```python\n" in PAGES[name]]
AT_ONCE = [name for name in WITH_PYTHON if name != "measure.md"]  # which measures for seconds


@pytest.mark.parametrize("page", waiting_for(AT_ONCE, WITH_PYTHON))
def test_the_python_of_a_page_runs_from_top_to_bottom_and_imports_what_it_uses(page: str) -> None:
    given: dict[str, Any] = {"__name__": "page"}
    for language, text in blocks_of(PAGES[page]):
        if language == "python":
            exec(compile(text, page, "exec"), given)


@exhaustive  # it measures for ten seconds
def test_every_block_of_the_judge_runs_by_itself() -> None:
    for language, text in blocks_of((ROOT / "hem/complexity/README.md").read_text()):
        if language == "python":
            exec(compile(text, "hem/complexity/README.md", "exec"), {})


def test_what_people_reach_for_first_has_an_example() -> None:
    owners = {name.rpartition(":")[2] for name in SESSIONS}
    assert owners >= {"build", "load", "as_mesh", "TriangleMesh"}


@pytest.mark.parametrize("name", SESSIONS)
def test_an_example_in_a_docstring_gives_what_it_shows(name: str, names: dict[str, Any]) -> None:
    session = doctest.DocTestParser().get_doctest(SESSIONS[name], names, name, name, 0)
    said: list[str] = []
    failed, tried = doctest.DocTestRunner().run(session, out=said.append)
    assert tried
    assert not failed, "".join(said)


@pytest.mark.parametrize("name", LITERAL)
def test_code_in_a_docstring_runs(name: str, names: dict[str, Any]) -> None:
    names["mesh"] = structures.build("half_edge_objects", "model.ply")
    exec(compile(LITERAL[name], name, "exec"), names)


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=lambda it: it.name)
def test_a_link_to_a_place_leads_there_in_the_repository_too(page: Path) -> None:
    for target, anchor in re.findall(r"\]\(([^)#:\s]+)#([^)\s]+)", page.read_text()):
        headings = re.findall(r"(?m)^#+ (.+)$", (page.parent / target).read_text())
        anchors = [re.sub(r"[^\w -]", "", it.lower()).replace(" ", "-") for it in headings]
        assert anchor in anchors, target


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_a_command_that_is_shown_is_one(words: list[str]) -> None:
    command: Any = get_command(app)
    rest = words
    while hasattr(command, "commands") and not rest[0].startswith("-"):
        command, rest = command.commands[rest[0].rstrip(";")], rest[1:]
    if hasattr(command, "commands"):  # an option of all commands, which would act when it is read
        assert rest[0] in {name for it in command.params for name in it.opts}
    else:
        assert command.make_context("hem", rest).params is not None


@pytest.mark.parametrize("words", QUICK, ids=" ".join)
def test_a_quick_command_that_is_shown_runs(words: list[str]) -> None:
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output


def test_costs_that_a_page_shows_are_of_the_class_that_it_claims() -> None:
    Path("costs.csv").write_text(dict(blocks_of(PAGES["measure.md"]))["csv"])
    (claim,) = re.findall(r'hem judge costs\.csv --expected "(.+?)"', PAGES["measure.md"])
    done = CliRunner().invoke(app, ["judge", "costs.csv", "--expected", claim])
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize("word", ["hem judge", "hem advise", "pytest", "hem study"])
def test_the_readme_shows_every_way_into_the_project(word: str) -> None:
    assert re.search(rf"(?m)^(?:python -m )?{word} .*#", README)
    assert len(README.splitlines()) <= 150


@pytest.mark.parametrize(
    "target", sorted(set(re.findall(r"(?:`|^)make (\w+)", TEXT, re.MULTILINE)))
)
def test_a_target_that_is_shown_is_in_the_makefile(target: str) -> None:
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)


@exhaustive
@pytest.mark.parametrize("line", PYTEST)
def test_a_line_of_pytest_that_is_shown_selects_something(line: str) -> None:
    for name, text in FILES.items():
        Path(name).write_text(text)
    place = Path.cwd() if line.split()[1] in FILES else ROOT
    plugin = ["-p", "hem.complexity.pytest_plugin"]  # as where hem is installed anew
    words = [sys.executable, "-m", *line.split(), *plugin, "--collect-only", "-q"]
    done = subprocess.run(words, cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "::" in done.stdout

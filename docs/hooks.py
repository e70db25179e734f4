"""What the site takes from elsewhere in the project, so that every fact stands once.

Whole pages come from files that stand where readers of the code look for them, a section of
another file where a line is nothing but a link to it with a title, the commands from the program,
and the pictures of the gallery from the code beside them. Pages link to the files, so that they can
be read in the repository, too.
"""

from __future__ import annotations

import json
import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[1]

PAGES = {
    "answers.md": "report/README.md",
    "algorithm.md": "hem/algorithms/README.md",
    "judge.md": "hem/complexity/README.md",
    "architecture.md": "ARCHITECTURE.md",
    "changelog.md": "CHANGELOG.md",
    "contributing.md": "CONTRIBUTING.md",
}
"""By page the file it is."""

PLACES = {source: page for page, source in PAGES.items()} | {"README.md": "index.md"}
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#:\s]+)(#[^)\s]*)?\)")
INCLUDED = re.compile(r'(?m)^\[[^\]]+\]\(\.\./([^\s#)]+)(?:#(\S+))? "[^"]+"\)$')
SECTION = re.compile(r"(?ms)^## ([^\n]+)\n(.*?)(?=^## |\Z)")
MARKED = re.compile(r"(?ms)^<!-- (\w+) -->\n(.*?)^<!-- end of \1 -->")
DIAGRAM = re.compile(r"(?ms)^```mermaid\n(.*?)^```")
ADVICE = "results/reference/advice.json"  # told in words where a page includes it
MADE = re.compile(r"(?s)```python\n(.*?)```\n\n!\[([^\]]*)\]\((gallery/\w+\.png)\)")


def on_files(files: Files, config: Any) -> Files:
    """Add what is made or stands elsewhere."""

    def add(uri: str, content: str | bytes) -> None:
        files.append(File.generated(config, uri, content=content))

    for page, source in PAGES.items():
        text = DIAGRAM.sub(_arrows, (ROOT / source).read_text("utf-8"))
        add(page, _relinked(text, source, page))
    for picture in (ROOT / "report").glob("*.png"):
        add(f"report/{picture.name}", picture.read_bytes())
    add("commands.md", _commands())
    for code, _, uri in MADE.findall((ROOT / "docs/gallery.md").read_text("utf-8")):
        if drawn := _drawn(code):
            add(uri, drawn)
    return files


def on_page_markdown(markdown: str, page: Any, files: Files, **_: Any) -> str:
    """Put sections of other files where they are asked for; say which pictures are missing."""
    uri = page.file.src_uri

    def included(found: re.Match[str]) -> str:
        source, anchor = found.groups()
        if source == ADVICE:
            return _trust_of_advice()
        text = _section((ROOT / source).read_text("utf-8"), anchor)
        return _relinked(text, source, uri)

    def shown(found: re.Match[str]) -> str:
        if files.get_file_from_path(found[3]):
            return found[0]
        return f"```python\n{found[1]}```\n\n*{found[2]}: to draw it needs OpenGL.*"

    return _relinked(MADE.sub(shown, INCLUDED.sub(included, markdown)), f"docs/{uri}", uri)


def _arrows(diagram: re.Match[str]) -> str:
    """The arrows of a diagram in lines: to draw it a page would load a program from elsewhere."""
    lines = [line.strip() for line in diagram[1].splitlines() if "-->" in line]
    rows = [re.sub(r'\w+\["([^"]+)"\]', r"\1", line).replace("-->", "→") for line in lines]
    return "\n".join(("```text", *rows, "```"))


def _trust_of_advice() -> str:
    """How far off predictions were, as it was measured."""
    from experiments.validation import advice

    return advice.in_words(json.loads((ROOT / ADVICE).read_text("utf-8")))


def _section(text: str, anchor: str) -> str:
    """What stands below a heading, by its anchor: all, or what is between marks there."""
    for title, body in SECTION.findall(text):
        if re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") == anchor:
            marked = MARKED.search(body)
            return (marked[2] if marked else body).strip()
    raise ValueError(f"nothing is headed {anchor!r}")


def _relinked(text: str, source: str, page: str) -> str:
    """Links between files as links between pages; what has no page is only named."""

    def moved(found: re.Match[str]) -> str:
        image, words, target, anchor = found.groups(default="")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
        path = PLACES.get(path, path.removeprefix("docs/"))
        if not (image or path in PLACES.values() or (ROOT / "docs" / path).is_file()):
            return words
        return f"{image}[{words}]({posixpath.relpath(path, posixpath.dirname(page))}{anchor})"

    return LINK.sub(moved, text)


def _commands() -> str:
    """Every command's help, as the program prints it."""
    from typer.main import get_command

    from experiments.cli import app

    text = ["# The commands", "As `hem COMMAND --help` says."]

    def describe(command: Any, name: str) -> None:
        if hasattr(command, "commands"):
            for word, inner in command.commands.items():
                if not inner.hidden:
                    describe(inner, f"{name} {word}")
            return
        context = command.make_context(name, [], resilient_parsing=True)
        records = [it.get_help_record(context) for it in command.params if it.name != "help"]
        rows = [(words.split("  ")[0], about) for words, about in filter(None, records)]
        text.append(f"## {name}\n\n{command.help}")
        cells = ["| | |", "| --- | --- |"]
        cells += [f"| `{words}` | {_cell(about)} |" for words, about in rows]
        text.append("\n".join(cells if rows else []))
        if command.epilog:
            text.append(command.epilog)

    describe(get_command(app), "hem")
    return "\n\n".join(text)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("[", "\\[")


def _drawn(code: str) -> bytes | None:
    """A PNG of what the code calls ``shown``; None where nothing can be drawn."""
    from io import BytesIO

    from PIL import Image

    import hem
    import structures
    from hem.errors import NotInstalledError

    names: dict[str, Any] = {"hem": hem, "structures": structures}
    exec(compile(code, "gallery.md", "exec"), names)
    try:
        pixels = _picture(names["shown"])
    except NotInstalledError:
        return None
    file = BytesIO()
    Image.fromarray(pixels).save(file, "png", optimize=True)
    return file.getvalue()


def _picture(shown: Any) -> Any:
    from contextlib import closing

    from hem import TriangleMesh
    from hem.fracture.show import FractureScene, Picture

    if isinstance(shown, FractureScene):
        return shown.still((480, 400))
    mesh = shown if isinstance(shown, TriangleMesh) else shown.to_triangles()
    sand, up = (0.96, 0.82, 0.55), (0.0, 1.0, 0.0)
    with closing(Picture(mesh.points, mesh.triangles, sand, (800, 560), up, wires=True)) as picture:
        picture.look_at(mesh.points.astype(float))
        return picture.image()

"""The chapter on the structures: its bytes, ways and frames against documents and triangles."""

import ast
import inspect
import re
from itertools import combinations

import numpy as np
import pytest

import hem
import structures
from experiments.claims import Exactly, load_claims
from experiments.report import notebooks
from experiments.report.figures import class_diagram, drawings, records
from experiments.report.figures.meshes import hexagon
from experiments.report.notebooks import page_titles
from experiments.report.pages import page
from structures import NAMES, REGISTRY
from structures.objects import class_model
from tests.experiments.chromium import Browser
from tests.extent import OF_EACH_KIND

PRINTED = {
    it.structure: it.expects.value
    for it in load_claims()
    if isinstance(it.expects, Exactly) and it.expects.value
}
NAVIGABLE = [name for name in NAMES if REGISTRY[name].steps]


def faces_at(v: int) -> set[int]:
    """What the triangle list says."""
    return set(np.flatnonzero((hexagon().triangles == v).any(axis=1)).tolist())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("size", [8, 4])
def test_the_terms_of_the_bytes_add_up_to_the_memory_of_a_mesh(name, size):
    s = structures.build(name, hem.generate("torus", records.VERTICES), size)
    terms = records.byte_terms(REGISTRY[name], size)
    total = sum(it.per_vertex * width for it in terms for width in it.fields.values())
    assert total * s.n_vertices == pytest.approx(sum(s.memory().values()))


@pytest.mark.parametrize("name", PRINTED)
def test_the_terms_are_those_of_the_document(name):
    if name in REGISTRY:
        formula = records.formula(records.byte_terms(REGISTRY[name], 8))
        assert formula.endswith(f"= {PRINTED[name]:g}")


def test_a_formula_is_written_as_the_thesis_does():
    terms = [
        records.Term("vertex", 1, {"point": 12, "half_edge": 8}),
        records.Term("half_edge", 6, {"origin": 8, "next": 24}),
    ]
    assert records.formula(terms) == "12 + 8 + 6 · 32 = 212"


@pytest.mark.parametrize("name", NAMES)
def test_the_way_to_the_faces_ends_in_those_of_the_triangle_list(name):
    shown = drawings.walk(REGISTRY[name], "vertex_faces")
    found = re.findall(r'<g class="(?:face|triangle) found" data-at="\w+ (\d+)"', shown)
    assert {int(it) for it in found} == faces_at(drawings.CENTER)
    told = re.search(r"(\d+) reads, and the faces ([\d, ]+)", shown)
    assert {int(it) for it in told[2].split(",")} == faces_at(drawings.CENTER)
    s = structures.build(name, hexagon())
    s.vertex_faces(drawings.CENTER)  # finds what is found when first asked
    work = s.work("vertex_faces", np.array([drawings.CENTER]))[0]
    stops = records.path(s, "vertex_faces", drawings.CENTER)
    assert int(told[1]) == work == sum(len(it.fields) for it in stops)


NUMBER = re.compile(r"""<text (?:style="text-anchor:(\w+)" )?x="([\d.]+)" y="([\d.]+)">\d+<""")


@pytest.mark.parametrize("name", NAMES)
def test_no_step_of_a_way_is_written_over_a_face_that_is_found(name):
    shown, _, steps = drawings.walk(REGISTRY[name], "vertex_faces").partition('class="pointers"')
    found = re.findall(r'(?s)<g class="(?:face|triangle) found".*?</g>', shown)
    for anchor, x, y in NUMBER.findall(steps):
        to_middle = {"start": 5, "middle": 0, "end": -5}[anchor]
        for _, face_x, face_y in NUMBER.findall("".join(found)):
            off = float(x) + to_middle - float(face_x), float(y) - float(face_y)
            assert abs(off[0]) > 6 or abs(off[1]) > 6


@pytest.mark.parametrize("name", NAMES)
def test_no_step_of_a_way_is_written_over_another(name):
    steps = drawings.walk(REGISTRY[name], "vertex_faces").partition('class="pointers"')[2]
    written = re.findall(r'text-anchor:(\w+)" x="([\d.]+)" y="([\d.]+)">(\d+)<', steps)
    width = [5 * len(number) for *_, number in written]  # bold digits of 8.5 pixels, at least
    begins = {"start": 0.0, "middle": 0.5, "end": 1.0}
    left = [float(x) - begins[side] * w for (side, x, *_), w in zip(written, width, strict=True)]
    boxes = [(x, float(it[2]), w) for x, it, w in zip(left, written, width, strict=True)]
    for (x, y, w), (x2, y2, w2) in combinations(boxes, 2):
        assert x + w < x2 or x2 + w2 < x or abs(y - y2) > 7


@pytest.mark.parametrize("name", NAMES)
def test_every_reference_leads_to_a_record_that_is_drawn(name):
    entries, shapes = drawings.drawn_records(structures.build(name, hexagon()))
    assert entries.keys() <= shapes.keys()
    for its in entries.values():
        for entry in its:
            assert all(it == -1 or (entry.target, it) in shapes for it in entry.values)
    assert len([key for key in shapes if key[0] == "vertex"]) == len(hexagon().points)
    assert {key[1] for key in shapes if key[0] in ("face", "triangle")} == set(range(10))


@pytest.mark.parametrize("name", NAVIGABLE)
def test_a_half_edge_is_drawn_along_its_edge(name):
    s = structures.build(name, hexagon())
    points = drawings.MARGIN + drawings.SCALE * (hexagon().points[:, :2] * (1, -1) + (1.7, 1.05))
    for h in s.half_edges().tolist():
        start, end = points[[s.origin(h), s.tip(h)]]
        shape = drawings.shapes_of(s, {"half_edge"})["half_edge", h]
        first, last, *_ = re.findall(r"([\d.]+) ([\d.]+)", shape.outline)
        way = np.array(last, float) - np.array(first, float)
        assert way @ (end - start) > 0.6 * np.sum((end - start) ** 2)


def test_the_number_of_a_vertex_lies_on_no_edge():
    shapes = drawings.shapes_of(structures.build("half_edge", hexagon()), {"vertex"})
    for sides in np.moveaxis(hexagon().triangles[:, [[0, 1], [1, 2], [2, 0]]], 1, 0):
        for v, other in [*sides.tolist(), *sides[:, ::-1].tolist()]:
            (dx, dy), (x, y) = (
                to - shapes["vertex", v].at
                for to in (shapes["vertex", other].at, shapes["vertex", v].label)
            )
            assert abs(dx * y - dy * x) > 6 * np.hypot(dx, dy) or dx * x + dy * y < 0


@pytest.mark.parametrize("name", OF_EACH_KIND)
@pytest.mark.parametrize("operation", drawings.STEPS)
def test_every_frame_of_an_operation_is_a_valid_mesh_of_the_same_disk(name, operation):
    s, frames = REGISTRY[name].build(hexagon()), 0
    for _ in drawings.STEPS[operation](s):
        s.validate()
        corners = s.to_triangles()
        used, sides = np.unique(corners.triangles), corners.triangles[:, [0, 1, 1, 2, 2, 0]]
        n_edges = len(np.unique(np.sort(sides.reshape(-1, 2), axis=1), axis=0))
        assert len(used) - n_edges + len(corners.triangles) == 1
        a, b, c = (corners.points[corners.triangles[:, i], :2].T for i in range(3))
        (ux, uy), (vx, vy) = b - a, c - a
        areas = ux * vy - uy * vx
        assert areas.min() > -1e-6
        assert areas.sum() / 2 == pytest.approx(1.7 * 1.05 * 4 / np.sqrt(2), rel=1e-5)
        frames += 1
    assert frames >= 2


def test_new_records_are_marked_as_new():
    shown = drawings.operation("split_face")
    made = re.findall(r'<g class="(\w+) made"', shown)
    assert sorted(made) == ["face"] * 2 + ["half_edge"] * 6 + ["vertex"]


def test_before_a_collapse_what_it_takes_away_is_marked():
    first, *_ = drawings.operation("collapse_edge").split("<figcaption>")
    chosen = set(re.findall(r'<g class="\w+ going" data-at="(\w+ \d+)"', first))
    assert chosen >= {"vertex 0", "face 8", "face 9"}


def test_a_structure_is_described_by_its_own_file_or_that_of_what_it_is_made_of():
    for structure in REGISTRY.values():
        assert "**Invariants**\n\n- " in records.described(structure)

    class Same(drawings.BY_HALF_EDGES):
        name, title, abbreviation = "same", "Same", "Same"
        claims = REGISTRY["plankton"].claims

    assert records.described(Same) == records.described(drawings.BY_HALF_EDGES)


def test_a_drawing_in_a_docstring_is_one_block_however_its_lines_are_indented():
    for structure in REGISTRY.values():
        outside = re.sub(r"```text\n.*?\n```", "", records.described(structure), flags=re.DOTALL)
        assert not re.search("[│╲╱▲]", outside), structure.name
    assert records.fenced("See::\n\n   a\n b\n\nEnd") == "See:\n\n```text\n  a\nb\n```\n\nEnd"


def test_the_class_diagram_has_what_the_source_of_the_classes_declares():
    shown = class_diagram.class_diagram()
    for node in ast.parse(inspect.getsource(class_model)).body:
        if isinstance(node, ast.ClassDef) and node.name != "ElementList":
            assert f">{node.name}</text>" in shown
            for it in node.body:
                if isinstance(it, ast.Assign) and it.targets[0].id == "__slots__":
                    slots = [name.lstrip("_") for name in ast.literal_eval(it.value)]
                    assert all(f">{name}: " in shown for name in slots)
                if isinstance(it, ast.FunctionDef) and it.name[0] != "_" and not it.decorator_list:
                    assert f">{it.name}()</text>" in shown
    for held in ("next: HalfEdge", "origin: Vertex", "half_edge: HalfEdge", "items: Face [*]"):
        assert f">{held}</text>" in shown


def test_lines_of_the_class_diagram_run_beside_its_boxes_from_who_makes_what_too():
    shown = class_diagram.class_diagram()
    boxes, lines = (
        [[float(it) for it in re.findall(r'="([\d.]+)"', tag)] for tag in re.findall(kind, shown)]
        for kind in ("<rect[^>]+>", "<line[^>]+>")
    )
    for x1, x2, y1, y2 in lines:
        for left, top, width, height in boxes:
            way = np.linspace((x1, y1), (x2, y2), 99) - (left + width / 2, top + height / 2)
            assert not (abs(way) < (width / 2 - 1, height / 2 - 1)).all(axis=1).any()
    assert shown.rindex("<rect") < shown.index("<circle")  # no box hides the end of a line
    builder, mesh = (boxes[k] for k in (0, 3))
    assert any(y1 == builder[3] + 1 and y2 == mesh[1] for _, _, y1, y2 in lines)


# In a browser -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def chapter(tmp_path_factory):
    file = tmp_path_factory.mktemp("chapter") / "structures.html"
    content = {"titles": page_titles(), "here": "structures", "front": "index"}
    file.write_text(page("page.html.j2", body=notebooks.body("structures"), **content), "utf-8")
    return file.as_uri()


def test_drawings_are_seen_without_the_page_around_them_as_in_jupyter(chromium, tmp_path):
    cells = tmp_path / "cells.html"
    cells.write_text(f"<meta charset=utf-8>{notebooks.body('structures')}", "utf-8")
    chromium.open(cells.as_uri())
    shapes = "[...document.querySelectorAll('.mesh :is(.face, .edge, .half_edge) path, rect')]"
    fills = chromium.run(f"{shapes}.map(it => getComputedStyle(it).fill)")
    assert len(fills) > 100
    assert "rgb(0, 0, 0)" not in fills  # of what has no style


def test_next_is_followed_round_a_face(chromium: Browser, chapter):
    chromium.errors.clear()
    chromium.size(1200)
    chromium.open(chapter)
    half_edge = drawings.BY_HALF_EDGES.name
    chromium.run(
        "var figures = [...document.querySelectorAll('figure.mesh')];"
        f"var its = figures.find(it => it.getBoundingClientRect().top >"
        f" document.getElementById('{half_edge}').getBoundingClientRect().top);"
        "its.querySelector('[data-at=\"half_edge 12\"]').dispatchEvent(new Event('click'))"
    )
    visited = []
    for _ in range(3):
        visited.append(chromium.run("its.querySelector('.told b').textContent"))
        follow = "[...its.querySelector('.told p').childNodes].find(it => /next/.test(it.data))"
        chromium.run(f"{follow}.nextElementSibling.click()")
    assert chromium.run("its.querySelector('.told b').textContent") == visited[0]
    assert visited == ["half-edge 12", "half-edge 13", "half-edge 14"]  # 3 f + i of face 4
    assert chromium.run("its.querySelectorAll('.pointers path').length") == 4
    assert chromium.errors == []


def test_records_are_chosen_by_the_keyboard_which_no_record_loses(chromium: Browser, chapter):
    chromium.errors.clear()
    chromium.open(chapter)
    chromium.run("var figures = document.querySelectorAll('figure.mesh.live:not([hidden])')")
    count = len(NAMES) + len(drawings.STEPS)
    assert chromium.run("figures.length") == count
    for figure in (f"figures[{k}]" for k in range(count)):
        chromium.run(f"{figure}.querySelector('.told button').focus()")
        for _ in range(4):
            name = chromium.run("document.activeElement.textContent")
            chromium.call("Input.dispatchKeyEvent", type="keyDown", key="Enter", text="\r")
            chromium.call("Input.dispatchKeyEvent", type="keyUp", key="Enter")
            assert chromium.run(f"{figure}.querySelector('.told b').textContent") == name
            assert chromium.run(f"{figure}.contains(document.activeElement)"), name
    assert chromium.errors == []


def test_no_click_takes_a_way_away(chromium: Browser, chapter):
    chromium.open(chapter)
    chromium.run("var its = document.querySelector('figure.mesh:has(details)')")
    told = "[its.textContent, its.querySelectorAll('.pointers path').length]"
    before = chromium.run(told)
    chromium.run("its.querySelector('[data-at]').dispatchEvent(new Event('click'))")
    assert chromium.run(told) == before


def test_a_record_that_is_chosen_looks_as_it_is_drawn_without_scripts(chromium: Browser, chapter):
    chromium.open(chapter)
    drawn = "[...document.querySelectorAll('figure.mesh:has(.chosen) .pointers')].map(it => "
    drawn += "[...it.children].map(of => of.outerHTML).join())"
    choose = "document.querySelectorAll(':not(.steps) > figure.mesh .chosen').forEach(it => "
    before, _, after = map(
        chromium.run, (drawn, f"{choose} it.dispatchEvent(new Event('click')))", drawn)
    )
    assert len(before) >= len(NAMES)
    for one, other in zip(before, after, strict=True):
        numbers = (re.findall(r"-?\d+\.?\d*", it) for it in (one, other))
        np.testing.assert_allclose(*(np.array(it, float) for it in numbers), atol=0.11)


def test_the_lines_of_a_class_stand_inside_its_box(chromium: Browser, chapter):
    chromium.open(chapter)
    right = "getBoundingClientRect().right"
    box = f"it.parentNode.querySelector('rect').{right}"
    over = f"[...document.querySelectorAll('.classes text')].filter(it => it.{right} > {box} - 4)"
    assert chromium.run(f"{over}.map(it => it.textContent)") == []


def test_frames_are_stepped_through_one_at_a_time(chromium: Browser, chapter):
    chromium.open(chapter)
    shown = "[...document.querySelector('.steps').querySelectorAll('figure')].map(it => !it.hidden)"
    assert chromium.run(shown) == [True, False, False]
    chromium.run("document.querySelectorAll('.steps button')[1].click()")
    assert chromium.run(shown) == [False, True, False]
    chromium.run("document.querySelectorAll('.steps button')[0].click()")
    assert chromium.run(shown) == [True, False, False]


def test_on_paper_there_is_every_frame_and_nothing_to_step_by(chromium: Browser, chapter):
    chromium.open(chapter)
    chromium.call("Emulation.setEmulatedMedia", media="print")
    try:
        for part, seen in (("figure", True), ("p button", False)):
            parts = f"[...document.querySelectorAll('.steps > {part}')]"
            assert set(chromium.run(f"{parts}.map(it => it.checkVisibility())")) == {seen}
    finally:
        chromium.call("Emulation.setEmulatedMedia", media="")


def test_without_scripts_every_frame_and_the_references_of_a_record_are_shown(chromium, chapter):
    chromium.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        chromium.open(chapter)
        frames = "[...document.querySelectorAll('.steps figure')].every(it => it.checkVisibility())"
        assert chromium.run(frames)
        told = chromium.run("[...document.querySelectorAll('.told')].map(it => it.textContent)")
        assert sum("(drawn)" in it for it in told) == len(NAMES)
    finally:
        chromium.call("Emulation.setScriptExecutionDisabled", value=False)

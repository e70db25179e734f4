"""What a structure's file forgets is an error when it is imported, and names the part."""

from __future__ import annotations

import ast
import inspect
from pathlib import Path

import numpy as np
import pytest

import hem
import structures
from hem.contract import QUERIES
from tests.structures.conftest import OF_ARRAYS

SOURCE = (Path(structures.__file__).parent / "half_edge.py").read_text("utf-8")


def write(folder: Path, name: str, changes: dict[str, str]) -> str:
    """A package with one structure in it: the half-edge mesh, changed -> the package's name."""
    package = folder / name
    package.mkdir()
    (package / "__init__.py").touch()
    text = SOURCE
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (package / "quarter_edge.py").write_text(text, "utf-8")
    return name


@pytest.mark.parametrize(
    ("old", "new", "forgotten"),
    [
        ('name, title, abbreviation = "half_edge",', "title, abbreviation =", "name"),
        ("look, thesis, order =", "_, thesis, order =", "look"),
        ('"-"), True, 4', '"-"), False, 4', "claims"),
        ("records_type = HalfEdgeRecords", "pass", "records_type"),
        ("def _require_invariants(", "def _forgotten(", "_require_invariants"),
        ("face_faces = ", "face_neighbors = ", "face_faces(m, f, out) -> count"),
        ("def flip_records(", "def flip(", "flip_records, which flip_edge takes"),
        ("clear_vertex = ", "forget_vertex = ", "clear_vertex(m, v), and its vertices refer"),
        ("def set_vertex_face(", "def set_face(", "set_vertex_face(m, v, f), and its vertices"),
        ("@kernel\ndef flip_records", "def flip_records", "@kernel flip_records, which flip_edge"),
        (
            '"vertex_point", 3',
            '"vertex_points", 3',
            "'vertex_points', and there are face_half_edge",
        ),
        ('Field("half_edge.twin', 'Field("twin.of', "'twin', and there are edge, face, half_edge"),
        ('Field("half_edge.twin', 'Field("twin', "field 'twin' has no name such as half_edge.twin"),
        ('edge.next"', 'edge.next.one"', "field 'half_edge.next.one' has no name such as"),
        (
            'origin", "half_edge", target="vertex',
            'origin", "half_edge", target="v',
            "'v', and there",
        ),
        ('target="half_edge", marks=True', 'target="half_edge"', "no field of face says marks"),
        (
            "face_half_edge: Array",
            "face_half: Array",
            "no array 'face_half_edge'; there are vertex_",
        ),
        ("    counts: Array", "    numbers: Array", "last array of its records is not counts"),
        ("    counts: Array", "    age: Array\n    counts: Array", "have no field: age"),
    ],
)
def test_a_forgotten_part_is_named(tmp_path, monkeypatch, old, new, forgotten):
    package = write(tmp_path, f"forgotten_{abs(hash(forgotten))}", {old: new})
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError) as refused:
        structures.find_described([str(tmp_path / package)], package)
    assert forgotten in str(refused.value)
    assert "quarter_edge.py: HalfEdge" in str(refused.value)


def test_two_structures_of_one_name_are_refused(tmp_path, monkeypatch):
    package = write(tmp_path, "twice", {})
    (tmp_path / "twice" / "again.py").write_text(SOURCE, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match="have one name: 'half_edge'"):
        structures.find_described([str(tmp_path / package)], package)


@pytest.mark.parametrize("name", ["quarter.edge", "quarter edge", "quarter/edge"])
def test_a_name_that_no_file_can_have_is_refused(tmp_path, monkeypatch, name):
    package = write(
        tmp_path, f"named_{len(name)}_{ord(name[7])}", {'= "half_edge", "': f'= "{name}", "'}
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match=f"its name is '{name}', no word such as half_edge"):
        structures.find_described([str(tmp_path / package)], package)


def test_a_look_that_is_inherited_is_no_look_of_its_own(tmp_path, monkeypatch):
    package = write(tmp_path, "alike", {})
    own = 'name, title, abbreviation = "other", "Other", "OTH"'
    text = f"from {package} import quarter_edge as it\n\n\nclass Other(it.HalfEdge):\n    {own}\n"
    (tmp_path / "alike" / "other.py").write_text(text, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match="have one look"):
        structures.find_described([str(tmp_path / package)], package)


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_a_page_tells_of_records_then_queries_then_operations_then_building(name):
    kind = structures.REGISTRY[name]
    page = Path(inspect.getfile(kind.records_type)).read_text("utf-8")
    lines: dict[str, int] = {}
    for it in ast.parse(page).body:
        found = [it] if not isinstance(it, ast.Assign) else list(ast.walk(it.targets[0]))
        lines |= {str(getattr(one, "name", getattr(one, "id", ""))): it.lineno for one in found}
    queries = [line for it, line in lines.items() if it in QUERIES]
    operations = [line for it, line in lines.items() if it.endswith("_records")]
    operations.append(lines.get(kind.__name__, page.count("\n")))
    assert lines[kind.records_type.__name__] < min(queries) <= max(queries) < min(operations)
    assert max(operations) == operations[-1]
    if name in ("half_edge", "winged_edge"):
        assert page.count("\n") <= 450


def test_records_with_other_columns_than_their_fields_are_refused():
    s = structures.build("half_edge", hem.generate("torus", 100))
    wide = np.zeros((len(s.records.half_edge), 5), np.int32)
    with pytest.raises(TypeError, match=r"HalfEdgeRecords.half_edge has 5 columns.* fields 4"):
        structures.REGISTRY["half_edge"](s.records._replace(half_edge=wide))


def test_a_claim_of_no_query_is_refused(tmp_path, monkeypatch):
    claims = 'claims = Claims("a paper", {"vertex_rings": "O(1)"})'
    changes = {
        "records_type = HalfEdgeRecords": f"{claims}\n    records_type = HalfEdgeRecords",
        "import Look, Navigable": "import Claims, Look, Navigable",
    }
    package = write(tmp_path, "claiming", changes)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(TypeError, match="vertex_rings"):
        structures.find_described([str(tmp_path / package)], package)


def test_a_new_file_is_a_structure(tmp_path, monkeypatch):
    changes = {
        '"half_edge", "Half-Edge", "HEM"': '"quarter_edge", "Quarter Edge", "QEM"',
        '"-"), True, 4': '"-"), False, 1000',
        "records_type = HalfEdgeRecords": 'claims = Claims("", like="half_edge")\n'
        "    records_type = HalfEdgeRecords",
        "import Look, Navigable": "import Claims, Look, Navigable",
    }
    package = write(tmp_path, "found", changes)
    monkeypatch.syspath_prepend(tmp_path)
    found = structures.find_described([str(tmp_path / package)], package)
    assert list(found) == ["quarter_edge"]
    assert found["quarter_edge"].look == structures.NAMED["half_edge"].look

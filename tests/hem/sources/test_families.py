"""Generated meshes: every family is a surface of the promised size, kept soundly on disk."""

import io
import warnings
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import hem
from hem.sources.cache import cached
from hem.sources.valence import valence_hubs
from tests.extent import exhaustive

SIZES = (100, 137, 400, 2_500, 10_000)


@pytest.fixture(autouse=True, scope="module")
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> object:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HEM_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


def volume(mesh: hem.TriangleMesh) -> float:
    a, b, c = mesh.points[mesh.triangles].astype(float).swapaxes(0, 1)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def valences(mesh: hem.TriangleMesh) -> np.ndarray:
    edges = {frozenset(pair) for t in mesh.triangles.tolist() for pair in combinations(t, 2)}
    return np.bincount([v for edge in edges for v in edge], minlength=len(mesh.points))


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("family", hem.FAMILIES)
def test_a_family_is_one_surface_wound_outward_or_upward(family: str, n: int) -> None:
    mesh = hem.generate(family, n)
    hem.require_manifold(mesh)
    summary = mesh.summary()
    assert (summary.components, summary.unreferenced) == (1, 0)
    assert (summary.border_edges == 0) == hem.FAMILIES[family].closed
    assert summary.euler == {"torus": 0, "grid": 1, "terrain": 1}.get(family, 2)
    assert len(mesh.welded().points) == len(mesh.points)
    a, b, c = mesh.points[mesh.triangles].astype(float).swapaxes(0, 1)
    upward = np.cross(b - a, c - a)[:, 2] > 0
    assert volume(mesh) > 0 if hem.FAMILIES[family].closed else upward.all()


@pytest.mark.parametrize(
    ("family", "n", "reached"),
    [
        *[("torus", n, n) for n in (100, 400, 10_000)],
        pytest.param("torus", 1_000_000, 1_000_000, marks=exhaustive),
        ("sphere", 162, 162), ("sphere", 100, 162), ("sphere", 60, 42), ("sphere", 10_000, 10_242),
        ("grid", 100, 100), ("grid", 64, 64), ("cone", 60, 60), ("cone", 101, 101),
        ("terrain", 10_000, 10_000),
    ],
)  # fmt: skip
def test_sizes_that_are_reachable_are_reached(family: str, n: int, reached: int) -> None:
    assert len(hem.generate(family, n).points) == reached


@pytest.mark.parametrize(
    ("family", "least"),
    [("torus", 3 * 3), ("sphere", 12), ("grid", 2 * 2), ("cone", 3 + 2), ("terrain", 2 * 2)],
)
def test_the_smallest_size_is_reached_and_none_below(family: str, least: int) -> None:
    assert len(hem.generate(family, least).points) == least
    with pytest.raises(hem.MeshError, match=f"no {family} of {least - 1} vertices"):
        hem.generate(family, least - 1)


def test_every_size_is_met_within_15_percent_but_for_the_sphere() -> None:
    for family in set(hem.FAMILIES) - {"sphere"}:
        for n in (*range(100, 200, 13), 147, 997, 4_001):
            assert len(hem.generate(family, n).points) == pytest.approx(n, rel=0.15), family


def test_a_torus_has_two_faces_a_vertex_and_every_valence_six() -> None:
    mesh = hem.generate("torus", 400)
    assert len(mesh.triangles) == 2 * len(mesh.points)
    assert set(valences(mesh)) == {6}


@pytest.mark.parametrize(("n", "columns", "rows"), [(100, 10, 10), (137, 17, 8), (2_000, 50, 40)])
def test_a_grid_is_of_square_cells_and_as_near_to_a_square_as_its_size_allows(
    n: int, columns: int, rows: int
) -> None:
    x, y, z = (np.unique(it) for it in hem.generate("grid", n).points.T)
    assert (len(x), len(y), len(z)) == (columns, rows, 1)
    assert np.allclose(np.diff(x), 1 / (columns - 1))
    assert np.allclose(np.diff(y), 1 / (columns - 1))


@pytest.mark.parametrize("n", [100, 1_800, 10_000])
def test_a_torus_is_as_near_to_twice_as_long_as_wide_as_its_size_allows(n: int) -> None:
    ways = [(n / it**2, n // it) for it in range(3, n) if n % it == 0 and n <= 4 * it**2 <= 4 * n]
    _, around = min((abs(ratio - 2), long) for ratio, long in ways)
    x, y, _ = hem.generate("torus", n).points.T
    assert len(np.unique(np.arctan2(y, x).round(3))) == around


def test_a_cone_has_two_vertices_of_valence_n_less_two() -> None:
    assert sorted(valences(hem.generate("cone", 60)))[-3:] == [4, 58, 58]


@pytest.mark.parametrize("seed", [-1, 2**32])
def test_a_seed_out_of_range_is_refused(seed: int) -> None:
    with pytest.raises(hem.MeshError, match="from 0 to 4,294,967,295"):
        hem.generate("terrain", 300, seed)


@pytest.mark.parametrize("family", hem.FAMILIES)
def test_a_seed_matters_where_the_family_is_random_and_only_there(family: str) -> None:
    one, again, other = (hem.generate(family, 500, seed).points for seed in (1, 1, 2))
    assert np.array_equal(one, again)
    same = one.shape == other.shape and np.array_equal(one, other)
    assert same != hem.FAMILIES[family].random


def test_what_does_not_exist_is_refused_naming_what_does() -> None:
    with pytest.raises(hem.MeshError, match=r"torus, sphere, .*did you mean 'torus'"):
        hem.generate("tourus", 100)
    for n in (-5, 0, 3, 10_000_000):
        with pytest.raises(hem.MeshError, match=r"reachable are 9 … 2,000,000"):
            hem.generate("torus", n)


@pytest.mark.parametrize("seed", [0, 6, 95])  # of 95, marching cubes cuts two corners that are one
def test_nothing_is_printed(capfd: pytest.CaptureFixture[str], seed: int) -> None:
    with warnings.catch_warnings(action="error"):
        hem.generate("isosurface", 321, seed)
    assert capfd.readouterr() == ("", "")


def test_a_kept_mesh_is_read_and_a_broken_file_made_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HEM_CACHE", str(tmp_path / "deep" / "folder"))
    made: list[int] = []

    def make() -> hem.TriangleMesh:
        made.append(1)
        return hem.TriangleMesh(np.eye(3), [[0, 1, 2]])

    first = cached("key", make)
    second = cached("key", make)
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.triangles, second.triangles)
    assert len(made) == 1
    (file,) = (tmp_path / "deep" / "folder").iterdir()
    whole = file.read_bytes()
    array, at = io.BytesIO(), whole.index(b"PK\1\2")
    np.save(array, np.eye(3))  # of one array, and no archive
    broken = [b"", b"junk", array.getvalue(), whole[: len(whole) // 2]]
    broken += [whole.replace(b"points", b"pointy")]
    for byte in (6, 8, 10):  # the version that is needed, a password, the way of packing
        broken += [whole[: at + byte] + b"\x63" + whole[at + byte + 1 :]]
    for content in broken:
        file.write_bytes(content)
        assert len(cached("key", make).points) == 3
        assert file.read_bytes() == whole, "made anew, and nothing left beside"
    assert [file] == list(file.parent.iterdir())


def test_a_cache_that_cannot_be_written_costs_only_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("HEM_CACHE", str(tmp_path / "file"))
    with pytest.warns(UserWarning, match="cannot keep a mesh"):
        assert len(hem.generate("torus", 100).points) == 100


@pytest.mark.parametrize("n_faces", [1_000, 1_001, 8_192])
@pytest.mark.parametrize("valence", [3, 4, 5, 16, 100, 333, 500])
def test_hubs_have_the_valence_at_any_number_of_faces(valence: int, n_faces: int) -> None:
    mesh = hem.valence_mesh(valence, n_faces)
    hem.require_manifold(mesh)
    assert len(mesh.triangles) == n_faces
    assert mesh.summary().unreferenced == 0
    hubs = valence_hubs(valence, n_faces)
    assert hubs[0] == 0
    found = valences(mesh)
    assert set(found[list(hubs)]) == {valence}
    assert found[len(hubs) :].max() <= 4
    assert n_faces - 2 * valence < valence * len(hubs) <= n_faces


def test_bipyramids_are_wound_outward_and_the_strip_upward() -> None:
    mesh = hem.valence_mesh(5, 107)
    a, b, c = mesh.points[mesh.triangles].astype(float).swapaxes(0, 1)
    normals, middles = np.cross(b - a, c - a), (a + b + c) / 3
    bodies = np.repeat(np.arange(10), 10)
    for body in range(10):
        center = mesh.points[2 * body : 2 * body + 2].mean(axis=0)
        mine = np.flatnonzero(bodies == body)
        assert (((middles - center) * normals).sum(axis=1)[mine] > 0).all()
    assert (normals[100:, 2] > 0).all()


@pytest.mark.parametrize(("valence", "n_faces"), [(2, 100), (51, 100), (0, 0)])
def test_a_valence_out_of_reach_is_refused(valence: int, n_faces: int) -> None:
    with pytest.raises(hem.MeshError, match="half the faces"):
        hem.valence_mesh(valence, n_faces)


def test_what_numpy_counts_in_few_bits_makes_the_same_meshes() -> None:
    pairs = (
        (hem.valence_mesh(np.int8(100), np.int16(300)), hem.valence_mesh(100, 300)),
        (hem.sample("teapot", tessellation=np.int8(20)), hem.sample("teapot", tessellation=20)),
    )
    for one, other in pairs:
        assert np.array_equal(one.points, other.points)
        assert np.array_equal(one.triangles, other.triangles)
    hubs = valence_hubs(np.int8(100), np.int16(300))  # type: ignore[arg-type]
    assert set(valences(pairs[0][0])[list(hubs)]) == {100}


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: hem.generate("torus", 1e4), "a number of vertices is an integer, not 10000.0"),  # type: ignore[arg-type]
        (lambda: hem.generate("terrain", 100, "1"), "a seed is an integer, not '1'"),  # type: ignore[arg-type]
        (lambda: hem.valence_mesh(6, 24.0), "a number of faces is an integer"),  # type: ignore[arg-type]
        (lambda: hem.valence_mesh(None, 24), "a valence is an integer"),  # type: ignore[arg-type]
        (lambda: hem.sample("teapot", tessellation=2.5), "a tessellation is an integer"),
    ],
)
def test_a_size_that_is_no_integer_is_refused(make: Callable[[], object], words: str) -> None:
    with pytest.raises(hem.MeshError, match=words):
        make()

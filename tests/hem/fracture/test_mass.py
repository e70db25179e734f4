import numpy as np
import pytest

import hem
from hem.fracture.mass import of_bodies, of_sheets
from tests.hem.fracture.solids import NAMES, as_trimesh, body, box


@pytest.mark.parametrize("name", NAMES)
def test_masses_are_those_that_trimesh_finds(name):
    mesh = body(name).mesh
    truth, found = as_trimesh(mesh, 7.0), of_bodies([mesh], 7.0)
    assert found.volumes[0] == pytest.approx(truth.volume, rel=1e-12)
    assert found.masses[0] == pytest.approx(truth.mass, rel=1e-12)
    np.testing.assert_allclose(found.centers[0], truth.center_mass, atol=1e-12)
    size = np.abs(truth.moment_inertia).max()
    np.testing.assert_allclose(found.inertias[0], truth.moment_inertia, atol=1e-12 * size)


def test_a_box_has_the_inertia_of_the_textbook():
    found = of_bodies([box(1, 2, 3, at=(5, 6, 7))], 2.0)
    np.testing.assert_allclose(found.centers, [[5, 6, 7]], rtol=1e-15)
    np.testing.assert_allclose(found.inertias[0], np.diag([13, 10, 5]), atol=1e-13)


def test_pieces_weigh_together_what_they_weigh_alone():
    meshes = [box(1, 1, 1, at=(i, 0, 0)) for i in range(5)] + [body("sphere").mesh]
    for found in (lambda m: of_bodies(m, 3.0), lambda m: of_sheets(m, 3.0, 0.1)):
        alone = [found([mesh]) for mesh in meshes]
        for one, all_of_them in zip(zip(*alone, strict=True), found(meshes), strict=True):
            np.testing.assert_allclose(np.concatenate(one), all_of_them, rtol=1e-13, atol=1e-15)


def test_a_body_far_from_the_origin_keeps_its_digits():
    near, far = box(1, 1, 1), box(1, 1, 1, at=(2.0**20, -(2.0**20), 2.0**20))
    one, other = of_bodies([near], 1.0), of_bodies([far], 1.0)
    np.testing.assert_allclose(other.volumes, one.volumes, rtol=1e-14)
    np.testing.assert_allclose(other.inertias, one.inertias, atol=1e-14)


def test_a_square_sheet_has_the_inertia_of_a_thin_plate():
    square = hem.TriangleMesh([(1, 1, 5), (3, 1, 5), (3, 3, 5), (1, 3, 5)], [(0, 1, 2), (0, 2, 3)])
    found = of_sheets([square], 10.0, 0.25)
    mass = 10.0 * 0.25 * 4
    np.testing.assert_allclose(found.volumes, [1.0])
    np.testing.assert_allclose(found.masses, [mass])
    np.testing.assert_allclose(found.centers, [[2, 2, 5]])
    np.testing.assert_allclose(found.inertias[0], mass * 4 / 12 * np.diag([1, 1, 2]), atol=1e-12)


def test_a_sheet_weighs_what_samples_of_it_do():
    mesh = body("sphere").mesh
    found, truth = of_sheets([mesh], 1.0, 1.0), as_trimesh(mesh)
    assert found.volumes[0] == pytest.approx(truth.area, rel=1e-12)
    # A sphere without thickness: 2/3 m r², less what its flat faces cut off.
    inertia = np.diag(found.inertias[0]) / found.masses[0]
    np.testing.assert_allclose(inertia, 2 / 3, rtol=0.03)


def test_what_has_no_faces_weighs_nothing():
    empty = hem.TriangleMesh([], [])
    found = of_bodies([empty, box(1, 1, 1), empty], 2.0)
    np.testing.assert_allclose(found.masses, [0, 2, 0])
    assert np.isfinite(found.centers).all()
    for none in ([], [empty, empty]):
        assert of_bodies(none, 1.0).inertias.shape == (len(none), 3, 3)


@pytest.mark.parametrize("wrong", [0, -1, np.nan, np.inf])
def test_densities_and_thicknesses_are_positive(wrong):
    with pytest.raises(hem.MeshError, match="density"):
        of_bodies([], wrong)
    with pytest.raises(hem.MeshError, match="density"):
        of_sheets([], wrong, 1.0)
    with pytest.raises(hem.MeshError, match="thickness"):
        of_sheets([], 1.0, wrong)

"""Every erratum is shown by a run of what is printed, beside one of what is sound."""

from __future__ import annotations

import numpy as np
import pytest

import hem
from experiments.claims.errata import ERRATA, KNOWN, OCTAHEDRON, printed, sound
from structures.as_printed import AsPrinted, render_arrays


@pytest.mark.parametrize("number", range(len(ERRATA)))
def test_an_erratum_shows_when_the_listing_is_run(number):
    shown = ERRATA[number].show()
    assert shown.confirmed, f"{ERRATA[number].title}: {shown.printed} beside {shown.sound}"


def test_the_known_ones_come_first_and_each_has_a_source():
    assert len(ERRATA) > KNOWN == 9
    assert len({it.title for it in ERRATA}) == len(ERRATA)
    assert all("thesis" in it.source for it in ERRATA)


def test_what_the_listings_build_is_sound_but_for_the_last_triangle():
    m = printed()
    assert not m.faults()
    corners = {frozenset(h.origin.index for h in m.face_circulator(f)) for f in m.faces}
    s = sound()
    assert corners == {frozenset(s.face_vertices(f).tolist()) for f in s.faces().tolist()}


def test_the_builder_welds_as_the_sound_one_does():
    mesh = OCTAHEDRON
    apart = np.arange(24).reshape(8, 3)  # every face has corners of its own
    soup = AsPrinted.build(*render_arrays(mesh.points[mesh.triangles.ravel()], apart), whole=True)
    assert (len(soup.vertices), len(soup.faces)) == (6, 8)
    soup.generate_render_mesh()
    assert not soup.faults()


def test_splitting_a_face_as_printed_keeps_the_references():
    m = printed()
    m.split_face(m.faces[0], (9.0, 9.0, 9.0))
    assert not m.faults()
    assert (len(m.vertices), len(m.half_edges), len(m.faces)) == (7, 30, 10)


def test_the_counter_of_faults_finds_none_in_a_mesh_without_any():
    assert printed(hem.generate("grid", 49)).faults() == {}

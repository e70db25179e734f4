"""What the chapter on real time says of single edits."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import hem
import structures
from experiments.bench_picking import FOLLOWING, NEIGHBORS, RAY, REBUILT, REFITTED
from experiments.bench_real_time import GROWING, RESERVED
from experiments.report.figures import real_time
from experiments.report.session import MissingError


@pytest.mark.parametrize("seed", range(5))
def test_so_many_edits_fit_into_every_frame_and_no_more_into_one(seed):
    seconds = np.random.default_rng(seed).gamma(0.3, 2e-3, 400)
    fits = []
    for first in range(len(seconds)):
        left, many = real_time.FRAME, 0
        while first + many < len(seconds) and seconds[first + many] <= left:
            left -= seconds[first + many]
            many += 1
        if first + many < len(seconds):
            fits.append(many)
    assert real_time._in_a_frame(seconds) == str(min(fits))


def test_edits_that_end_before_a_frame_does_fit():
    assert real_time._in_a_frame(np.full(100, 1e-6)) == "all\N{NO-BREAK SPACE}100"


def whole(quantities: str) -> str:
    """Quantities of which none is broken at the end of a line."""
    return re.sub(r"(?<=\d) (?=\w)", "\N{NO-BREAK SPACE}", quantities)


def test_every_size_is_told_and_with_room_apart_from_without(monkeypatch):
    cases = [
        ("half_edge", 1_000, GROWING, [1.1e-6, 2.2e-6, 9.1e-3]),
        ("half_edge", 1_000, RESERVED, [7e-6]),
        ("half_edge", 10_000, GROWING, [3.3e-6, 4.4e-6, 5.5e-6]),
        ("indexed", 1_000, GROWING, [2e-2]),
    ]
    table = pd.DataFrame(cases, columns=["structure", "vertices", "order", "samples"])
    table["detail"] = [{"uploads": [12, 24, 60]}] * len(cases)
    monkeypatch.setattr(real_time, "_cases", lambda run, subject: table)
    fit = "all\N{NO-BREAK SPACE}3"
    assert real_time.frames(None).rows == [
        ["", "1,000 vertices", "10,000 vertices", "uploaded, bytes", "at most"],
        ["Half-Edge", whole(f"2.2 µs · 8.9 ms · 9.1 ms · {fit}"),
         whole(f"4.4 µs · 5.5 µs · 5.5 µs · {fit}"), "24", "60"],
        ["Indexed", whole("20 ms · 20 ms · 20 ms · 0"), "–", "24", "60"],
    ]  # fmt: skip
    assert [it[:2] for it in real_time.frames(None, RESERVED).rows[1:]] == [
        ["Half-Edge", whole("7.0 µs · 7.0 µs · 7.0 µs · all\N{NO-BREAK SPACE}1")]
    ]


def test_an_edit_that_is_too_long_is_told_where_it_is_and_not_of_a_larger_mesh(monkeypatch):
    longest = {"half_edge": (1e-3, 2e-3, 3e-3), "indexed": (1e-3, 4e-2, 5e-3), "plankton": (3e-2,)}
    cases = [
        (name, n, GROWING, [1e-6, seconds])
        for name, each in longest.items()
        for n, seconds in zip((100, 1_000, 10_000), each, strict=False)
    ]
    table = pd.DataFrame(cases, columns=["structure", "vertices", "order", "samples"])
    monkeypatch.setattr(real_time, "_cases", lambda run, subject: table)
    assert re.findall(r"<li>(.*)</li>", real_time.keeping_up(None)) == [
        "on up to 10,000 vertices, the most that were measured, with Half-Edge: an edit took up to "
        "3.0 ms at 10,000.",
        "on up to 100 vertices, with Indexed: an edit took up to 40 ms at 1,000.",
        "on no mesh, with Plankton: an edit took up to 30 ms at 100.",
    ]


def test_a_run_in_which_nothing_around_a_face_was_asked_compiled_says_so(monkeypatch):
    rays = [(what, how) for what in (RAY, FOLLOWING) for how in (REBUILT, REFITTED)]
    cases = [("half_edge", 400, *it, 2.0) for it in [*rays, (NEIGHBORS, None)]]
    columns = ["structure", "vertices", "subject", "order", "cost"]
    table = pd.DataFrame(cases, columns=columns)
    monkeypatch.setattr(real_time, "medians", lambda run, experiment, scale: table)
    with pytest.raises(MissingError, match="compiled"):
        real_time.picks_in_words(None)


@pytest.mark.parametrize("name", ["teapot", "torus:100", "torus:70000"])
def test_what_a_mesh_weighs_is_what_its_arrays_do(monkeypatch, name):
    mesh = hem.find_mesh(name)
    s = structures.build("half_edge", mesh)
    render = hem.RenderMesh(s)
    held, n = sum(s.memory().values()), len(mesh.points)
    where = pd.MultiIndex.from_tuples([(name, n, len(mesh.triangles))])
    table = pd.DataFrame({"half_edge": [held]}, index=where)
    monkeypatch.setattr(real_time, "bytes_held", lambda run, width: table)
    told = real_time.weights(None).rows[1][3:]
    assert {len(it.replace(".", "").lstrip("0")) for it in told} == {3}
    drawn, beside, whole = map(float, told)
    uploaded = np.zeros((n, 3 + 3 + 2), np.float32).nbytes
    indices = render.indices.astype(np.uint16 if n <= 65_536 else np.uint32)
    uploaded += indices.nbytes
    follows = render.points.nbytes + render.indices.nbytes
    expected = np.array([uploaded, follows, uploaded + follows + held]) / 1e6
    assert [drawn, beside, whole] == pytest.approx(expected, rel=5e-3)


def test_what_was_not_measured_is_named_as_what_it_is(base_run):
    cases = base_run.cases[base_run.cases["experiment"] != "bench_real_time"]
    run = replace(base_run, cases=cases)
    for show, what in ((real_time.frames, "single edits"), (real_time.compactions, "dead")):
        with pytest.raises(MissingError, match=what):
            show(run)

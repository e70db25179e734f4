"""Laws of advice: times are what a run says times how often, and what does not suit is not told."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import hem
from experiments.advice import (
    NEEDS,
    PRESETS,
    Advice,
    Limits,
    Measured,
    Prices,
    Row,
    Workload,
    advise,
    find_workload,
    predict,
    recorded,
)
from experiments.advice.advise import BUILT_OF_OBJECTS
from experiments.advice.workload import KNOWN
from experiments.cli.check import BASELINE
from experiments.harness import IRREGULAR
from experiments.regression import RUN
from experiments.runs import Run, load
from hem.contract import ANEW, QUERIES
from hem.contract.recording import COMPILED as COMPILED_CODE
from hem.contract.recording import PYTHON
from structures import REGISTRY, build
from tests.experiments.cli.calls import hem as command
from tests.experiments.made_runs import SIZES

COMPILED = [name for name, it in REGISTRY.items() if it.compiled]
MESH = hem.generate("torus", 1_000)
ASKED = Workload("asked", (Row("vertex_faces", 1_000.0),), builds=0)


@pytest.fixture(scope="module")
def run(base_run: Run) -> Run:
    return base_run


@pytest.fixture(scope="module")
def prices(run: Run) -> Prices:
    return Prices(run)


def names(found: Advice) -> list[str]:
    """The structures that could be taken, in their order."""
    return [it.forecast.structure for it in found.options]


def seconds(
    run: Run, structure: str, what: str, order: str, faces: int, of: str = "bench_queries"
) -> float:
    """The median of a case, from the table of cases itself."""
    found = run.cases.query(
        "experiment == @of and structure == @structure and subject == @what "
        "and order == @order and faces == @faces and family == 'torus'"
    )
    return float(np.median(found["samples"].iloc[0]))


@pytest.mark.parametrize("structure", COMPILED)
def test_what_was_measured_is_predicted_times_how_often(run, prices, structure) -> None:
    cases = run.cases.query("experiment == 'bench_queries' and structure == @structure")
    faces = int(cases["faces"].iloc[0])
    rows = Row("vertex_faces", 30), Row("face_faces", 5, in_order=1)
    found = predict(prices, Workload("mix", rows, builds=0), structure, faces)
    expected = 30 * seconds(run, structure, "vertex_faces", "random", faces)
    expected += 5 * seconds(run, structure, "face_faces", "consecutive", faces)
    assert found.seconds == pytest.approx(expected, rel=1e-6)
    assert found.low < found.seconds < found.high


@pytest.mark.parametrize("structure", COMPILED)
def test_an_edit_takes_what_it_took_and_neighbors_found_anew_where_they_are_kept(
    run, prices, structure
) -> None:
    kind, faces = REGISTRY[structure], SIZES[0]
    moved = "vertex_faces" if kind.searches_to_move else "face_vertices"
    for told, times in ((), 3), ((Row(ANEW, 5),), 5):
        rows = (Row("collapse_edge", 3), Row("move_vertex", 7), *told)
        found = predict(prices, Workload("edits", rows, builds=0), structure, faces)
        edits = {"split_face": 3, "flip_edge": times} if kind.rebuilds else {"collapse_edge": 3}
        expected = 7 * seconds(run, structure, moved, "random", faces)
        for edit, often in edits.items():
            once = seconds(run, structure, edit, "batched", faces, "bench_operations")
            expected += often * once
        assert found.seconds == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("what", "times", "faces"),
    [("split_face", 1_000, 3_000), ("collapse_edge", 500, 1_500), ("collapse_edge", 1e9, 250)],
)
def test_edits_are_those_of_the_mesh_half_way_through(prices, what, times, faces) -> None:
    found = predict(prices, Workload("edits", (Row(what, times),), builds=0), "indexed", 2_000)
    assert found.seconds == pytest.approx(times * prices.price("indexed", what, faces).seconds)


def test_the_slowest_edit_takes_what_it_alone_would(prices: Prices) -> None:
    edits, asked = ("split_face", "collapse_edge"), (Row(it, 1) for it in QUERIES)
    found = advise(prices, Workload("edited", (*map(Row, edits, (1, 1)), *asked)), MESH)
    for it in found.options:
        once = (Workload("once", (Row(edit, 1, caller=PYTHON),), builds=0) for edit in edits)
        alone = [predict(prices, only, it.forecast.structure, 2_000).seconds for only in once]
        assert it.edit == pytest.approx(max(alone), rel=0.01)


def test_building_is_timed_until_it_answers() -> None:
    measured, name = load(BASELINE / RUN), "indexed_adjacency"
    built = measured.cases.query(
        "experiment == 'bench_build' and structure == @name and order == 'until it answers'"
    )
    case = built[built["family"] == "torus"].iloc[0]
    expected = pytest.approx(np.median(case["samples"]))
    assert Prices(measured).build(name, case["faces"]).seconds == expected


def test_a_mix_is_as_unsure_as_what_is_least_sure_of_it(prices: Prices) -> None:
    for query in QUERIES:
        one, mix, other = (prices.price("half_edge", query, 2_000, it).spread for it in (0, 0.5, 1))
        assert mix == max(one, other) > 0


def test_prices_grow_between_sizes_as_at_them(prices: Prices) -> None:
    costs = [prices.price("indexed", "vertex_faces", n).seconds for n in (1e3, 3e3, 1e4, 1e6)]
    assert costs == sorted(costs)


def test_a_move_that_takes_more_work_on_a_larger_mesh_costs_more_there() -> None:
    measured, sizes = Prices(load(BASELINE / RUN)), (1_000, 16_000)
    for name in COMPILED:
        meshes = (build(name, hem.generate("torus", n), compiled=False) for n in sizes)
        few, many = (s.operation_work("move_vertex", 7) for s in meshes)
        low, high = (measured.price(name, "move_vertex", 2 * n).seconds for n in sizes)
        assert (high > 4 * low) == (many > 4 * few), name


def test_a_call_from_python_costs_an_operation_more_than_a_query(prices: Prices) -> None:
    def longer(name: str, what: str) -> float:
        one, many = (prices.price(name, what, 2_000, caller=it) for it in (PYTHON, COMPILED_CODE))
        return one.seconds - many.seconds

    for name in COMPILED:
        assert 0 < longer(name, "vertex_faces") < longer(name, "split_face")
        assert longer(name, "split_face") == pytest.approx(3e-6, rel=0.01)  # one by one, in the run
    for name in REGISTRY.keys() - COMPILED:
        assert longer(name, "vertex_faces") == 0  # Python asks them in any case


def test_the_least_time_comes_first_and_all_that_suit_are_told(prices: Prices) -> None:
    found = advise(prices, ASKED, MESH)
    times = [it.forecast.seconds for it in found.options]
    assert times == sorted(times)
    assert set(names(found)) == set(REGISTRY)
    assert not found.refused


@pytest.mark.parametrize("need", NEEDS)
def test_every_structure_is_an_option_or_refused_with_a_reason(prices: Prices, need: str) -> None:
    found = advise(prices, ASKED, MESH, needs=[need])
    assert sorted([*names(found), *found.refused]) == sorted(REGISTRY)
    assert all(found.refused.values())
    assert found.refused == advise(prices, ASKED, MESH, needs=[need, need]).refused


def test_needs_follow_from_what_structures_declare(prices: Prices) -> None:
    found = advise(prices, ASKED, MESH, needs=["polygons"])
    assert set(names(found)) == {name for name, it in REGISTRY.items() if it.holds_polygons}


def test_what_the_run_has_not_measured_is_no_option(run: Run) -> None:
    without = Prices(replace(run, cases=run.cases.query("structure != 'half_edge'")))
    for workload in (ASKED, PRESETS["edited"]):
        told = advise(without, workload, MESH)
        assert told.refused["half_edge"] == "the run has not measured it"
        assert "half_edge" not in names(told)


def test_limits_refuse_what_takes_more(prices: Prices) -> None:
    free = advise(prices, PRESETS["edited"], MESH)
    bytes_of = {it.forecast.structure: it.bytes for it in free.options}
    middle = sorted(bytes_of.values())[3]
    found = advise(prices, PRESETS["edited"], MESH, Limits(bytes=middle))
    assert set(names(found)) == {name for name, it in bytes_of.items() if it <= middle}
    assert not advise(prices, PRESETS["edited"], MESH, Limits(edit=1e-12)).options


def test_a_run_without_operations_tells_so_and_refuses_where_edits_are_limited(run: Run) -> None:
    queries = replace(run, cases=run.cases.query("experiment == 'bench_queries'"))
    edited = Workload("edited", (Row("vertex_faces", 10.0), Row("split_face", 1.0)))
    found = advise(Prices(queries), edited, MESH)
    assert len(found.options) == len(REGISTRY)
    assert all({"split_face", "build"} <= set(it.forecast.untold) for it in found.options)
    limited = advise(Prices(queries), edited, MESH, Limits(edit=1.0))
    assert limited.options == []
    assert all("does not tell what an edit takes" in why for why in limited.refused.values())


def test_a_structure_of_which_less_is_told_is_no_option(run: Run) -> None:
    partly = run.cases.query("experiment != 'bench_operations' or structure != 'half_edge'")
    found = advise(Prices(replace(run, cases=partly)), PRESETS["edited"], MESH)
    assert "half_edge" not in names(found)
    assert "the run does not tell what" in found.refused["half_edge"]
    assert found.options


def test_who_is_behind_is_told_what_costs_it_most_beside_the_best(prices: Prices) -> None:
    rows = Row("face_vertices", 1.0, "face"), Row("vertex_faces", 1_000.0)
    found = advise(prices, Workload("mixed", rows, builds=0), MESH)
    first, behind = found.options[0], {it.forecast.structure: it for it in found.options}
    assert first.behind == ""
    assert behind["indexed"].behind == "vertex_faces"  # it searches


def test_bytes_are_those_of_the_structure(prices: Prices) -> None:
    for it in advise(prices, ASKED, MESH).options:
        assert it.bytes == sum(build(it.forecast.structure, MESH).memory(names=True).values())


@pytest.mark.parametrize("corners", [3, 4])
def test_no_structure_is_an_option_that_cannot_hold_the_mesh(prices: Prices, corners: int) -> None:
    torus = hem.generate("torus", BUILT_OF_OBJECTS)
    extra, (a, b, c), *others = len(torus.points), *torus.triangles.tolist()
    points = np.vstack([torus.points, torus.points[:1] + 1])
    faces = {3: [(a, b, c), (a, b, extra), *others], 4: [(a, extra, b, c), *others]}[corners]
    mesh = hem.PolygonMesh(points, faces)
    given = mesh.triangulated() if corners == 3 else mesh
    for name in names(advise(prices, ASKED, given)):
        build(name, given)


def test_a_program_s_own_part_is_what_its_measurement_leaves(prices: Prices) -> None:
    alone = predict(prices, ASKED, "half_edge", 2_000).seconds
    known = replace(ASKED, measured=Measured("half_edge", 1_000, alone + 0.25))
    for name in COMPILED:
        whole, counted = (predict(prices, it, name, 2_000).seconds for it in (known, ASKED))
        assert whole - counted == pytest.approx(0.25)


@pytest.mark.parametrize("name", COMPILED)
def test_what_was_measured_stays_first_until_something_is_a_tenth_quicker(
    prices: Prices, name: str
) -> None:
    alone = predict(prices, ASKED, name, 2_000).seconds
    for own in (0.0, 1.0):  # beside a second of its own, all are alike
        known = replace(ASKED, measured=Measured(name, 1_000, alone + own))
        found = advise(prices, known, MESH)
        assert found.refused.keys() == REGISTRY.keys() - COMPILED  # as the whole was compiled
        seconds = {it.forecast.structure: it.forecast.seconds for it in found.options}
        stays = seconds[name] <= 1.1 * min(seconds.values())
        assert stays or own == 0.0
        assert names(found)[0] == (name if stays else min(seconds, key=seconds.__getitem__))
        after = [it.forecast.seconds for it in found.options[1:]]
        assert after == sorted(after)


def test_a_mesh_has_the_prices_of_meshes_as_regular_as_it_is(run: Run) -> None:
    turned = hem.TriangleMesh(MESH.points, _begun_anywhere(MESH.triangles))
    assert advise(Prices(run), ASKED, turned).regular  # as there are no others
    dearer = run.cases.query("experiment == 'bench_queries' and family == 'torus'").copy()
    dearer["family"], dearer["samples"] = IRREGULAR, dearer["samples"].map(lambda it: 3 * it)
    both = Prices(replace(run, cases=pd.concat([run.cases, dearer], ignore_index=True)))
    regular, other = advise(both, ASKED, MESH), advise(both, ASKED, turned)
    assert (regular.regular, other.regular) == (True, False)
    costs = {it.forecast.structure: it.forecast.seconds for it in regular.options}
    for it in other.options:
        assert it.forecast.seconds == pytest.approx(3 * costs[it.forecast.structure], rel=0.01)
    # What was measured on regular meshes alone has the price of those.
    case = "half_edge", "split_face", 2_000
    assert both.irregular.price(*case) == both.price(*case)


def _begun_anywhere(triangles: np.ndarray) -> np.ndarray:
    """The same triangles, each from one of its corners on at random."""
    begin = np.random.default_rng(3).integers(3, size=(len(triangles), 1))
    return np.take_along_axis(triangles, (begin + np.arange(3)) % 3, axis=1)


def test_more_of_each_element_is_asked_of_a_larger_mesh(prices: Prices) -> None:
    each = Workload("each", (Row("face_vertices", 2, each="face", in_order=1),), builds=0)
    flat = prices.price("half_edge", "face_vertices", 20_000, 1.0).seconds
    assert predict(prices, each, "half_edge", 20_000).seconds == pytest.approx(40_000 * flat)


def test_rows_come_after_each_build(prices: Prices) -> None:
    rows = Row("vertex_faces", 100.0), Row("split_face", 2.0, per="frame")
    once, thrice = (
        predict(prices, Workload("built", rows, frames=5, builds=it), "half_edge", 2_000)
        for it in (1, 3)
    )
    assert thrice.parts == pytest.approx({it: 3 * cost for it, cost in once.parts.items()})


@pytest.mark.parametrize(
    ("preset", "times", "algorithm"),
    [
        ("simplified", 400, lambda s: hem.algorithms.simplify(s, vertices=s.n_vertices // 4)),
        ("remeshed", 400, lambda s: hem.algorithms.remesh(s, iterations=1)),
        ("edited", 100, lambda s: hem.algorithms.impacts(s, list(range(0, 800, 8)))),
    ],
)
def test_what_a_preset_says_of_an_algorithm_is_what_it_does(preset, times, algorithm) -> None:
    s = build("half_edge", hem.find_mesh("isosurface:400"))
    with hem.record(s) as recording:
        algorithm(s)
    does = {it.what: it.times / times for it in recording.rows}
    said = {it.what: it.times for it in PRESETS[preset].rows}
    assert said == pytest.approx(does, rel=0.1)


def test_a_flip_is_where_the_best_changes(prices: Prices) -> None:
    for workload in PRESETS.values():
        found = advise(prices, workload, MESH)
        for flip in found.flips:
            if flip["of"] == "vertices":
                then, faces = workload, 2 * flip["at"]
            else:
                then, faces = workload.more_edits(flip["at"]), found.faces
            costs = {it: predict(prices, then, it, faces).seconds for it in names(found)}
            assert min(costs, key=costs.__getitem__) == flip["best"]


def test_more_edits_have_more_neighbors_found_anew_and_no_more_asked() -> None:
    rows = [Row(it, 1) for it in ("vertex_faces", "move_vertex", "split_face", ANEW)]
    more = Workload("edited", tuple(rows)).more_edits(2)
    assert [it.times for it in more.rows] == [1, 1, 2, 2]


def test_limits_hold_where_the_best_changes_too(prices: Prices) -> None:
    free = advise(prices, ASKED, MESH)
    quickest, smallest = free.options[0], min(free.options, key=lambda it: it.bytes)
    found = advise(prices, ASKED, MESH, Limits(bytes=1.5 * smallest.bytes))
    assert names(found) == [smallest.forecast.structure]
    larger, smaller = sorted(found.flips, key=lambda it: -it["at"])
    assert (larger["best"], smaller["best"]) == ("", quickest.forecast.structure)
    assert 1_500 < larger["at"] < 1_500 * 1.3  # the sizes looked at grow by a quarter
    assert smaller["at"] * quickest.bytes / 1_000 <= 1.5 * smallest.bytes


def test_a_recording_is_a_workload_also_by_way_of_its_file(tmp_path) -> None:
    s = REGISTRY["half_edge"].build(MESH)
    with hem.record(s) as recording:
        s.vertex_faces(np.arange(500))
        s.split_face(3, (0, 0, 0))
    recording.save(tmp_path / "mine.csv", each="vertex")
    mine, same = find_workload(str(tmp_path / "mine.csv")), recorded(recording, "mine", "vertex")
    assert mine.title == same.title
    assert mine.builds == same.builds == 0
    for one, other in zip(mine.rows, same.rows, strict=True):
        assert replace(one, times=other.times) == other
        assert one.times == pytest.approx(other.times, rel=1e-4)


ASKING = '[[rows]]\nwhat = "vertex_faces"\ntimes = 1\n'


def measured(structure: str, vertices: object) -> str:
    table = f'[measured]\nstructure = "{structure}"\nvertices = {vertices}\nseconds = 9\n'
    return ASKING + table


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("title = 3\n", "title is a text, not 3"),
        ('title = "mine"\n', "no rows"),
        ("rows = 3\n", "no rows"),
        ("rows = []\nspeed = 3\n", "speed is nothing that a workload has"),
        ('[[rows]]\nwhat = "vertex_face"\ntimes = 1\n', "row 1: what is 'vertex_face'; there are"),
        ('[[rows]]\nwhat = "vertex_faces"\ntimes = -1\n', "row 1: times is a number from 0 on"),
        (f"{ASKING}in_order = 1.5\n", "row 1: .*in_order a share from 0 to 1"),
        ('[[rows]]\nwhat = "vertex_faces"\ntime = 1\n', "row 1: nothing is called 'time' and"),
        ("what\n", "Expected '='"),
        (f"frames = -5\n{ASKING}", "frames is a number from 0 on, not -5"),
        (f'builds = "x"\n{ASKING}', "builds is a number from 0 on, not 'x'"),
        (f"measured = 3\n{ASKING}", r"\[measured\] is a table; there are structure"),
        (f"{ASKING}[measured]\nseconds = 1\n", r"\[measured\]: 'structure' is missing and 've"),
        (f'{ASKING}each = ["vertex"]\n', r"row 1: each is \['vertex'\]; there are '', 'vertex'"),
        (measured("nothing", 9), r"\[measured\]: no structure is called 'nothing'; there are"),
        (measured("indexed", '"x"'), r"\[measured\]: vertices is a number from 0 on, not 'x'"),
        (measured("half_edge_objects", 9), r"no structure is called 'half_edge_objects'; there"),
        (measured("indexed", "0"), r"\[measured\]: it was measured on a mesh of some vertices"),
        (measured("indexed", "nan"), r"\[measured\]: vertices is a number from 0 on, not nan"),
    ],
)
def test_a_file_that_is_wrong_is_told_with_its_place(tmp_path, text: str, said: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(ValueError, match=rf"mine\.toml: .*{said}"):
        find_workload(str(path))


def test_what_a_spreadsheet_puts_before_the_first_line_is_passed_over(tmp_path) -> None:
    (tmp_path / "mine.csv").write_text("what,times\nvertex_faces,3\n", "utf-8-sig")
    (tmp_path / "mine.toml").write_text(ASKING, "utf-8-sig")
    for name in ("mine.csv", "mine.toml"):
        assert find_workload(str(tmp_path / name)).rows[0].what == "vertex_faces"


def test_a_csv_is_known_by_its_extension_in_any_case_and_told_where_it_is_none(tmp_path) -> None:
    (tmp_path / "MINE.CSV").write_text("what,times\nvertex_faces,3\n")
    assert find_workload(str(tmp_path / "MINE.CSV")).rows == (Row("vertex_faces", 3),)
    (tmp_path / "no.csv").write_text("what,times\n" + "x" * 200_000)
    with pytest.raises(ValueError, match=r"no\.csv: field larger than"):
        find_workload(str(tmp_path / "no.csv"))


def test_a_line_of_a_csv_that_is_too_long_is_told_with_its_place(tmp_path) -> None:
    (tmp_path / "mine.csv").write_text("what,times\nvertex_faces,1\nface_faces,1,random\n")
    with pytest.raises(ValueError, match=r"mine\.csv: row 2: .*'a cell too many'; there are what"):
        find_workload(str(tmp_path / "mine.csv"))


def told(*arguments: str) -> tuple[int, str]:
    return command("advise", *arguments, width=300)


def test_the_command_says_what_it_rests_on_and_tells_programs_the_same(run: Run) -> None:
    folder = str(run.folder)
    code, text = told("torus:1000", "--workload", "edited", "--run", folder)
    assert code == 0
    assert folder in text
    code, text = told("torus:1000", "--workload", "edited", "--run", folder, "--json")
    data = json.loads(text)
    assert code == 0
    told_here = names(advise(Prices(run), PRESETS["edited"], MESH))
    assert [it["structure"] for it in data["options"]] == told_here


def test_the_command_says_that_the_machine_was_too_busy(run: Run, monkeypatch) -> None:
    noise = run.cases["noise"].map(lambda it: it and {**it, "off_cpu": 1.0})
    busy = replace(run, cases=run.cases.assign(noise=noise))
    asked = "torus:1000", "--run", str(run.folder)
    assert "too busy" not in told(*asked)[1]
    monkeypatch.setattr("experiments.runs.load", lambda folder: busy)
    assert "The machine was too busy to judge by time" in told(*asked)[1]


def test_the_command_says_to_stay_where_nothing_is_a_tenth_quicker(run: Run, tmp_path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(measured("winged_edge", 1000))
    code, text = told("torus:1000", "--workload", str(path), "--run", str(run.folder))
    assert code == 0
    assert "measured on Winged-Edge, and nothing is a tenth quicker: stay" in text


def test_a_folder_with_a_baseline_of_counters_alone_takes_prices_from_the_run_of_the_project(
    tmp_path, monkeypatch
) -> None:
    (tmp_path / "results/reference/counters").mkdir(parents=True)  # as hem baseline update does
    usual = told("torus:1000")
    monkeypatch.chdir(tmp_path)
    assert told("torus:1000") == usual
    assert usual[0] == 0


def test_a_workload_that_never_ends_is_refused(tmp_path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(f'frames = 1e300\n{ASKING.replace("= 1", "= 1e300")}per = "frame"\n')
    assert told("torus:1000", "--workload", str(path)) == (
        1, "hem: 'mine' takes longer than a number tells: ask for less\n"
    )  # fmt: skip


def test_structures_with_the_same_reason_are_told_together(tmp_path) -> None:
    lines = [f"v {x} {y} {z}" for x, y, z in np.eye(5, 3)]
    lines += ["f 1 2 3", "f 2 1 4", "f 1 2 5"]  # three at an edge
    path = tmp_path / "three.obj"
    path.write_text("\n".join(lines))
    code, text = told(str(path))
    assert code == 0
    assert text.count("no manifold surface") == 1
    assert "Winged-Edge, Half-Edge" in text
    assert "a command --repair" in text


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["torus:1000", "--bytes", "1"], 3, "no structure suits"),
        (["torus:1000", "--workload", "painted"], 1, "there is no workload 'painted'"),
        (["torus:1000", "--need", "speed"], 1, "no need is called 'speed'; there are edges"),
        (["torus:1000", "--worst-edit", "-1"], 1, "that an edit may take, are from 0 on"),
        (["torus:1000", "--bytes", "nan"], 1, "the most bytes, and"),
        (["torus:1000", "--run", "nowhere"], 1, "nowhere holds no run"),
        (["dragon"], 1, "there is no model 'dragon'"),
    ],
)
def test_mistakes_are_told_and_so_is_that_nothing_suits(arguments, code, said) -> None:
    found = told(*arguments)
    assert found[0] == code
    assert said in found[1]


def test_all_that_a_workload_may_count_has_a_price(prices: Prices) -> None:
    rows = tuple(Row(name, 1) for name in KNOWN)
    assert not predict(prices, Workload("all", rows, builds=0), "half_edge", 2_000).untold

"""What `hem history` says is what is in the file, and a mistake gets one clear line."""

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

from experiments.regression import Trends, append_run, read_history
from experiments.report import about_history, frame_table, history_tables
from experiments.report.figures import history as history_figures
from tests.experiments.cli.calls import hem, mistake, output_of, words
from tests.experiments.histories import CLAIM, MACHINES, line, stepped
from tests.extent import waiting_for

PEERS = Path(__file__).parents[3] / "results/reference/peers"
NAME = "half_edge/vertex_faces"


@pytest.fixture(scope="module")
def kept(base, tmp_path_factory):
    """30 runs with one step in one claim, at the 16th."""
    return stepped(tmp_path_factory.mktemp("history") / "history.jsonl", base)


@pytest.fixture(scope="module")
def trends(kept):
    """What they say."""
    return Trends(read_history(kept))


@pytest.fixture(scope="module")
def mixed(base, tmp_path_factory):
    """Runs of two machines by turns, the second of which takes twice the time."""
    path = tmp_path_factory.mktemp("history") / "mixed.jsonl"
    for k in range(24):
        made = line(base, k, MACHINES[k % 2])
        for claim in made["claims"].values():
            if "relative" in claim:
                claim["relative"] *= 1 + k % 2
        append_run(made, path)
    return path


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["show", "--file", "none.jsonl"], "there is no run in none.jsonl; begin with: hem study"),
        (["show", "half_edgy", "--file", "KEPT"], "no claim 'half_edgy'; say one of"),
        (["show", "--machine", "ffff", "--file", "KEPT"], "no run is of machine 'ffff'; there are"),
        (["show", "--profile", "slow", "--file", "KEPT"], "no run is of preset 'slow'"),
        (["show", "--file", "."], "Is a directory"),
        (["add"], "there is no run in results/runs; start one with: hem study"),
        (["add", "nowhere"], "nowhere holds no run"),
        (["add", str(PEERS)], "measured nothing of which anything is claimed"),
    ],
)
def test_a_mistake_gets_one_clear_line_and_an_exit_code(
    kept, arguments, said, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    arguments = [str(kept) if it == "KEPT" else it for it in arguments]
    assert said in mistake("history", *arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_preset_that_is_named_in_full_is_that_one_beside_those_of_a_mesh_of_ones_own(
    base, tmp_path
):
    path = tmp_path / "history.jsonl"
    for k, preset in enumerate(("quick", "quick on model.ply")):
        append_run({**line(base, k), "profile": preset}, path)
    output = output_of("history", "show", "--preset", "quick", "--file", str(path), "--json")
    assert [it["profile"] for it in json.loads(output)["runs"]] == ["quick"]


def test_so_many_runs_of_a_claim_are_shown_that_have_it(base, tmp_path):
    path, first, newest = tmp_path / "history.jsonl", line(base, 0), line(base, 1)
    others = {name: it for name, it in newest["claims"].items() if NAME not in name}
    for made in (first, {**newest, "claims": others}):
        append_run(made, path)
    asked = "history", "show", NAME, "--last", "1", "--file", str(path)
    output, told = output_of(*asked), json.loads(output_of(*asked, "--json"))
    assert first["commit"][:7] in output
    assert newest["commit"][:7] not in output
    assert {it["run"] for it in told["figures"]} == {0}


def test_of_a_history_at_least_one_run_is_shown(kept):
    code, output = words("history", "show", "--last", "0", "--file", str(kept))
    assert code == 2
    assert "Invalid value for '--last'" in output


def test_a_run_is_added_once_and_is_there_then(base_folder, base_run, tmp_path):
    path = str(tmp_path / "history.jsonl")
    assert "Added" in output_of("history", "add", str(base_folder), "--file", path)
    output = output_of("history", "add", str(base_folder), "--file", path)
    assert "Already there" in output
    assert "has 1 runs" not in output
    assert len(read_history(tmp_path / "history.jsonl").runs) == 1
    assert base_run.meta["commit"][:7] in output_of("history", "show", "--file", path)


def test_brackets_in_a_path_and_in_the_name_of_a_processor_are_told_as_they_are(base, tmp_path):
    path, made = tmp_path / "[bold] [" / "h].jsonl", line(base, 1)
    made["machine"]["cpu"] = "Fast [/x] One"
    append_run(made, path)
    output = output_of("history", "show", "--file", str(path))
    assert f"Runs in {path}: 1 " in output
    assert "cores of Fast [/x] One." in output


def test_of_a_run_of_several_machines_it_is_told_how_many_they_are(base, tmp_path):
    path, made = tmp_path / "history.jsonl", line(base, 1)
    made["machine"] = {"id": "cccc3333", "cpu": "2 machines", "machines": ["a", "b"]}
    append_run(made, path)
    assert "Machine cccc3333: 2 machines." in output_of("history", "show", "--file", str(path))


def test_damage_is_told_of_beside_what_is_whole(base, tmp_path):
    path = tmp_path / "history.jsonl"
    append_run(line(base, 1), path)
    with path.open("a") as file:
        file.write('{"schema": 2, "comm')
    output = output_of("history", "show", "--file", str(path))
    assert "line 2 is cut short or damaged" in output
    assert line(base, 1)["commit"][:7] in output


def test_the_changes_are_those_that_were_made_and_no_others(trends):
    changes = trends.changes
    assert set(changes["claim"]) == {CLAIM}
    exact = changes[changes["machine"] == ""][["measure", "run"]]
    assert set(exact.itertuples(index=False, name=None)) == {("verdict by work", 15), ("work", 15)}
    (time,) = changes[changes["measure"] == "time"].to_dict("records")
    assert time["machine"] == MACHINES[0]
    assert abs(time["run"] - 15) <= 1


def test_show_marks_the_commit_at_which_work_time_and_verdict_changed(kept, base):
    output = output_of("history", "show", NAME, "--file", str(kept))
    assert output.count("≠") == 2  # once in the legend
    assert "24 ▲+20.0%" in output
    assert "✗≠" in output
    output = output_of("history", "show", "--file", str(kept))
    assert "✓ → ✗" in output
    assert "20 → 24" in output
    output = output_of("history", "show", "half_edge", "--file", str(kept))
    assert line(base, 15)["commit"][:7] in output
    assert line(base, 14)["commit"][:7] not in output


def test_last_shows_the_newest_and_judges_by_all(kept):
    assert "24 ▲+20.0%" in output_of("history", "show", NAME, "--file", str(kept), "--last", "15")
    few = output_of("history", "show", NAME, "--file", str(kept), "--last", "3")
    assert "▲+20.0%" not in few


def test_json_has_every_figure_and_change(kept):
    content = json.loads(hem("history", "show", NAME, "--file", str(kept), "--json")[1])
    work = [it for it in content["figures"] if it["measure"] == "work"]
    assert [it["value"] for it in work] == 15 * [20.0] + 15 * [24.0]
    assert [it["run"] for it in work if it["after"] is not None] == [15]
    assert len(content["runs"]) == 30
    assert {it["measure"] for it in content["changes"]} >= {"work", "verdict by work"}


def test_times_of_two_machines_are_two_series_and_their_difference_is_no_step(mixed, monkeypatch):
    trends = Trends(read_history(mixed))
    assert trends.changes.empty
    mine = trends.figures[trends.figures["claim"] == CLAIM]
    runs = mine.groupby(["measure", "machine"])["run"].size().to_dict()
    assert [runs["time", machine] for machine in MACHINES] == [12, 12]
    assert runs["work", ""] == 24
    assert "Times are of one machine each" in output_of("history", "show", "--file", str(mixed))
    monkeypatch.chdir(mixed.parent)  # a longer name of it would be wrapped, as a title is
    output = output_of("history", "show", "--file", mixed.name, "--machine", "aaaa")
    assert MACHINES[1] not in output
    assert "mixed.jsonl: 12" in output


def test_times_of_a_run_on_too_busy_a_machine_are_not_compared_and_its_commit_is_marked(
    base, tmp_path
):
    path, busy = tmp_path / "history.jsonl", range(10, 15)
    for k in range(20):
        made = line(base, k) | ({"too_busy": k in busy} if k > 4 else {})  # older lines lack it
        made["claims"][CLAIM]["relative"] *= 3 if k in busy else 1
        made["claims"][CLAIM]["outcome_time"] = "undetermined" if k in busy else "consistent"
        append_run(made, path)
    trends = Trends(read_history(path))
    assert trends.changes.empty
    runs = trends.figures[trends.figures["claim"] == CLAIM].groupby("measure")["run"].agg(list)
    assert runs["time"] == runs["slope_time"] == [*range(10), *range(15, 20)]
    assert runs["work"] == list(range(20))
    output = output_of("history", "show", NAME, "--file", str(path))
    marked = [it for it in range(20) if f"{line(base, it)['commit'][:7]}~" in output]
    assert marked == list(busy)


@pytest.mark.parametrize("name", [NAME, "half_edge"])
def test_what_was_timed_on_too_busy_a_machine_alone_is_shown_as_not_told(base, tmp_path, name):
    path, made = tmp_path / "history.jsonl", line(base, 1) | {"too_busy": True}
    for claim in made["claims"].values():
        for counted in {"outcome", "work", "bytes"} & claim.keys():
            del claim[counted]
        claim["slopes"] = {}
    append_run(made, path)
    output = output_of("history", "show", name, "--file", str(path))
    assert "HEM vertex_faces – – –" in output or f"{made['commit'][:7]}~ –" in output


def test_slopes_step_where_they_left_a_level_by_more_than_their_last_digits(base, tmp_path):
    path, by_time = tmp_path / "history.jsonl", np.repeat([0.1, 0.9], 6) + np.tile([0.01, -0.01], 6)
    for k in range(12):
        made = line(base, k)
        slopes = {"work_faces": 0.004 * k, "time_faces": by_time[k]}
        made["claims"][CLAIM]["slopes"] = {axis: 3 * [float(it)] for axis, it in slopes.items()}
        append_run(made, path)
    changes = Trends(read_history(path)).changes[["measure", "run", "before", "after"]]
    assert changes.to_numpy().tolist() == [
        ["slope n_t", 3, "0", "0.012"],
        ["slope n_t", 6, "0.012", "0.024"],
        ["slope n_t, time", 6, "0.1", "0.9"],
        ["slope n_t", 9, "0.024", "0.036"],
    ]


def test_what_was_measured_on_other_sizes_is_not_compared(base, tmp_path):
    path = tmp_path / "history.jsonl"
    for k in range(4):
        made = line(base, k)
        made["claims"][CLAIM]["work_faces"] = 1000 if k < 2 else 2000
        made["claims"][CLAIM]["work"] = 10.0 if k < 2 else 20.0
        append_run(made, path)
    for k in (4, 5):
        append_run(line(base, k) | {"profile": "smoke"}, path)
    trends = Trends(read_history(path))
    work = trends.figures.query("claim == @CLAIM and measure == 'work' and comparable")
    assert work[work["preset"] == "quick"]["run"].tolist() == [2, 3]
    assert work[work["preset"] == "smoke"]["run"].tolist() == [4, 5]
    assert trends.changes.empty
    assert "Different presets are not compared" in output_of("history", "show", "--file", str(path))


@pytest.mark.parametrize("count", waiting_for([1, 30], [1, 2, 30]))
def test_figures_and_page_are_there_for_any_number_of_runs(base, tmp_path, count):
    trends = Trends(read_history(stepped(tmp_path / "history.jsonl", base, count)))
    figure = history_figures.by_commit(trends, "vertex_faces")
    _require_labels(figure)
    rings = [it for axes in figure.axes for it in axes.lines if it.get_gid() == "step"]
    crosses = [it for axes in figure.axes for it in axes.lines if it.get_gid() == "verdict"]
    assert bool(rings) == bool(crosses) == (count == 30)
    assert {it.yaxis.get_major_formatter()(1000) for it in figure.axes[1:]} == {"1k"}
    departures = history_figures.departures(trends)
    departures.draw_without_rendering()
    assert departures.axes[-1].get_ylabel() == "time beside what is usual"
    assert ("three at least" in about_history(trends)) == (count < 3)
    assert ("✓ → ✗" in set(history_tables.changes_frame(trends)["before → after"])) == (count == 30)
    page = frame_table(history_tables.runs_frame(trends))
    assert page.count("<tr") == count + 1


def test_a_change_in_a_table_that_is_not_drawn_leaves_the_others_drawn(base, tmp_path):
    path = tmp_path / "history.jsonl"
    for k, outcome in enumerate(("consistent", "violated")):
        made = line(base, k)
        made["claims"]["naming/indexed/split_by_corners"]["outcome"] = outcome
        append_run(made, path)
    figure = history_figures.departures(Trends(read_history(path)))
    assert not any(it.get_gid() for axes in figure.axes for it in axes.lines)


def _require_labels(figure: Figure) -> None:
    figure.draw_without_rendering()
    for axes in figure.axes:
        boxes = [text.get_window_extent() for text in axes.texts]
        assert boxes
        for i, box in enumerate(boxes):
            assert figure.bbox.x1 >= box.x1
            assert not any(box.overlaps(other) for other in boxes[i + 1 :])


def test_without_a_history_there_is_no_figure_but_what_to_do(tmp_path):
    trends = Trends(read_history(tmp_path / "none.jsonl"))
    assert "hem history add" in about_history(trends)
    with pytest.raises(ValueError, match="begin with: hem history add"):
        history_figures.by_commit(trends, "vertex_faces")


@pytest.mark.parametrize("claim", [None, CLAIM, "half_edge"])
@pytest.mark.parametrize("slopes", [False, True])
def test_the_tables_fit_80_columns_and_cut_no_figure(trends, capsys, claim, slopes):
    history_tables.show(trends, claim, Console(width=80), 5, slopes)
    output = capsys.readouterr().out
    assert max(map(len, output.splitlines())) <= 80
    assert "…" not in output
    assert "TNS: Triangle-Neighbor, WEM: Winged-Edge, HEM: Half-Edge" in output

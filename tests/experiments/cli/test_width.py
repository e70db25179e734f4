"""What is printed fits 80 columns, and no figure and no class is cut, however long they are."""

import re

import pytest
from rich.console import Console

from experiments.claims import judge_run
from experiments.regression import CaseKey, Change, Finding, Kind, Trends, append_run, read_history
from experiments.report import findings, history_tables, show_rows
from experiments.runs import load
from hem import FAMILIES
from structures import NAMED, NAMES
from tests.experiments.cli.calls import hem
from tests.experiments.histories import CLAIM, MACHINES, line
from tests.experiments.made_runs import LAWS, write_run
from tests.extent import OF_EACH_KIND, waiting_for

RANGE = r"\d…-?\d"
"""Two ends of an interval."""


def printed(*arguments: str) -> str:
    code, output = hem(*arguments, width=80)
    assert code == 0, output
    return require_fits(output)


def require_fits(text: str) -> str:
    assert max(map(len, text.splitlines())) <= 80, text
    assert "…" not in re.sub(RANGE, "", text), text
    return text


LEFT_OUT = set(NAMES) - set(OF_EACH_KIND)


@pytest.fixture(scope="module")
def violated(tmp_path_factory):
    """A run in which all of it grows as the square of the mesh."""
    folder = tmp_path_factory.mktemp("long") / "run"
    return write_run(folder, lambda *_: LAWS["O(n_t²)"], lambda _, it: it not in LEFT_OUT)


def test_the_table_shows_every_class_found(violated):
    text = printed("table", str(violated), "--all")
    claims = [it for it in judge_run(load(violated)) if it.claim.structure and it.verdicts]
    assert {it.found for it in claims if it.outcome.mark == "✗"}
    for judged in claims:
        assert judged.claim.title in text
        if judged.outcome.mark == "✗":
            marks = judged.outcome.mark + judged.outcome_time.mark
            assert f"{judged.claim.printed} {marks} {judged.found}" in text


def test_slopes_and_intervals_are_shown_when_asked_for(violated):
    assert not re.search(RANGE, printed("table", str(violated)))
    text = printed("table", str(violated), "--all", "--slopes")
    assert re.search(RANGE, text)
    assert "≤ O(n)" in text  # at most, where a scan finds more
    assert all(kind.title in text for name, kind in NAMED.items() if name not in LEFT_OUT)


@pytest.fixture(scope="module")
def large(base, tmp_path_factory):
    """The trends of two machines and presets, with large figures."""
    path = tmp_path_factory.mktemp("large") / "history.jsonl"
    for k in range(12):
        made = line(base, k, MACHINES[k % 2]) | {"profile": ("quick", "standard")[k // 6]}
        for figures in made["claims"].values():
            figures |= {it: figures[it] * 1e5 + k for it in ("work", "relative") if it in figures}
            figures["slopes"] = {
                key: [-it[0] - k, -it[1] - k, -it[2] - k]
                for key, it in figures.get("slopes", {}).items()
            }
        append_run(made, path)
    return Trends(read_history(path))


@pytest.mark.parametrize("claim", waiting_for([CLAIM, None], [CLAIM, "half_edge", None]))
@pytest.mark.parametrize("slopes", waiting_for([True], [True, False]))
def test_a_history_of_two_machines_and_presets_with_large_figures(large, capsys, claim, slopes):
    history_tables.show(large, claim, Console(width=80), None, slopes)
    text = require_fits(capsys.readouterr().out)
    if claim:
        assert "time" in text


def test_brackets_in_a_title_are_no_markup(capsys):
    show_rows(Console(width=80), [["name", "what a row tells"]], title="Runs in a[b]/[/c]")
    assert "Runs in a[b]/[/c]" in capsys.readouterr().out


def test_names_of_wide_signs_take_no_figure_its_place(capsys):
    name, *figures = "排序算法的运行时间测量值", "16 … 4096", "0.50", "O(√n)"
    show_rows(Console(width=40), [["function", "sizes", "slope", "class"], [name, *figures]])
    text = capsys.readouterr().out
    assert all(f" {it} " in text for it in (name, *figures)), text


def test_the_meshes_and_their_sizes():
    _, output = hem("meshes", "--size", "100000", width=80)
    assert max(map(len, output.splitlines())) <= 80
    text = " ".join(output.split())
    assert all(it.what in text and it.sizes in text for it in FAMILIES.values())
    heads = ("name", "vertices", "edges", "faces", "border", "valence")
    assert text.count(" ".join(heads)) == 2
    assert "torus 100,000 300,000 200,000 0 6…6" in text


def test_the_bytes_of_a_mesh_stand_in_one_row_per_structure():
    _, text = hem("info", "bunny", width=80)
    for name in NAMES:
        assert len(re.findall(rf"^ {NAMED[name].title} +[\d,.]+ ", text, re.MULTILINE)) == 1


@pytest.mark.parametrize("width", waiting_for([40], [40, 60, 80]))
def test_no_table_cuts_a_name_or_a_figure_where_it_is_narrow(tmp_path, width):
    costs = tmp_path / "costs.csv"
    costs.write_text(
        "n,a function of a long name\n" + "".join(f"{n},{n}\n" for n in (1, 9, 99, 999))
    )
    commands = {
        ("info", "torus:100000"): "12,000,000",
        ("meshes", "--size", "100000"): "100,000",
        ("judge", str(costs), "--expected", "O(n)"): "consistent",
        ("advise", "torus:1000", "--workload", "remeshed"): "Half-Edge Objects",
    }
    for command, said in commands.items():
        _, output = hem(*command, width=width)
        assert said in output
        cut = re.sub(rf"{RANGE}|nine of ten|\d (µs|ms|s)? ?… \d|: \d … \d", "", output)
        assert not re.search(r"\w…", cut), cut


def test_the_lines_of_a_check(capsys):
    case = CaseKey("bench_queries", "winged_edge", "vertex_vertices", "isosurface", 1_000_000, 4096)
    long = "a reason that is told at some length, so that it reaches beyond the end of a line"
    found = [
        Finding(Change.WORSE, Kind.TIME, case, "12.345 [1, 2]", "67.891 [3, 4]", long, "hem study"),
        Finding(Change.WORSE, Kind.WORK, case, "1, 2, 3", "4, 5, 6", claim=5 * "Table 1, a claim "),
    ]
    findings.show(found, [3 * long], Console(width=80))
    text = " ".join(require_fits(capsys.readouterr().out).split())
    assert f"12.345 [1, 2] → 67.891 [3, 4] ({long})" in text
    assert "1, 2, 3 → 4, 5, 6" in text

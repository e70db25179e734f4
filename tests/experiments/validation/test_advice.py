"""Laws of the figures on advice: errors are those of the rows, and so are the committed ones."""

import json
from pathlib import Path
from statistics import median
from typing import Any

import pytest

import hem
import structures
from experiments.validation import advice

KEPT = Path("results/reference/advice.json")
OTHERS = [name for name in advice.COMPILED if name != advice.BASE]


def row(*pairs: tuple[str, float, float | None]) -> dict[str, Any]:
    """Of each structure what was predicted, and what it took."""
    told = [
        {
            "structure": it, "predicted": one, "counted": one / 4, "taken": two,
            "low": one / 2, "high": one * 2,
        }
        for it, one, two in pairs
    ]  # fmt: skip
    return {"program": "made up", "mesh": "none", "faces": 1, "structures": told}


def test_errors_leave_out_what_was_learned_from_and_what_was_not_run() -> None:
    a, b = OTHERS[:2]
    found = advice.figures([row((advice.BASE, 1, 9), (a, 1, 2), (b, 3, None))])
    assert found["predictions"] == 1
    assert found["median_error"] == pytest.approx(0.5)
    assert found["median_error_counted"] == pytest.approx(0.875)
    assert found["within_30_percent"] == 0
    assert found["within_interval"] == 1


@pytest.mark.parametrize(("second", "right"), [(1.05, True), (1.2, False), (0.5, False)])
def test_the_best_is_told_where_it_is_at_most_a_tenth_behind(second: float, right: bool) -> None:
    a, b = OTHERS[:2]
    chosen, other = (second, 1.0) if second > 1 else (1.0, second)
    found = advice.figures([row((a, 1, chosen), (b, 2, other))])
    assert found["winner_right"] == right


@pytest.mark.parametrize(("predicted", "among"), [(1.05, True), (1.2, False)])
def test_the_best_is_among_those_alike_up_to_a_tenth(predicted: float, among: bool) -> None:
    a, b = OTHERS[:2]
    found = advice.figures([row((a, 1, 3), (b, predicted, 1))])
    assert found["best_among_alike"] == among


@pytest.mark.parametrize(("predicted", "right"), [(1.05, True), (1.2, False)])
def test_what_was_timed_is_told_as_long_as_nothing_is_a_tenth_quicker(
    predicted: float, right: bool
) -> None:
    found = advice.figures([row((advice.BASE, predicted, 1), (OTHERS[0], 1, 2))])
    assert found["winner_right"] == right


@pytest.mark.parametrize("program", [it for it in advice.PROGRAMS if it.endswith("Python")])
def test_a_program_does_the_same_where_neighbors_are_searched_for(program: str) -> None:
    left = []
    for name in (advice.BASE, "indexed"):
        s = structures.build(name, hem.find_mesh("torus:600"))
        advice.PROGRAMS[program].run(s)
        left.append((s.n_vertices, s.n_faces))
    assert left[0] == left[1]


def test_a_program_on_two_meshes_is_one_row_of_the_table() -> None:
    a, b = OTHERS[:2]
    rows = [row((a, 1, 1), (b, 2, 2)), row((a, 1, 1), (b, 2, 2))]
    assert len(advice.table({"rows": rows})) == 1


def test_the_kept_figures_are_those_of_their_rows() -> None:
    kept = json.loads(KEPT.read_text())
    assert {key: kept[key] for key in advice.figures(kept["rows"])} == advice.figures(kept["rows"])
    assert kept["workloads"] >= 20
    errors = [
        abs(it["predicted"] / it["taken"] - 1)
        for row in kept["rows"]
        for it in row["structures"]
        if it["taken"] and it["structure"] != kept["learned_from"]
    ]
    assert kept["median_error"] == pytest.approx(median(errors))
    assert advice.in_words(kept).startswith(f"Of {len(kept['rows'])} workloads")

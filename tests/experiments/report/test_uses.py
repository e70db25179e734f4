"""Laws of the recommendations: the least cost comes first, and only what suits is compared."""

import re

import numpy as np
import pytest

from experiments.report import MissingError, uses
from experiments.runs import Run
from hem.contract import QUERIES
from structures import REGISTRY

COMPILED = {name for name, it in REGISTRY.items() if it.compiled}


def bytes_of(run: Run, name: str) -> float:
    """Per vertex, on the largest mesh, from the cases themselves."""
    cases = run.cases.query(
        "experiment == 'bench_memory' and reference_bytes == 4 and structure == @name"
    )
    largest = cases.nlargest(1, "vertices").iloc[0]
    return largest["samples"][0] / largest["vertices"]


def test_what_is_smallest_comes_first_and_all_that_are_compiled_are_beside_it(run: Run) -> None:
    found = uses.ranking(run, "drawn")
    assert set(found.index) == COMPILED
    assert found.tolist() == pytest.approx(sorted(bytes_of(run, name) for name in COMPILED))
    assert found.is_monotonic_increasing


@pytest.mark.parametrize("name", uses.USES)
def test_only_structures_that_suit_are_compared(run: Run, name: str) -> None:
    found = uses.ranking(run, name)
    assert set(found.index) <= {it for it in COMPILED if uses.USES[name].suits(REGISTRY[it])}


def test_whoever_is_not_compared_is_named(run: Run) -> None:
    text = uses.left_out()
    for it in REGISTRY.values():
        for use in uses.USES.values():
            told = re.search(f"for (all uses|“{use.title}”)[^;.]* {it.title},", text)
            assert bool(told) == (not (it.compiled and use.suits(it))), (it.title, use.title)


def test_what_is_asked_is_compared_by_what_the_eight_queries_of_table_1_take(run: Run) -> None:
    cases = run.cases.query("experiment == 'bench_queries' and order == 'random'")
    cases = cases[cases["valence"].isna() & (cases["subject"] != "vertex_vertices")]
    found = uses.ranking(run, "asked")
    for name in ("indexed", "half_edge"):
        mine = cases[(cases["structure"] == name) & (cases["vertices"] == found.name)]
        assert len(mine) == 8
        assert found[name] == pytest.approx(mine["samples"].map(np.median).sum())


def test_small_meshes_are_compared_on_the_smallest(run: Run) -> None:
    small, large = uses.ranking(run, "small"), uses.ranking(run, "asked")
    assert small.name < large.name
    assert large["indexed"] / large.min() > small["indexed"] / small.min()


def test_structures_within_a_tenth_of_the_best_are_bold(run: Run) -> None:
    rows = re.findall(r'<tr><th scope="row"[^>]*>(.*?)</th>(.*?)</tr>', uses.recommended(run))
    for title, row in rows:
        name = next(it for it, use in uses.USES.items() if use.title == title)
        found = uses.ranking(run, name)
        bold = re.findall("<strong>(.*?)</strong>", row)
        assert bold == [
            REGISTRY[it].title for it, cost in found.items() if cost <= 1.1 * found.iloc[0]
        ]
        assert re.split(", | or ", uses.best(found)) == bold


def test_what_was_not_measured_is_not_recommended(run: Run) -> None:
    empty = type(run)(run.folder, run.meta, run.cases.iloc[:0], run.skipped)
    assert not any(len(uses.ranking(empty, name)) for name in uses.USES)
    with pytest.raises(MissingError, match="decides between"):
        uses.recommended(empty)


def test_queries_are_compared_one_by_one_at_the_largest_mesh(run: Run) -> None:
    cases = run.cases.query("experiment == 'bench_queries' and order == 'random'")
    largest = cases[cases["vertices"] == cases["vertices"].max()]
    medians = {
        (it.structure, it.subject): sorted(it.samples)[len(it.samples) // 2]
        for it in largest.itertuples()
    }
    for one, other in (("indexed", "half_edge"), ("half_edge", "indexed")):
        ratios = [medians[one, it] / medians[other, it] for it in QUERIES]
        faster, slower = sum(it < 1 / 1.1 for it in ratios), sum(it > 1.1 for it in ratios)
        text = uses.beside(run, one, other)
        assert f"answers {faster} of {len(QUERIES)} queries faster" in text
        assert f", {slower} slower" in text

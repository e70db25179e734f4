"""What was measured of other libraries is shown in 80 columns, on a page and as JSON."""

import json
import re
from pathlib import Path

import pytest

from experiments.harness import HUBS, Measurement
from experiments.peers import ALGORITHMS, BAD_INPUT, BUILD, BULK, BYTES, OURS, PEERS, SINGLE
from experiments.report import measured_peers, notebooks
from experiments.report import peers as report_peers
from experiments.report.session import Session, share
from experiments.runs import CaseFile, describe, load, write_meta
from tests.experiments.cli.calls import hem
from tests.experiments.made_runs import write_run
from tests.experiments.peers.slow_library import LIBRARY

SIZES = (100, 560, 3_200, 18_000, 100_000)
VALENCES = (4, 16, 64, 256, 1_024)


def cases(slower: int, grows: int):
    """``vertex_faces`` one after the other in proportion to the valence and to n_t ** grows."""
    about = {"kind": "time", "detail": {"version": "1.2.3"}, "checked": True, "latency": 2e-9}

    def case(subject, order, seconds, n=SIZES[-1], family="torus", valence=None):
        samples = [slower * seconds * k for k in (0.99, 1, 1.01)]
        return Measurement(
            f"{subject}/{n}/{order}/{valence}", subject=subject, order=order, family=family,
            vertices=n, faces=2 * n, valence=valence, samples=samples, **about,
        )  # fmt: skip

    for n in SIZES:
        for order in (SINGLE, BULK):
            yield case("vertex_faces", order, 1e-6 * (n / 100) ** grows, n)
        yield case("vertex_vertices", SINGLE, 1e-6, n)
        yield case(BUILD, None, 1e-7 * n, n)
    for valence in VALENCES:
        yield case("vertex_faces", SINGLE, 1e-7 * valence, family=HUBS, valence=valence)
    yield case("split_face", SINGLE, 1e-6)
    yield from (case(it, None, 1e-2) for it in ALGORITHMS)
    found = {"version": "1.2.3", "found": ["refused", "ValueError: no; take another"]}
    for bad in BAD_INPUT:
        yield Measurement(bad, "trial", subject=bad, family="torus", detail=found)
    weighed = {"samples": [1e7 * slower], "vertices": SIZES[-1], "detail": {"version": "1.2.3"}}
    yield Measurement(BYTES, BYTES, subject=BYTES, family="torus", **weighed)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """A run in which the slow library takes three times as long, and longer the larger the mesh."""
    monkeypatch.setitem(PEERS, "slow", LIBRARY)
    folder = tmp_path / "run"
    folder.mkdir()
    write_meta(folder, {**describe("quick"), "finished": "2026-01-01T00:00:00Z"})
    CaseFile(folder, "bench_peers", OURS).add(*cases(1, 0))
    CaseFile(folder, "bench_peers", "slow").add(*cases(3, 1))
    yield folder
    share(None)


def printed(*arguments: str, code: int = 0) -> str:
    ended, output = hem(*arguments, width=80)
    assert ended == code, output
    return output


def test_the_table_fits_and_shows_class_verdict_and_ratio(run):
    text = printed("table", str(run), "--peers")
    assert max(map(len, text.splitlines())) <= 80
    assert "Slow library" in text
    assert "1.2.3" in text
    assert "O(n_t · n_ev) ✗✓ 3,000 ×" in text  # 3 times as long, and 1,000 times as large a mesh
    assert re.search(r"300 ns O\(n_t\)\s+3.0 ×", text)  # building, a vertex
    assert "O(1) 3.0 ×" in text  # of the neighbors of a vertex the thesis claims nothing
    assert "300" in text  # bytes per vertex


def test_the_name_of_a_folder_is_no_markup(run):
    assert "old[b], preset" in printed("table", str(run.rename(run.with_name("old[b]"))), "--peers")


def test_as_json_it_has_every_library_and_subject(run):
    content = json.loads(printed("table", str(run), "--peers", "--json"))
    ours, slow = content["libraries"]
    assert slow["bytes_per_vertex"] == 300
    asked = next(it for it in slow["subjects"] if it["subject"] == "vertex_faces")
    assert asked["way"] == SINGLE
    assert asked["outcomes"] == {"n_t": "violated", "n_ev": "consistent"}
    assert asked["of_ours"] == pytest.approx(3_000)
    assert all(it["of_ours"] == 1 for it in ours["subjects"])
    built = next(it for it in slow["subjects"] if it["subject"] == BUILD)
    assert built["found"] == "O(n_t)"
    assert built["outcomes"] == {}  # nobody claims anything of it


def test_the_chapter_shows_them_and_says_what_to_run_where_there_are_none(
    run, tmp_path, monkeypatch
):
    share(Session(load(run), []))
    page = notebooks.body("other_libraries")
    said = "Slow library", "O(n_t · n_ev)", "ValueError: no", "As <code>one</code> likes."
    for shown in (*said, ">example.org/<wbr/>slow</td>"):
        assert shown in page
    assert "take another" not in page  # what to do instead
    assert "hem study --peers" not in page
    share(Session(load(write_run(tmp_path / "other", only=lambda *_: False)), []))
    monkeypatch.setattr(report_peers, "PEER_RUNS", tmp_path / "none")
    monkeypatch.setattr(report_peers, "KEPT", "results/none")
    assert "hem study --peers" in notebooks.body("other_libraries")


def test_a_run_without_them_is_shown_the_newest_that_has(run, tmp_path, monkeypatch):
    monkeypatch.setattr(report_peers, "PEER_RUNS", run.parent)
    other = load(write_run(tmp_path / "elsewhere" / "other", only=lambda *_: False))
    assert measured_peers(other).names == [OURS, "slow"]


def test_where_none_was_measured_the_kept_run_is_shown(tmp_path, monkeypatch):
    monkeypatch.setattr(report_peers, "PEER_RUNS", tmp_path)
    kept = load(Path(__file__).parents[3] / report_peers.KEPT)
    other = load(write_run(tmp_path / "elsewhere" / "other", only=lambda *_: False))
    assert measured_peers(other).names == sorted(set(kept.cases["structure"]), key=[*PEERS].index)
    assert not kept.meta["dirty"]
    assert "CGAL" in printed("table", "--peers")


def test_where_nothing_was_measured_the_table_says_what_to_run(tmp_path, monkeypatch):
    monkeypatch.setattr(report_peers, "PEER_RUNS", tmp_path)
    monkeypatch.setattr(report_peers, "KEPT", "results/none")
    said = printed("table", "--peers", code=1)
    assert re.search("hem study --peers", " ".join(said.split()))


def test_an_address_may_go_on_in_the_next_line_after_a_slash():
    told = report_peers._address("https://a.org/b/c<d/")
    assert told == "a.org/<wbr>b/<wbr>c&lt;d/"

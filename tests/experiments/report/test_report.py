"""The report opens from disk, says what was found, and can be read."""

import re
import signal
import subprocess
import sys
from itertools import combinations
from pathlib import Path

import nbformat
import numpy as np
import pytest
from matplotlib.colors import to_rgb

import structures
from experiments.claims import CLAIMED
from experiments.harness import OPERATIONS, Axis
from experiments.report import Answer, abstract, notebooks, readme, site, uses, write_report
from experiments.report.figures import growth, memory, meshes
from experiments.report.figures.accuracy import KINDS
from experiments.report.pages import page
from experiments.report.session import share
from experiments.report.style import GRAY, finish_panels, panels, spread_apart, styled, words
from experiments.report.tables import digits
from experiments.runs import ResultsError
from structures import NAMED, REGISTRY
from tests.experiments.small_study import wait_for
from tests.extent import exhaustive


@pytest.mark.parametrize("there", ["a file", "a folder of others"])
def test_nothing_but_a_report_is_replaced(base_folder, tmp_path, there):
    if there == "a file":
        output = kept = tmp_path / "thesis.txt"
    else:
        output, kept = tmp_path, tmp_path / "thesis.txt"
    kept.write_text("years of work")
    with pytest.raises(ResultsError, match=r"is no report.*choose a folder"):
        write_report(base_folder, output)
    assert kept.read_text() == "years of work"


def test_a_report_that_fails_leaves_the_old_one(base_folder, tmp_path, monkeypatch):
    (tmp_path / "html").mkdir()
    (tmp_path / "html" / "index.html").write_text("old")
    titles = {"index": "Front", "no_such": "No such chapter"}
    monkeypatch.setattr(site, "page_titles", lambda: titles)
    with pytest.raises((OSError, ResultsError)):
        write_report(base_folder, tmp_path / "html")
    assert (tmp_path / "html" / "index.html").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["html"]


@exhaustive
def test_an_interrupt_leaves_the_old_report_and_no_process(base_folder, tmp_path):
    (tmp_path / "html").mkdir()
    (tmp_path / "html" / "index.html").write_text("old")
    script = (
        "import sys; from pathlib import Path; from experiments.report import write_report\n"
        "write_report(Path(sys.argv[1]), Path(sys.argv[2]) / 'html')"
    )
    command = [sys.executable, "-c", script, str(base_folder), str(tmp_path)]
    caller = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: len(descendants(caller.pid)) > 2)  # a fork server and what it forked
    workers = descendants(caller.pid)
    caller.send_signal(signal.SIGINT)
    _, said = caller.communicate(timeout=120)
    assert "KeyboardInterrupt" in said
    wait_for(lambda: not any(Path(f"/proc/{worker}/fd").exists() for worker in workers))
    assert (tmp_path / "html" / "index.html").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["html"]


def descendants(process: int) -> list[int]:
    command = ["ps", "--ppid", str(process), "-o", "pid="]
    listed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    children = [int(line) for line in listed.split()]
    return [*children, *(it for child in children for it in descendants(child))]


def test_every_notebook_says_its_title_and_its_place(tmp_path, monkeypatch):
    titles = notebooks.page_titles()
    assert next(iter(titles)) == "index"
    monkeypatch.setattr(notebooks, "carried", lambda folder: tmp_path)
    for order in (
        {},
        {"order": 1},
        {"title": "Here", "order": "1"},
        {"title": "Here", "order": None},
    ):
        nbformat.write(nbformat.v4.new_notebook(metadata=order), tmp_path / "forgotten.ipynb")
        with pytest.raises(
            ResultsError, match=r"forgotten\.ipynb: .* a title, and a number as order"
        ):
            notebooks.page_titles.__wrapped__()


@pytest.mark.parametrize("text", ["no JSON", "{}", "[]"])
def test_a_file_that_is_no_notebook_is_named(tmp_path, monkeypatch, text):
    (tmp_path / "broken.ipynb").write_text(text)
    monkeypatch.setattr(notebooks, "carried", lambda folder: tmp_path)
    with pytest.raises(ResultsError, match=r"broken\.ipynb is no notebook"):
        notebooks.page_titles.__wrapped__()


def executed(*sources: str) -> list[list[dict]]:
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    notebook = nbformat.v4.new_notebook(cells=cells)
    notebooks.execute(notebook, "chapter")
    return [cell.outputs for cell in notebook.cells]


def test_a_cell_shows_its_value_what_it_prints_and_what_it_displays():
    source = "from IPython.display import display\ndisplay(1)\nprint('two')\n3"
    outputs = executed("x = 1", source)
    assert outputs[0] == []
    assert [it.get("text") or it["data"]["text/plain"] for it in outputs[1]] == ["1", "3", "two\n"]


def test_a_cell_that_lacks_something_says_so_and_the_next_is_run():
    fails = "from experiments.report import project_file\nproject_file('no/such/file')"
    first, second = executed(fails, "4")
    assert "This needs no/such/file" in first[0]["data"]["text/plain"]
    assert first[0]["metadata"]["missing"]
    assert second[0]["data"]["text/plain"] == "4"


def test_a_cell_that_fails_names_its_notebook():
    with pytest.raises(ResultsError, match=r"notebooks/chapter\.ipynb .*ZeroDivisionError"):
        executed("1 / 0")


@pytest.fixture(scope="module")
def front(session):
    return notebooks.body("index")


def test_the_answers_are_numbers_of_the_run(base_run, front):
    assert front.count('class="answer"') == 5
    assert re.search(r"(59|60|61)\d µs at 200,000 triangles", front)  # 600 with 2 % of noise
    assert "takes 228 bytes per vertex and an indexed mesh 36: 6.33 times" in front
    assert "over all faces takes 1.00 times as long on a half-edge mesh" in front
    asked = uses.ranking(base_run, "asked")
    assert f"{uses.best(asked)} finds neighbors fastest" in front
    behind = f"fastest; a half-edge mesh takes {digits(asked['half_edge'] / asked.min(), 3)} times"
    assert (behind in front) == (asked["half_edge"] > uses.ALIKE * asked.min())
    assert "Of the 30 cells that table 1 of the thesis prints" in front
    assert "find 30 consistent. By time in order 26 of 26 cells are consistent" in front


def test_the_committed_page_has_the_tables_and_its_pictures(base_folder, tmp_path, monkeypatch):
    drawn = {name: readme.DRAWN[name] for name in ("overview", "memory", "workloads", "overtaking")}
    monkeypatch.setattr(readme, "DRAWN", drawn)
    (tmp_path / "README.md").write_text("<!-- answer -->\nold\n<!-- end of answer -->\nkept")
    page = readme.write_readme(base_folder, tmp_path / "report")
    share(None)
    text = page.read_text()
    answers = re.findall(r"(?m)^\d\. .*", text[: text.index("## How to read")])
    assert [it[:2] for it in answers] == ["1.", "2.", "3.", "4.", "5."]
    assert "takes 228 bytes per vertex and an indexed mesh 36: 6.33 times" in answers[1]
    above = (tmp_path / "README.md").read_text()
    assert above.splitlines() == ["<!-- answer -->", *answers, "<!-- end of answer -->", "kept"]
    assert "| Bytes per vertex | 36 ✓ | 116 ✓ | 228 ✓ | 228 ✓ |" in text
    assert "| Split face | O(1) ○○ | O(1) (✓✓) | O(1) (✓✓) | O(1) ✓✓ |" in text
    assert "| Named by its three corners | O(n_t) ✓✓ |" in text
    assert all(f"## In sentences: {kind.about}" in text for kind in CLAIMED)
    assert "| printed, in tables | 41 | 41 ✓ |" in text
    assert "6.33 | ✓ consistent |" in text
    pictures = re.findall(r"\((\w+\.png)\)", text)
    assert len(pictures) == 4
    compiled, from_python = readme.TABLES["workloads"]
    assert f"## {compiled}\n\n| compiled | vertices |" in text
    assert f"## {from_python}\n\n| from Python | vertices |" in text
    for picture in pictures:
        assert (page.parent / picture).stat().st_size > 10_000


FIGURES = {
    "queries by time": lambda run: growth.scaling(run, Axis.TIME_FACES),
    "queries by work": lambda run: growth.scaling(run, Axis.WORK_VALENCE),
    "operations": lambda run: growth.scaling(run, Axis.TIME_FACES, OPERATIONS),
    "workloads": growth.workloads,
    "overtaking": growth.overtaking,
    "rendering": growth.rendering,
}


@pytest.mark.parametrize("name", FIGURES)
def test_labels_do_not_overlap_and_stay_inside_the_figure(base_run, name):
    figure = FIGURES[name](base_run)
    figure.draw_without_rendering()
    for axes in (it for it in figure.axes if it.get_visible()):
        boxes = [text.get_window_extent() for text in axes.texts]
        assert boxes
        for i, box in enumerate(boxes):
            assert figure.bbox.x1 >= box.x1
            assert not any(box.overlaps(other) for other in boxes[i + 1 :])


@pytest.mark.parametrize("name", FIGURES)
def test_every_plot_writes_a_thousand_alike(base_run, name):
    for axes in (it for it in FIGURES[name](base_run).axes if it.get_visible()):
        assert {it.get_major_formatter()(1000) for it in (axes.xaxis, axes.yaxis)} == {"1k"}


def test_no_label_lies_over_a_line_that_goes_on():
    with styled():
        plot, (axes,) = panels(["Splits"])
        for name, length, rise in (("scan", 40, 1.0), ("walk", 40, 1.1), ("level", 20, 0.0)):
            x = np.geomspace(100, 100 * 10 ** (length / 10), length)
            axes.plot(x, 3e4 * (x / 2e4) ** rise, label=name)
        finish_panels(plot, [axes])
    points = [
        axes.transData.transform(np.geomspace(*line.get_xydata()[[0, -1]], 5000))
        for line in axes.lines
    ]
    for label in axes.texts:
        assert not label.get_window_extent().count_contains(np.vstack(points))


def test_below_a_bar_every_field_is_named_behind_its_record(base_run):
    (axes,) = memory.by_field(base_run).axes
    assert [it.get_text() for it in axes.texts].count("vertex: point") == len(axes.get_yticks())
    told = memory.in_words(structures.build("winged_edge", meshes.hexagon()).memory())
    wings = "left previous, right previous, left next, right next"
    assert told == f"vertex: point, edge · face: edge · edge: tail, head, left, right, {wings}"


def test_a_mesh_begins_below_its_title():
    figure = meshes.quad_splits("half_edge")
    figure.draw_without_rendering()
    for axes in figure.axes:
        points = axes.transData.transform(axes.collections[1].get_offsets())
        assert 0 < points[:, 0].min() - axes.bbox.x0 < 0.15 * axes.bbox.width


def test_an_axis_of_lines_in_both_orders_names_neither(base_run):
    overview, scaling = growth.overview(base_run), growth.scaling(base_run, Axis.TIME_FACES)
    for axes in (overview.axes[1], scaling.axes[0]):
        assert sum(line.get_label().startswith("_") for line in axes.lines) > 3  # thin, in order
        told = f"{axes.get_title('left')} {axes.get_ylabel()}"
        assert "time, ns" in told
        assert "order" not in told


def test_an_axis_ends_with_what_was_measured(base_run):
    (axes,) = growth.rendering(base_run).axes
    largest = max(line.get_xdata()[-1] for line in axes.lines)
    assert largest / 10 < axes.get_xticks()[-1] < largest * 2
    assert axes.spines["bottom"].get_bounds()[1] < largest * 2 < axes.get_xlim()[1]


@pytest.mark.parametrize("high", [1.3, 2, 5, 30, 1e3, 1e7])
@pytest.mark.parametrize("low", [1, 190, 650])
def test_an_axis_of_any_length_has_two_numbers_and_no_crowd(low, high):
    with styled():
        plot, (axes,) = panels(["A small run, or a large one"])
        axes.plot([low, low * high], [low, low * high], label="a line")
        finish_panels(plot, [axes])
        plot.draw_without_rendering()
    for ticks, ends in ((axes.get_xticks(), axes.get_xlim()), (axes.get_yticks(), axes.get_ylim())):
        assert 2 <= np.count_nonzero((ends[0] <= ticks) & (ticks <= ends[1])) <= 9, ticks


# How colors are seen where a receptor is missing, by Machado, Oliveira and Fernandes (2009).
BLIND_TO = {
    "red": [(0.152, 1.053, -0.205), (0.115, 0.786, 0.099), (-0.004, -0.048, 1.052)],
    "green": [(0.367, 0.861, -0.228), (0.280, 0.673, 0.047), (-0.012, 0.043, 0.969)],
    "blue": [(1.256, -0.077, -0.179), (-0.078, 0.931, 0.148), (0.005, 0.691, 0.304)],
}
TO_XYZ = [(0.434, 0.376, 0.190), (0.213, 0.715, 0.072), (0.018, 0.109, 0.873)]  # of white: 1, 1, 1
TO_LAB = [(0, 116, 0), (500, -500, 0), (0, 200, -200)]


@pytest.mark.parametrize("missing", BLIND_TO)
def test_structures_drawn_with_one_dash_differ_in_color_to_the_color_blind(missing):
    looks = [it.look for it in REGISTRY.values()]
    light = np.array([[((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(it.color)] for it in looks])
    seen = np.clip(light @ np.transpose(BLIND_TO[missing]), 0, 1)
    lab = np.cbrt(seen @ np.transpose(TO_XYZ)) @ np.transpose(TO_LAB)
    for (a, one), (b, other) in combinations(zip(lab, looks, strict=True), 2):
        assert one.line != other.line or np.linalg.norm(a - b) > 25


def contrast(color: str) -> float:
    """To white, as the Web Content Accessibility Guidelines have it."""
    light = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(color)]
    return 1.05 / (np.dot(light, (0.2126, 0.7152, 0.0722)) + 0.05)


def test_lines_and_gray_words_stand_out_from_white():
    lines = {it.title: round(contrast(it.look.color), 2) for it in NAMED.values()}
    assert {name: it for name, it in lines.items() if it < 3} == {}
    assert contrast(GRAY) >= 4.5


def test_an_open_answer_is_seen_by_day_and_with_colors_inverted_by_night():
    color = KINDS["undetermined"]
    inverted = "#" + "".join(f"{255 - round(255 * c):02x}" for c in to_rgb(color))
    assert contrast(color) > 1.8
    assert contrast("#17181b") / contrast(inverted) > 1.8


def test_the_words_of_the_demo_stand_out_by_day_and_by_night():
    by_day, by_night = re.findall(r"--soft: (#\w+)", page("demo.html.j2", shown=[], size=(1, 1)))
    assert contrast(by_day) >= 4.5
    assert contrast("#121212") / contrast(by_night) >= 4.5


def test_who_does_not_see_a_plot_is_told_its_panels_and_where_its_lines_go():
    with styled():
        plot, (axes, _) = panels(["Faces", "Edges"])
        axes.plot([1, 10, 100], [2, 300, 15_000], label="TNS")
        axes.set_ylabel("time, ns")
    assert words(plot) == "Faces, time, ns: TNS 2 to 15k. Edges"


def test_who_does_not_see_a_picture_is_told_its_titles_too():
    shown = (
        "from experiments.report import open_run\nfrom experiments.report.figures import meshes\n"
    )
    (steps,) = executed(f"{shown}open_run()\nmeshes.collapse_steps('half_edge')")
    (still,) = executed(f"{shown}meshes.jpeg(meshes.quad_splits('half_edge'))")
    assert "Vertex 0 is to merge into 1" in steps[0]["metadata"]["image/png"]["alt"]
    assert "a quarter up its left side" in still[0]["metadata"]["image/jpeg"]["alt"]


def test_labels_are_moved_as_little_as_need_be():
    assert spread_apart([0.0, 30.0], 10) == [0.0, 30.0]
    assert spread_apart([0.0, 0.0], 10) == [-5.0, 5.0]
    rng = np.random.default_rng(0)
    for _ in range(50):
        heights = sorted(rng.uniform(0, 60, 5).tolist())
        spread = spread_apart(heights, 10)
        assert (np.diff(spread) >= 10 - 1e-9).all()
        assert np.isclose(np.mean(spread), np.mean(heights))


def test_the_german_answers_have_the_numbers_of_the_english_ones(front):
    english = re.findall(r'(?s)<p class="answer">(.*?)<span class="rests">', front)
    german = re.findall(r"<li>(.*?)</li>", re.search(r'(?s)lang="de">(.*?)</ol>', front)[1])
    assert len(english) == len(german) == 5
    for here, there in zip(english, german, strict=True):
        numbers = re.findall(r"\d[\d,.]*\d|\d", here)
        swapped = [it.translate(str.maketrans(",.", ".,")) for it in numbers]
        assert sorted(re.findall(r"\d[\d,.]*\d|\d", there)) == sorted(swapped)
        assert re.search("[äöü]", there)
    assert all(it in " ".join(german) for it in ("6,33-Fache", "bei 200.000 Dreiecken"))
    assert re.search(r" zu, \d+ nicht; offen: \d+\. ", german[4])  # no verb that one alone has not


def test_what_was_not_measured_is_said_in_german_too():
    missing = Answer("2", german="2,5", rests={}, needs=(np.nan,), missing="nothing")
    assert (missing.text, missing.measured) == ("nothing", False)
    assert "auf keiner Maschine ganz gemessen" in abstract([missing])

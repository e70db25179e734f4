"""Pages that are whole; in a real browser without errors, with links that lead, fit for a phone."""

import re
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlparse

import pytest

from experiments.claims import judge_run
from experiments.report import write_report
from experiments.report.notebooks import page_titles
from experiments.runs import load
from tests.experiments.chromium import Browser
from tests.extent import exhaustive

PAGES = tuple(page_titles())
SHOWN = "[...document.querySelectorAll('.entry')].filter(it => it.checkVisibility())"
KEYS = f"{SHOWN}.map(it => it.id)"
COUNT = "document.getElementById('shown').textContent"


pytestmark = exhaustive  # the chapters are tested otherwise, and to draw all of them takes long


@pytest.fixture(scope="module")
def report(tmp_path_factory, base_folder) -> Path:
    """The pages of a whole report."""
    return write_report(base_folder, tmp_path_factory.mktemp("report") / "html").parent


@pytest.fixture
def front(chromium: Browser, report: Path) -> Browser:
    chromium.size(1300)
    chromium.open((report / "index.html").as_uri())
    return chromium


def press(browser: Browser, group: str, value: str) -> None:
    browser.run(
        f"""document.querySelector('[data-group="{group}"][data-value="{value}"]').click()"""
    )


def search(browser: Browser, words: str) -> list[str]:
    return browser.run(
        f"(() => {{ const it = document.getElementById('search'); it.value = {words!r};"
        f"it.dispatchEvent(new Event('input')); return {KEYS}; }})()"
    )


def test_the_pages_are_whole_and_need_nothing_from_elsewhere(report, base_folder):
    pages = {page.name: page.read_text("utf-8") for page in report.glob("*.html")}
    assert set(pages) == {f"{name}.html" for name in PAGES}
    assert {path.suffix for path in (report / "claims").iterdir()} == {".svg", ".csv"}
    for text in pages.values():
        assert not re.search(r'(src|href)="(?!data:|claims/|[\w.]+\.html|#)', text)
        assert "No description" not in text
        assert "`" not in re.sub(r"(?s)<(pre|script|style).*?</\1>", "", text)  # Markdown, unread
    judged = judge_run(load(base_folder))
    tables = sum(it.claim.structure != "" and it.was_measured for it in judged)
    cells = re.findall(r'<td class="[^"]*\b(?:consistent|no-claim)\b', pages["index.html"])
    assert len(cells) == tables
    for name, plots, pictures in (
        ("operations", 5, 7), ("half_edge_or_indexed", 3, 0), ("query_scaling", 5, 0)
    ):  # fmt: skip
        assert pages[f"{name}.html"].count('class="plot wide"') == plots
        assert pages[f"{name}.html"].count('class="picture wide"') == pictures
    assert "1.00" in pages["comparison_table.html"]


@pytest.mark.parametrize("name", PAGES)
def test_a_page_opens_without_an_error_in_its_console(chromium, report, name):
    chromium.errors.clear()
    chromium.open((report / f"{name}.html").as_uri())
    assert chromium.run("document.querySelector('h1').textContent.length") > 3
    assert chromium.errors == []


@pytest.mark.parametrize("width", [768, 390, 320])
def test_no_page_is_wider_than_its_window(chromium, report, width):
    chromium.size(width)
    for name in PAGES:
        chromium.open((report / f"{name}.html").as_uri())
        if name == "index":
            chromium.run("document.querySelectorAll('.entry').forEach(it => { it.open = true; })")
        assert chromium.run("document.documentElement.scrollWidth") <= width, name
        drawn = "[...document.querySelectorAll('.highlight pre')].map(it => it.offsetHeight)"
        chromium.size(1300)
        wide = chromium.run(drawn)
        chromium.size(width)
        assert chromium.run(drawn) == wide, f"lines of a drawing in characters break: {name}"


def test_a_table_that_scrolls_is_reached_by_the_keyboard(chromium, report):
    chromium.size(320)
    for name in PAGES:
        chromium.open((report / f"{name}.html").as_uri())
        wide = "it => it.scrollWidth > it.clientWidth + 1 && it.tabIndex < 0"
        unreached = f"[...document.querySelectorAll('.wide')].filter({wide})"
        assert chromium.run(f"{unreached}.map(it => it.textContent)") == [], name


def test_every_link_leads_to_a_file_and_a_place_that_exist(chromium, report):
    chromium.size(1300)
    ids, links = {}, set()
    for name in PAGES:
        page = report / f"{name}.html"
        chromium.open(page.as_uri())
        ids[page] = set(chromium.run("[...document.querySelectorAll('[id]')].map(it => it.id)"))
        ways = "'a[href], link[href], img[src], script[src]'"
        links |= {
            (page, it)
            for it in chromium.run(
                f"[...document.querySelectorAll({ways})].map(it => it.href || it.src)"
            )
            if not it.startswith("data:")
        }
    assert len(links) > 450
    for page, link in links:
        target, place = urldefrag(link)
        assert target.startswith("file:"), (page.name, link)
        path = Path(unquote(urlparse(target).path))
        assert path.is_file(), (page.name, link)
        assert path.is_relative_to(report), (page.name, link)
        assert not place or unquote(place) in ids[path], (page.name, link)


def test_every_chapter_is_reached_from_every_page(chromium, report):
    for name in PAGES:
        chromium.open((report / f"{name}.html").as_uri())
        chromium.run("document.querySelector('nav summary').click()")
        seen = "[...document.querySelectorAll('nav a')].filter(it => it.checkVisibility())"
        names = chromium.run(f"{seen}.map(it => it.getAttribute('href'))")
        assert {f"{it}.html" for it in PAGES} <= set(names)
        chromium.run("document.querySelector('nav ol a').focus()")
        chromium.call("Input.dispatchKeyEvent", type="keyDown", key="Escape")
        assert chromium.run("document.activeElement.matches('nav details:not([open]) > *')")
        assert chromium.run("document.querySelectorAll('nav [aria-current]').length") == 1


def test_words_are_as_large_as_the_reader_has_them(chromium, report):
    size = "parseFloat(getComputedStyle(document.querySelector('main p')).fontSize)"
    try:
        for standard in (16, 32):
            chromium.call("Page.setFontSizes", fontSizes={"standard": standard})
            chromium.open((report / "index.html").as_uri())
            assert chromium.run(size) == standard
    finally:
        chromium.call("Page.setFontSizes", fontSizes={"standard": 16})


def test_the_keyboard_stops_at_nothing_but_what_is_used_or_scrolls(chromium, report):
    chromium.size(1300)
    used = "a, button, input, select, summary, canvas, table, img, svg"
    for name in PAGES:
        chromium.open((report / f"{name}.html").as_uri())
        idle = f"[...document.querySelectorAll('[tabindex]')].filter(it => !it.matches('{used}')"
        idle += " && !it.querySelector(':scope > :is(table, img, svg)'))"
        assert chromium.run(f"{idle}.map(it => it.textContent)") == [], name


def test_the_navigation_stays_on_one_line(chromium, report):
    for width in (360, 1300):
        chromium.size(width)
        for name in PAGES:
            chromium.open((report / f"{name}.html").as_uri())
            assert chromium.run("document.querySelector('nav').offsetHeight") < 60


def test_filters_show_what_they_name_and_counts_follow(front):
    every = front.run(KEYS)
    unclaimed = """document.querySelector('[data-value="not claimed"] span').textContent"""
    claims = len(every) - int(front.run(unclaimed))
    assert front.run(COUNT) == f"{len(every)} entries, {claims} of them claims"
    press(front, "structure", "half_edge")
    mine = front.run(KEYS)
    assert mine == [it for it in every if it.startswith("half_edge/")]
    assert front.run(COUNT) == f"{len(mine)} of {len(every)} entries"
    press(front, "structure", "indexed")  # either
    assert len(front.run(KEYS)) == len(mine) + sum(it.startswith("indexed/") for it in every)
    press(front, "structure", "indexed")
    press(front, "kind", "operations")  # and
    assert set(front.run(KEYS)) < set(mine)
    assert front.run(f"{SHOWN}.every(it => it.dataset.kind === 'operations')")
    offered = """document.querySelector('[data-value="queries"] span').textContent"""
    press(front, "kind", "operations")
    assert int(front.run(offered)) == sum(1 for it in mine) - 6  # but for the operations
    press(front, "structure", "half_edge")
    assert front.run(KEYS) == every


def test_outcomes_are_told_apart_by_the_filter(front):
    for outcome in ("consistent", "no claim"):
        press(front, "outcome", outcome)
        assert front.run(f"{SHOWN}.every(it => it.dataset.outcome === '{outcome}')")
        assert front.run(f"{SHOWN}.length") > 9
        press(front, "outcome", outcome)


def test_the_mark_of_a_claim_stands_on_one_line(front):
    heights = "[...document.querySelectorAll('.entry .mark')].map(it => it.offsetHeight)"
    assert len(set(front.run(heights))) == 1


def test_on_a_phone_words_of_a_claim_stand_apart_and_beside_its_mark(front):
    front.size(390)
    entries = "[...document.querySelectorAll('.entry')]"
    edge = "it.querySelector('{}').getClientRects()[0].{}"
    beside = f"{edge.format('.mark', 'right')} <= {edge.format('.what', 'left')}"
    assert front.run(f"{entries}.filter(it => !({beside})).map(it => it.id)") == []
    for name in ("who", "outcome"):
        before = f"getComputedStyle(document.querySelector('.entry .{name}'), '::before').content"
        assert front.run(before) == '" · "'


def test_a_range_and_a_verdict_are_not_broken(chromium, report):
    chromium.size(1300)
    chromium.open((report / "half_edge_or_indexed.html").as_uri())
    lines = "it => { const r = document.createRange(); r.selectNodeContents(it); "
    lines += "return new Set([...r.getClientRects()].map(it => it.bottom)).size; }"
    cells = "[...document.querySelectorAll('tr > td:nth-child(n + 3)')]"
    counts = chromium.run(f"{cells}.filter(it => it.closest('tr').cells.length == 4).map({lines})")
    assert len(counts) > 40
    assert set(counts) == {1}


def test_search_finds_the_claims_that_have_all_the_words(front):
    every = front.run(KEYS)
    assert search(front, "half-edge collapse")[0] == "half_edge/collapse_edge"
    assert search(front, "plankton/vertex_faces") == ["plankton/vertex_faces"]
    assert set(search(front, "plankton")) > {it for it in every if it.startswith("plankton/")}
    assert search(front, "xyzzy") == []
    assert front.run("document.getElementById('none').checkVisibility()")
    front.run("document.getElementById('all').click()")
    assert front.run(KEYS) == every


def test_a_deep_link_opens_its_claim_even_if_it_is_filtered_out(front, report):
    press(front, "structure", "indexed")
    front.run("document.querySelector('a[href=\"index.html#plankton/vertex_faces\"]').click()")
    front.run("new Promise(done => setTimeout(done, 100))")
    opened = "[...document.querySelectorAll('.entry[open]')].map(it => it.id)"
    assert front.run(opened) == ["plankton/vertex_faces"]
    assert front.run("document.activeElement.parentNode.id") == "plankton/vertex_faces"
    front.open((report / "index.html").as_uri() + "#sentence/bytes_ratio")
    assert front.run(opened) == ["sentence/bytes_ratio"]
    top = front.run("document.querySelector('.entry[open]').getBoundingClientRect().top")
    assert 0 <= top < 200


def test_every_plot_is_drawn_and_described(front, report):
    front.run("document.querySelectorAll('.entry img').forEach(it => { it.loading = 'eager'; })")
    front.run("document.querySelectorAll('.entry').forEach(it => { it.open = true; })")
    pictures = "[...document.querySelectorAll('.entry img')]"
    assert front.run(f"Promise.all({pictures}.map(it => it.decode())).then(() => true)")
    drawn = len(list((report / "claims").glob("*.svg")))
    assert front.run(f"{pictures}.length") == drawn > 50
    assert front.run(f"{pictures}.every(it => it.naturalWidth > 100 && it.alt.length > 10)")


def test_claims_unfold_by_the_keyboard_and_controls_have_names(front):
    front.run("document.querySelector('.entry summary').focus()")
    for kind in ("keyDown", "keyUp"):
        front.call(
            "Input.dispatchKeyEvent", type=kind, key="Enter", text="\r" * (kind == "keyDown")
        )
    assert front.run("document.querySelector('.entry').open")
    heads = "[...document.querySelectorAll('.entry summary')]"
    for key, there in (("Shift", 0), ("ArrowDown", 1), ("ArrowDown", 2), ("ArrowUp", 1)):
        front.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        assert front.run(f"{heads}.indexOf(document.activeElement)") == there
        assert front.run(f"{heads}.findIndex(it => it.tabIndex === 0)") == there
        assert front.run(f"{heads}.filter(it => it.tabIndex === 0).length") == 1
    unnamed = [
        node["role"]["value"]
        for node in front.call("Accessibility.getFullAXTree")["nodes"]
        if node.get("role", {}).get("value") in ("button", "searchbox", "link", "image")
        and not node["ignored"]
        and not node.get("name", {}).get("value")
    ]
    assert unnamed == []


def test_without_scripts_everything_is_shown(chromium, report):
    chromium.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        chromium.open((report / "index.html").as_uri())
        total = chromium.run("document.querySelectorAll('.entry').length")
        assert len(chromium.run(KEYS)) == total > 100
        assert not chromium.run("document.getElementById('filters').checkVisibility()")
    finally:
        chromium.call("Emulation.setScriptExecutionDisabled", value=False)

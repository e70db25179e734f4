"""The site is built without a warning, opens from disk, and documents every public name."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

import hem
from experiments.report.pdf import find_browser
from tests.experiments.chromium import started
from tests.extent import exhaustive

build = pytest.importorskip("mkdocs.commands.build", reason="the extra docs is not installed")

ROOT = Path(__file__).parents[1]

pytestmark = exhaustive  # to build the site takes longer than to see what is wrong with it


class Page(HTMLParser):
    """What a page refers to, and what in it can be referred to."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.anchors.update(filter(None, (given.get("id"), given.get("name"))))
        for key in ("href", "src"):
            if target := given.get(key):
                (self.links if tag == "a" else self.loaded).append(target)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built strictly: a warning is an error."""
    from mkdocs.config import load_config

    folder = tmp_path_factory.mktemp("site")
    build.build(load_config(str(ROOT / "mkdocs.yml"), site_dir=str(folder), strict=True))
    return folder


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    found = {path: Page(path) for path in site.rglob("*.html") if path.name != "404.html"}
    assert len(found) > 20
    return found


def test_every_link_leads_to_a_file_and_a_place_in_it(pages: dict[Path, Page]) -> None:
    lost = []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if parts.scheme:
                continue
            known = pages[target].anchors if target in pages else set()
            if not target.is_file() or (parts.fragment and unquote(parts.fragment) not in known):
                lost.append((path.name, link))
    assert lost == []


def test_a_page_loads_nothing_from_elsewhere(pages: dict[Path, Page]) -> None:
    for path, page in pages.items():
        for link in page.loaded:
            assert not urlsplit(link).netloc, (path.name, link)
            assert (path.parent / urlsplit(link).path).exists(), (path.name, link)


def test_links_are_told_by_more_than_color_and_comments_in_code_can_be_read(site: Path) -> None:
    if find_browser() is None:
        pytest.skip("no Chromium or Chrome is installed")
    with started() as browser:
        browser.open((site / "start.html").as_uri())
        link = "getComputedStyle(document.querySelector('article p > a:not(.headerlink)'))"
        assert browser.run(f"{link}.textDecorationLine") == "underline"
        comment = browser.run("getComputedStyle(document.querySelector('article .c1')).color")
        *_, opaque = re.findall(r"[\d.]+", comment)  # black over the gray of code, #f5f5f5
        assert comment.startswith("rgba(0, 0, 0")
        light = ((1 - float(opaque)) * 0.96 + 0.055) / 1.055
        assert (0.913 + 0.05) / (light**2.4 + 0.05) >= 4.5


def test_every_public_name_of_the_library_is_documented(pages: dict[Path, Page]) -> None:
    anchors = set().union(*(page.anchors for page in pages.values()))
    known = {it.rpartition(".")[2] for it in anchors}
    assert set(hem.__all__) - known == set()
    for name in hem._ROOMS:
        room, inside = getattr(hem, name), {it for it in anchors if it.startswith(f"hem.{name}.")}
        assert f"hem.{name}" in anchors
        called = {it for it in room.__all__ if callable(getattr(room, it))}
        assert called - {it.rpartition(".")[2] for it in inside if it.count(".") > 1} == set(), name


def test_no_page_shows_marks_that_were_not_read(site: Path) -> None:
    for path in site.rglob("*.html"):
        text = re.sub(r"(?s)<(pre|script|style).*?</\1>", "", path.read_text("utf-8"))
        assert "{{ " not in text, path
        assert "&gt;&gt;&gt; " not in text, path

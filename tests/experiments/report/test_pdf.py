"""The report in print: all of it in one document, or a word on what is missing."""

import re
import stat

import pytest
from typer.testing import CliRunner

from experiments.claims import judge_run
from experiments.cli import app
from experiments.report import notebooks, pdf, site
from experiments.report.pages import page, part
from experiments.report.session import Session, share
from structures import REGISTRY

installed = pytest.mark.skipif(
    pdf.find_browser() is None,
    reason=f"no Chromium or Chrome is installed; {pdf.BROWSER_VARIABLE} names one elsewhere",
)
TITLES = {"index": "Front", "comparison_table": "The comparison table"}


@pytest.fixture(scope="module")
def document(base_run) -> str:
    share(Session(base_run, judge_run(base_run), printed=True))
    bodies = {name: notebooks.body(name) for name in TITLES}
    text = page("print.html.j2", titles=TITLES, front="index", bodies=bodies)
    share(None)
    return text


def test_links_between_pages_lead_within_the_document(document):
    ids = set(re.findall(r'\sid="([^"]*)"', document))
    links = re.findall(r'href="([^"]*)"', document)
    assert {f"#{name}" for name in TITLES} & set(links)
    chapters = {f"#{name}" for name in notebooks.page_titles()}
    for link in links:
        if not link.startswith(("data:", "claims/")):
            assert link[1:] in ids or link in chapters, link


def test_everything_is_unfolded_and_none_of_it_waits_to_be_seen(document):
    assert document.count(' open=""') == document.count("<details") > 100
    assert 'loading="lazy"' not in document


def test_without_a_browser_the_error_says_what_to_install(base_folder, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(pdf.BROWSER_VARIABLE, raising=False)
    done = CliRunner().invoke(app, ["report", str(base_folder), "--pdf"])
    assert done.exit_code == 1
    with pytest.raises(pdf.PrintError, match=r"apt install chromium.*HEM_BROWSER"):
        site.write_pdf(base_folder, tmp_path / "it.pdf")
    assert not (tmp_path / "it.pdf").exists()


def test_a_browser_that_prints_nothing_is_named_with_what_it_said(tmp_path, monkeypatch):
    broken = tmp_path / "browser"
    broken.write_text("#!/bin/sh\necho out of paper >&2\nexit 3\n")
    broken.chmod(broken.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv(pdf.BROWSER_VARIABLE, str(broken))
    with pytest.raises(pdf.PrintError, match=r"exit code 3.*out of paper"):
        pdf.print_pdf(tmp_path / "it.html", tmp_path / "it.pdf")


@installed
def test_the_document_is_printed_with_all_its_claims(document, tmp_path):
    page = tmp_path / "it.html"
    page.write_text(document, "utf-8")
    content = pdf.print_pdf(page, tmp_path / "it.pdf").read_bytes()
    assert content.startswith(b"%PDF-")
    assert b"/Outlines" in content, "bookmarks, as paper has no navigation"
    assert len(re.findall(rb"/Type\s*/Page\b", content)) > 10


@installed
def test_no_table_is_wider_than_its_paper_and_notes_are_smaller_than_words(
    document, chromium, tmp_path
):
    heads = [
        "",
        "vertices",
        "faces",
        "renderer",
        "render mesh",
        *(it.title for it in REGISTRY.values()),
    ]
    broad = part(
        "numbers", heads, [["torus", "1,000,000", "2,000,000", *["0.0587"] * (len(heads) - 3)]]
    )
    page = tmp_path / "it.html"
    page.write_text(document.replace("</main>", f"{broad}</main>"), "utf-8")
    papers = {
        "table:not(.slopes)": 210,
        ".slopes": 594,
    }  # millimeters, with 14 of them on either side
    assert "@page broad { size: 594mm 420mm; }" in document
    chromium.call("Emulation.setEmulatedMedia", media="print")
    try:
        for tables, paper in papers.items():
            chromium.size(round((paper - 28) / 25.4 * 96))
            chromium.open(page.as_uri())
            wide = "it => it.scrollWidth > document.documentElement.clientWidth"
            assert (
                chromium.run(f"[...document.querySelectorAll('{tables}')].filter({wide}).length")
                == 0
            )
        size = "parseFloat(getComputedStyle(document.querySelector('td{}')).fontSize)"
        small, words = (chromium.run(size.format(it)) for it in (" small", ""))
        assert small < words
    finally:
        chromium.call("Emulation.setEmulatedMedia", media="")

"""The report in print: all of it in one document, or a word on what is missing."""

from __future__ import annotations

import re
import stat

import pytest
from typer.testing import CliRunner

from experiments.cli import app
from experiments.report import chapters, pdf, site
from tests.experiments.made_runs import write_run

installed = pytest.mark.skipif(
    pdf.find_browser() is None,
    reason=f"no Chromium or Chrome is installed; {pdf.BROWSER_VARIABLE} names one elsewhere",
)


def document() -> str:
    chapters = {
        "memory": '<h2 id="So">So</h2><a href="#So">here</a> <a href="errata.html">there</a>',
        "errata": '<h2 id="So">So</h2><a href="index.html">front</a>',
    }
    inside = '<img loading="lazy" src="x.svg"><a href="claims/a.csv">data</a>'
    claims = f'<details id="a/b">{inside}</details>'
    front = '<a href="#a/b">claim</a><a href="memory.html">memory</a>'
    return pdf.document("All of it", pdf.sections(front, chapters, claims, "<p>the run</p>"))


def test_links_between_pages_lead_within_the_document():
    text = document()
    ids = re.findall(r'\sid="([^"]*)"', text)
    assert len(ids) == len(set(ids))
    links = [it for it in re.findall(r'href="([^"]*)"', text) if it != "data:,"]
    assert len(links) == 5
    assert all(link[0] == "#" and link[1:] in ids for link in links)


def test_everything_is_unfolded_and_none_of_it_waits_to_be_seen():
    text = document()
    assert text.count("<details open") == text.count("<details") == 1
    assert "lazy" not in text
    assert ">the run<" in text
    order = [text.index(f'id="page-{name}"') for name in ("index", "memory", "errata", "all")]
    assert order == sorted(order)


def test_without_a_browser_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(pdf.BROWSER_VARIABLE, raising=False)
    run = write_run(tmp_path / "run")
    done = CliRunner().invoke(app, ["report", str(run), "--pdf"])
    assert done.exit_code == 1
    with pytest.raises(pdf.PrintError, match=r"apt install chromium.*HEM_BROWSER"):
        site.write_pdf(run, tmp_path / "it.pdf")
    assert not (tmp_path / "it.pdf").exists()


def test_a_browser_that_prints_nothing_is_named_with_what_it_said(tmp_path, monkeypatch):
    broken = tmp_path / "browser"
    broken.write_text("#!/bin/sh\necho out of paper >&2\nexit 3\n")
    broken.chmod(broken.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv(pdf.BROWSER_VARIABLE, str(broken))
    with pytest.raises(pdf.PrintError, match=r"exit code 3.*out of paper"):
        pdf.printed(tmp_path / "it.html", tmp_path / "it.pdf")


@installed
def test_the_document_is_printed_on_as_many_sheets_as_it_has_parts(tmp_path):
    page = tmp_path / "it.html"
    page.write_text(document(), "utf-8")
    content = pdf.printed(page, tmp_path / "it.pdf").read_bytes()
    assert content.startswith(b"%PDF-")
    assert len(re.findall(rb"/Type\s*/Page\b", content)) == 4


@installed
def test_a_report_is_printed_with_all_its_claims(tmp_path, monkeypatch):
    monkeypatch.setattr(chapters, "CHAPTERS", {})  # the notebooks have their own test
    folder = write_run(tmp_path / "run")
    content = site.write_pdf(folder, tmp_path / "it.pdf").read_bytes()
    assert len(re.findall(rb"/Type\s*/Page\b", content)) > 15
    assert sorted(it.name for it in tmp_path.iterdir()) == ["it.pdf", "run"]

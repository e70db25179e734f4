"""A page of the report: its head, the way to the other pages, and what it looks like."""

from __future__ import annotations

from html import escape
from importlib.resources import files

HOME = "index.html"


def page(title: str, body: str, links: dict[str, str], script: str = "") -> str:
    """A page that opens from disk. ``links``: title -> file, in the order they are read."""
    inline = f"<script>\n{script}</script>" if script else ""
    return (
        f"<!doctype html>\n{head(title)}\n<body>{_navigation(title, links)}\n"
        f"<main>\n{body}\n</main>{_further(title, links)}\n{inline}</body></html>\n"
    )


def head(title: str) -> str:
    """The head, with the style inside."""
    return (
        '<html lang="en"><head><meta charset="utf-8">'
        f"<title>{escape(title)}</title>"
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<link rel="icon" href="data:,"><style>\n{static("report.css")}</style></head>'
    )


def static(name: str) -> str:
    """A file that goes into pages as it is."""
    return (files("experiments.report") / "static" / name).read_text("utf-8")


def _navigation(title: str, links: dict[str, str]) -> str:
    """One line however many pages there are: to the verdicts, and a list that unfolds."""
    items = "".join(f"<li>{_link(name, to, name == title)}</li>" for name, to in links.items())
    return (
        f'<nav aria-label="Pages"><a class="home" href="{HOME}">hem</a>'
        f"<details><summary>Chapters</summary><ol>{items}</ol></details>"
        f'<span class="here">{escape(title)}</span></nav>'
    )


def _link(name: str, to: str, here: bool) -> str:
    current = ' aria-current="page"' if here else ""
    return f'<a href="{escape(to)}"{current}>{escape(name)}</a>'


def _further(title: str, links: dict[str, str]) -> str:
    """At the end of a page: to the one before and the one after."""
    names = list(links)
    if title not in names:
        return ""
    at = names.index(title)
    before = f'<a rel="prev" href="{links[names[at - 1]]}">‹ {names[at - 1]}</a>' if at else ""
    after = names[at + 1] if at + 1 < len(names) else None
    following = f'<a rel="next" href="{links[after]}">{escape(after)} ›</a>' if after else ""
    return f'<footer class="further"><span>{before}</span><span>{following}</span></footer>'

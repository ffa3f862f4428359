"""What stands around every page of the site: its head, its bar and its settings."""

from __future__ import annotations

import html
from pathlib import Path

STATIC = Path(__file__).with_name("static")


def framed(title: str, body: str, bar: str, name: str) -> str:
    """A body of HTML as a page of the site: its bar, its settings, its style."""
    page = (STATIC / "page.html").read_text(encoding="utf-8")
    for key, value in {"title": html.escape(title), "bar": bar, "name": name, "body": body}.items():
        page = page.replace(f"@{key}@", value)
    return page

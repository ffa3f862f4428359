"""Pages of stored explorers, made again by the server."""

import time
from concurrent.futures import ThreadPoolExecutor

from coursekit import view
from coursekit.view.reopened import page_of

LINE = "Explorer of screws: KUKA KR6 R900 sixx: joints ({}.0, 0.0, 0.0, 0.0, 0.0, 0.0) deg; tool at (0)"


def test_pages_that_a_notebook_asks_for_at_once_do_not_close_each_other(monkeypatch):
    to_html = view.to_html

    def slowly(panel):
        time.sleep(1)  # time enough for another request to make its explorer
        return to_html(panel)

    monkeypatch.setattr(view, "to_html", slowly)
    with ThreadPoolExecutor(3) as threads:
        pages = list(threads.map(page_of, map(LINE.format, (1, 2, 3))))
    assert len(set(pages)) == 3 and None not in pages

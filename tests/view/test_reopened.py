"""Pages of stored explorers, made again by the server."""

import re
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from coursekit import view
from coursekit.view.reopened import page_of

LINE = "Explorer of screws: KUKA KR6 R900 sixx: joints ({}.0, 0.0, 0.0, 0.0, 0.0, 0.0) deg; tool at (0)"


def test_pages_that_a_notebook_asks_for_at_once_do_not_close_each_other(monkeypatch):
    to_html = view.to_html

    def slowly(panel, common):
        time.sleep(1)  # time enough for another request to make its explorer
        return to_html(panel, common)

    monkeypatch.setattr(view, "to_html", slowly)
    with ThreadPoolExecutor(3) as threads:
        pages = list(threads.map(page_of, map(LINE.format, (1, 2, 3))))
    assert len(set(pages)) == 3 and None not in pages


def another_solution_of_another_target():
    panel = view.explore_inverse()
    panel.set(pose=[0.3, -0.4, 0.6, 0.1, 0.5, -0.2], solution=3)
    return panel


def in_the_middle_of_the_path():
    panel = view.explore_path()
    panel.rest_at(33)
    return panel


@pytest.mark.parametrize("leave", [another_solution_of_another_target, in_the_middle_of_the_path])
def test_the_arm_is_where_it_was_left(leave):
    panel = leave()
    line = repr(panel)
    panel.close()
    said = re.search(r'<p id="words">(.*?)</p>', page_of(line))[1]
    for before, now in zip(*(re.findall(r"-?\d+\.\d+", text) for text in (line, said)), strict=True):
        assert float(now) == pytest.approx(float(before), abs=2)  # the line has tenths of degrees
    assert said.split("(")[0] in line

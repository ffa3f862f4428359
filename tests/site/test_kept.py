"""What a student in the browser does not lose: by a reload, an endless loop, a second tab, a quick start."""

import pytest

from tests.site.test_run import READY, RIGHT, Student

pytestmark = pytest.mark.browser

LOOP = """() => { // without waiting for its end, which does not come
  const { content } = window.jupyterapp.shell.currentWidget;
  content.activeCellIndex = content.widgets.findIndex((cell) => cell.model.id === "half-steps");
  content.activeCell.model.sharedModel.setSource("while True:\\n    pass");
  void window.jupyterapp.commands.execute("notebook:run-cell");
}"""
KEPT = """async () => { // until what keeps the pages stands
  const keeper = () => navigator.serviceWorker.getRegistration(new URL("../../", location.href));
  while ((await keeper())?.active?.state !== "activated") await new Promise((done) => setTimeout(done, 200));
}"""
BUSY = READY.replace("idle", "busy")
SAVED = "() => !window.jupyterapp.shell.currentWidget.context.model.dirty"


def test_neither_a_reload_nor_an_endless_loop_costs_what_was_there(browser, run, served):
    with Student(browser, served.url) as student:
        student.go()
        page, bar = student.page, student.page.locator("#ck-bar .ck-state")
        student.run("setup")
        student.run("ex-dh-transform", RIGHT)
        assert "division" in student.run("half-steps", "1 / 0")  # what comes after it runs again all the same
        assert student.run("check-dh-transform").startswith("✓")
        page.wait_for_function(SAVED, timeout=60_000)  # nobody saved
        page.reload(wait_until="domcontentloaded")
        student.wait()
        bar.get_by_text("knows nothing yet of what ran before").wait_for(timeout=30_000)
        assert page.evaluate("() => [...window.jupyterapp.shell.widgets('main')].length") == 1  # no launcher
        bar.locator("[data-do=resume]").click()
        bar.get_by_text("has run again").wait_for(timeout=60_000)
        assert student.run("check-dh-transform").startswith("✓")
        page.evaluate(LOOP)
        page.wait_for_function(BUSY, timeout=30_000)
        page.click("[data-command='notebook:interrupt-kernel']")
        bar.get_by_text("The stop button cannot interrupt Python here").wait_for(timeout=30_000)
        bar.locator("[data-do=again]").click()
        bar.get_by_text("has run again").wait_for(timeout=120_000)
        assert student.run("check-dh-transform").startswith("✓")


def test_one_quick_visit_is_enough_for_days_without_a_network(browser, run, served):
    """The page was left before it was read, and what its scripts load came before the worker stood."""
    with Student(browser, served.url) as student:
        student.go()
        student.page.evaluate(KEPT)
        student.context.set_offline(True)
        student.go()
        assert student.run("setup") == ""


def test_a_second_tab_says_that_it_is_one(browser, run, served):
    with Student(browser, served.url) as student:
        student.go()
        warned = student.page.locator("#ck-bar .ck-warn")
        assert warned.inner_text() == ""
        first, student.page = student.page, student.context.new_page()
        student.go("02_msb_derivation.ipynb")
        warned = student.page.locator("#ck-bar .ck-warn")
        assert "open in another tab" in warned.inner_text()
        first.close()
        student.page.wait_for_function(
            "() => !document.querySelector('.ck-warn').textContent", timeout=30_000
        )

"""An explorer open in the browser: what a person does to it, and what the kernel says of it."""

import numpy as np

IMPORT = "from coursekit import robots, view"
SHOW = "panel = view.explore(robots.kuka_kr6())\npanel"


class Explorer:
    """The explorer of a notebook, open in the browser, and its panel in the kernel."""

    def __init__(self, notebook, panel, robot):
        self.notebook, self.page, self.robot = notebook, notebook.page, robot
        panels = "__import__('coursekit.view.cells', fromlist=['SHOWN']).SHOWN"
        self.panel = f"next(p for p in {panels} if p.name == {panel!r})"

    def kernel(self, attribute):
        """A value of the panel, such as "values['theta'].tolist()"."""
        return self.notebook.kernel(f"[p.{attribute} for p in [{self.panel}]][0]")

    def values(self, name="theta"):
        return np.array(self.kernel(f"values[{name!r}].tolist()"))

    def words(self):
        """The text under the picture, as the page shows it."""
        return self.page.locator(".ck-control .ck-text").first.inner_text()

    def slide(self, label, keys):
        """Give keys to the slider with this label."""
        handle = self.page.get_by_role("slider", name=label, exact=True)
        handle.focus()
        for key in keys:
            self.page.keyboard.press(key)
        self.settle()

    def choose(self, label, option):
        self.page.get_by_role("combobox", name=label, exact=True).select_option(option)
        self.settle()

    def press(self, name):
        self.page.get_by_role("button", name=name, exact=True).click()

    def settle(self):
        self.notebook.settle()

    def assert_arm_stands_at(self, theta):
        """Every link of the arm in the page is where the kinematics put it."""
        moved = self.robot.displacements(theta)
        last = self.notebook.wait_transform(f"/ck/robot/{self.robot.n}", moved[-1])
        np.testing.assert_allclose(last, moved[-1], rtol=0, atol=1e-9)
        for k in range(self.robot.n):
            found = self.notebook.transform(f"/ck/robot/{k + 1}")
            np.testing.assert_allclose(found, moved[k], rtol=0, atol=1e-9)

    def pause_from(self, number):
        """Press pause as soon as this pose of a motion is shown; the number of the pose where it rests."""
        self.page.wait_for_function("() => parseInt(document.querySelector('.ck-count').textContent) > 0")
        return self.page.evaluate(
            """async (number) => {
                 const shown = () => parseInt(document.querySelector(".ck-count").textContent);
                 while (shown() < number) await new Promise(requestAnimationFrame);
                 const button = document.querySelector(".ck-play");
                 if (button.textContent === "pause") button.click(); // from outside it would come late
                 const rests = shown();
                 await new Promise((done) => setTimeout(done, 700));
                 return button.textContent === "play" && shown() === rests ? rests : -1;
               }""",
            number,
        )

    def played_to_the_end(self, poses):
        """Wait for the last pose of a motion that plays."""
        end = f"{poses} / {poses}"
        self.page.wait_for_function(
            "end => document.querySelector('.ck-count').textContent === end", arg=end, timeout=60_000
        )
        self.page.wait_for_function("() => document.querySelector('.ck-play').textContent === 'play'")
        self.settle()

    def sliders(self, count):
        """What the first sliders say, in radians."""
        shown = self.page.eval_on_selector_all(
            "[role=slider]", "all => all.map((one) => Number(one.getAttribute('aria-valuenow')))"
        )
        return np.radians(shown[:count])


def handle(explorer, label):
    return explorer.page.get_by_role("button", name=label, exact=True)


def centre(explorer, label):
    box = handle(explorer, label).bounding_box()
    return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])


def finger(explorer, start, way):
    """Drag a finger from a place of the page by `way` pixels, and let go."""
    session = explorer.page.context.new_cdp_session(explorer.page)
    for kind, share in (("Start", 0), ("Move", 1 / 3), ("Move", 2 / 3), ("Move", 1), ("End", None)):
        at = [] if share is None else [dict(zip("xy", (start + share * np.array(way)).tolist(), strict=True))]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": at})
        explorer.page.wait_for_timeout(60)
    explorer.settle()

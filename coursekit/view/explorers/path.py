"""Notebook 06: an arm that draws a letter S on a sphere, every way it can, as fast as its joints allow."""

import functools

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import path, robots
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.controls import Choice, Toggle
from coursekit.view.explorers import Explorer, yours
from coursekit.view.explorers.letter import Letter
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot
from coursekit.view.prediction import ROOT
from coursekit.view.table import Table

POINTS = (101, 201, 501, 1001, 5001)
FRAMES = 501  # the most poses that are sent to the page
NORMALS = 26  # arrows drawn along the curve
ONE_BOUND = 2.0  # rad/s for every joint (RPI mini project 3, 2021, problem 3); m/s for a slide
STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)))
CAPTION = (
    "Rate of each joint in percent of its bound, at the largest speed that the bounds allow. "
    "Dotted: the bounds; dashed: where the arm is; click to put it elsewhere."
)


def explore_path(
    robot: Robot | None = None, points: ArrayLike | None = None, height: int = 470, mine: Given = None
) -> Panel:
    """Open the explorer of a path: a curve on a sphere with its outward normals, and the arm that follows it.

    The buttons under the picture play, pause and scrub the motion, in real time at the largest speed that
    the joints allow. The table compares all ways to follow the path. The plot shows the joint rates
    of the one that is shown: of its continuous angles or, to see what goes wrong, of wrapped ones.

    Parameters
    ----------
    robot : Robot, optional
        Any arm with two joints or more; the ABB IRB 1200 without it. An arm without a closed form
        (`ik.analytic`) follows the path numerically, from where random starts found it, as the text says; one
        that cannot follow the sphere gets a smaller letter where its tool can go.
    points : (m, 3), optional
        Another curve on the sphere of radius 0.5 m about (0, 0, 0.5), for instance from `path.load_points`;
        the letter S without it. ValueError where the arm cannot follow the curve in any way.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: tool_frames, quaternion, zyx, angle_axis, slerp, next_on_branch,
        inside, largest_speed (see `coursekit.view.mine`). ValueError for any other name.
    """
    return _Path(robots.abb_irb1200() if robot is None else robot, points, mine).open(height)


class _Path(yours.Path, Explorer):
    """The arm on the path: all branches at every sampling asked for so far, and the one that is shown."""

    name, title, opener = "path", "Explorer of the path", "explore_path"

    def __init__(self, robot, curve, mine):
        super().__init__(mine, robot)
        self.letter = Letter(robot, curve)
        self.follow = functools.cache(self.letter.follow)
        first, n = self.follow(POINTS[0]), POINTS[0]
        self.names = first.names
        inside = np.where(first.reached == n, first.inside, -1)
        best = np.flatnonzero(inside == inside.max())
        self.branch = min(best.tolist(), key=lambda k: np.abs(first.q[k, 0]).sum())  # the one nearest to zero
        self.place = 0
        self.choose(n, np.full(robot.n, ONE_BOUND), self.branch, False)
        self.draw()

    def draw(self):
        scene, robot = self.scene, self.robot
        self.arm = scene.robot(robot, self.q[self.branch, 0])
        pointing.axes(scene, self.arm)
        scene.frame(self.arm.link(robot.n) + "/tool", robot.M, size=0.12 * scene.size)
        scene.curve("/ck/curve", self.points)
        self.switched = {}
        if self.letter.on_sphere:
            some = np.linspace(0, len(self.points) - 1, NORMALS).round().astype(int)
            outward = 0.1 * path.frames(self.points)[some, :3, 0]
            self.switched = {
                "normals": scene.normals("/ck/normals", self.points[some], outward),
                "sphere": scene.sphere("/ck/sphere", path.SPHERE_CENTER, path.SPHERE_RADIUS),
            }

    def controls(self):
        slides = "prismatic" in self.robot.joint_types
        unit = "2 rad/s or 2 m/s each" if slides else "2 rad/s each"
        bounds = {unit: np.full(self.robot.n, ONE_BOUND)}
        if np.isfinite(self.robot.v_max).all():
            bounds["the robot's own"] = self.robot.v_max
        ways = {name: k for k, name in enumerate(self.names) if self.reached[k] == len(self.points)}
        counts = [n for n in POINTS if n <= self.letter.most]
        labels = {"normals": "outward normals", "sphere": "sphere"}
        return [
            Choice("branch", ways, self.names[self.branch], "way"),
            Choice("points", {str(n): n for n in counts}, label="points"),
            Choice("bounds", bounds, label="rate bounds"),
            Toggle("wrapped", "differences of wrapped angles"),
            *(Toggle(name, labels[name], start=True) for name in self.switched),
        ]

    def below(self):
        rates = Plot(self.plot, CAPTION, (5.2, 3.5), on_click=self.click, cursor=self.here, key=self.chosen)
        return [rates, Table("ways", self.table, "All ways along the path.")]

    def open(self, height):
        panel = super().open(height)
        self.send()
        return panel

    def update(self, values):
        self.choose(values["points"], values["bounds"], values["branch"], values["wrapped"])
        if self.panel and self.frame is None:  # the motion ends with every choice: here is another
            self.send()
            self.prediction.told = ""  # it was about the other choice
        self.place = int(self.shown[self.frame]) if self.panel else 0
        self.arm.theta = self.q[self.branch, self.place]
        for name, drawn in self.switched.items():
            drawn.show(values[name])

    def choose(self, n, bounds, branch, wrapped):
        """Take what the controls say."""
        now = self.follow(n)
        self.points, self.q, self.reached, self.inside = now.points, now.q, now.reached, now.inside
        self.branch, self.bounds, self.wrapped = branch, bounds, wrapped
        self.limit = path.speed_limit(self.q, self.points, bounds)
        self.faulty = path.speed_limit(self.wrapped_q(), self.points, bounds)

    # -- the motion in the page

    def send(self):
        """At most FRAMES poses of the branch, in real time at its largest speed."""
        n = len(self.points)
        self.shown = np.linspace(0, n - 1, min(n, FRAMES)).round().astype(int)
        self.scene.remove(ROOT)  # what is asked takes no part in it
        self._play_at(self.limit.speed[self.branch], self._at(self.shown), autoplay=False)

    def _play_at(self, speed, texts, autoplay=True):
        seconds = path.steps(self.points).sum() / speed
        fps = (len(self.shown) - 1) / seconds
        self.panel.play(self.q[self.branch, self.shown], fps=fps, texts=texts, autoplay=autoplay)

    # -- where is a joint at its bound, and where will the elbow be?

    def question(self, values):
        if self.frame:
            return questions.MOVED
        k, half = self.branch, len(self.points) // 2
        if self.number % 2:
            asked, name = f"the arm follows the letter to its middle, point {half + 1}.", "the place half-way"
            q, rest = self.q[k, [half]], self._rest
            return questions.which_elbow(self.robot, self.q[k, 0], q, [name], asked, lambda _i: rest(half))
        joint, size = self.limit.joint[k], self.scene.size
        use = np.abs(self._use(self.limit))
        middle = (self.points[1:] + self.points[:-1]) / 2  # of each step
        full = middle[self._at_bound()]
        others = {
            f"there joint {j + 1} is fastest": middle[use[:, j].argmax()]
            for j in range(self.robot.n)
            if use[:, j].max() > 0.01 and j != joint
        }

        def judge(guess):
            right = full[np.linalg.norm(full - guess, axis=1).argmin()]
            return questions.near(guess, right, others, questions.NEAR * size, []), right

        asked = f"joint {joint + 1} sets the largest speed. Where on the letter is it at its bound?"
        key = (self.robot.name, k, len(self.points), self.wrapped, *self.bounds)
        return questions.Question(
            f"{asked} Drag the point there.",
            key,
            self.points[0],
            judge,
            self.points,
            show=lambda right: self._rest(np.linalg.norm(middle - right, axis=1).argmin()),
        )

    def _at_bound(self):
        """The steps in which the joint that sets the speed is at its bound: two where it is symmetric."""
        return np.flatnonzero(np.abs(self._use(self.limit)[:, self.limit.joint[self.branch]]) > 1 - 1e-9)

    def _rest(self, place):
        self.panel.rest_at(np.abs(self.shown - place).argmin())

    # -- words, table, plot

    def _at(self, places):
        """One line for each of these points of the path."""
        n, lines = len(self.points), []
        use = 100 * np.abs(self._use(self.limit))
        for i in places:
            share = ", ".join(text.number(u, 0) for u in use[min(i, n - 2)])
            lines.append(f"point {i + 1} of {n}: joints at {share} percent of their bounds")
        return lines

    def _use(self, limit):
        """Share of its bound that each joint uses in each step, at that limit's speed. (m - 1, n), signed."""
        q = self.wrapped_q() if limit is self.faulty else self.q
        return path.joint_rates(q[self.branch], self.points, limit.speed[self.branch]) / self.bounds

    def words(self, values):
        k, theta = self.branch, self.q[self.branch, self.place]
        joint = self.limit.joint[k]
        where = (
            "" if self.asking else " " + " and ".join(f"after point {i + 1}" for i in self._at_bound()[:2])
        )
        inside = "inside" if self.robot.within_limits(theta) else "outside"
        speed, bound = text.number(self.limit.speed[k], 4), text.number(self.bounds[joint])
        return [
            self.names[k],  # the point of the path and its rates stand beside the buttons of the motion
            f"joints {text.joints(self.robot.joint_types, theta)}: {inside} the limits",
            f"largest speed {speed} m/s: joint {joint + 1} at {bound} {self.rate_unit(joint)}{where}",
            *self.letter.remarks,
            *([self._fault()] if self.wrapped else []),
        ]

    def formula(self, values):
        """The speed that each joint allows; the least of them counts."""
        rates = np.abs(path.joint_rates(self.q[self.branch], self.points, 1.0)).max(axis=0)
        says = []
        for k, (rate, bound) in enumerate(zip(rates, self.bounds, strict=True)):
            may, unit = text.number(bound), self.rate_unit(k)
            allowed = f"{text.number(bound / rate, 4)} m/s" if rate > 1e-9 else "any speed"
            needs = f"needs {text.number(rate)} {unit} at most for 1 m/s of the tool"
            says.append(f"joint {k + 1} {needs} and may go {may} {unit}, which allows {allowed}")
        return [["largest speed = min( ", *pointing.series("v", says, "theta"), " )"]]

    def rate_unit(self, joint):
        return "rad/s" if self.letter.turns[joint] else "m/s"

    def wrapped_q(self):
        """Angles within half a turn. Rounded first: at theta = pi the last digit would decide the sign."""
        return np.where(self.letter.turns, np.angle(np.exp(1j * np.round(self.q, 9))), self.q)

    def _fault(self):
        """What the differences of wrapped angles make of this branch."""
        k, joint, i = self.branch, self.faulty.joint[self.branch], self.faulty.index[self.branch]
        seems, turns = (np.ptp(q[k, i : i + 2, joint]) for q in (self.wrapped_q(), self.q))
        speed = f"from wrapped angles {text.number(self.faulty.speed[k], 4)} m/s:"
        if seems < np.pi:
            return f"{speed} no angle wraps on this way"
        jump = f"joint {joint + 1} seems to turn {text.number(seems)} rad; it turns {text.number(turns)} rad"
        return f"{speed} after point {i + 1} {jump}"

    def table(self, values):
        """Header and rows: way, largest speed, the joint that sets it, points inside, spread of q3."""
        n, rows, limit = len(self.points), [], self.faulty if self.wrapped else self.limit
        for k, name in enumerate(self.names):
            inside = f"{self.inside[k]} of {n}" if self.reached[k] == n else f"breaks after {self.reached[k]}"
            joint = limit.joint[k] + 1 if self.reached[k] == n else text.NOTHING
            spread = text.number(np.std(self.q[k, :, min(2, self.robot.n - 1)], ddof=1), 4)
            rows.append([name, text.number(limit.speed[k], 4), joint, inside, spread])
        return ["way", "speed [m/s]", "joint", "points inside limits", "std q3 [rad]"], rows

    def plot(self, figure, values):
        """Joint rates over the path, in percent of the bounds."""
        ax, step = figure.subplots(), path.steps(self.points)
        if self.asking:
            ax.text(0.5, 0.5, "Hidden until the question is answered.", ha="center")
            return ax.set_axis_off()
        use = 100 * self._use(self.faulty if self.wrapped else self.limit)
        for j, rate in enumerate(use.T):
            ax.plot(self.along()[:-1] + step / 2, rate, ls=STYLES[j % 6], lw=1.6, label=f"joint {j + 1}")
        for bound in (-100, 100):
            ax.axhline(bound, color=ax.xaxis.label.get_color(), ls=":", lw=1.2)
        ax.set(xlabel="distance along the path [m]", ylabel="rate [% of its bound]", ylim=(-115, 115))
        ax.legend(ncols=3, fontsize=8.5, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0))

    def along(self):
        """How far along the path each of its points is, metres."""
        return np.append(0.0, np.cumsum(path.steps(self.points)))

    def chosen(self, values):
        """What the plot shows: every choice but the drawn surfaces."""
        return self.asking, values["points"], values["branch"], values["wrapped"], *values["bounds"]

    def here(self, values):
        """Where the arm is."""
        return [] if self.asking else [self.along()[self.place], np.nan]

    def click(self, s, _y):
        """Put the arm at the pose of the motion nearest to s along the path."""
        self.panel.rest_at(np.abs(self.along()[self.shown] - s).argmin())

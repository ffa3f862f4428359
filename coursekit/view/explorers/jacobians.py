"""Notebook 05: ellipsoids at the tool, one Jacobian by four methods, Newton against damped least squares."""

from collections.abc import Mapping
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import checks, ik, jacobians, robots, singularity
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.chain import hinges
from coursekit.view.controls import Action, Slider, Toggle, joint_sliders
from coursekit.view.explorers import Explorer, yours
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot, decades
from coursekit.view.shapes import frame_along
from coursekit.view.target import HELD, pose_of, pose_sliders

STRETCHED = (0.0, 0.6, 0.0, -0.08, 0.0, 0.5, 0.7)  # of the Panda: elbow almost straight
NEARLY_ZERO = 0.05  # rad or m; the start of every other arm
STEPS = 50
SCALE = {"linear": 0.3, "angular": 0.1}  # on a stage of 1 m
UNIT = {"linear": "m/s", "angular": "rad/s"}
COLOR = {"linear": "trace", "angular": "axis"}
COLUMNS = "/ck/columns"
ASIDE = (0.48, 0.6, 0.64)  # where the x axis of an arrow leans: no joint moves the tool just there
CAPTION = (
    "How far the joints turn in each step towards {d}: Newton (circles) leaps where the arm is nearly "
    "singular, damped least squares (squares) does not. Click to see the arm after a step."
)
METHODS = {
    "skew": jacobians.skew_theory,
    "derivative": jacobians.by_matrix_derivative,
    "differences": jacobians.by_differences,
}


def explore_jacobians(
    robot: Robot | None = None,
    height: int = 470,
    poses: Mapping[str, ArrayLike] | None = None,
    theta: ArrayLike | None = None,
    mine: Given = None,
) -> Panel:
    """Open the explorer of Jacobian methods.

    The sliders set the configuration. At the tool stand the ellipsoids of its linear and angular velocity
    for joint rates of length 1; the text gives their true half axes. Newton's method and damped least squares
    start where the arm stands and go for the frame {d}, which six sliders move; the plot shows how long their
    steps are.

    Parameters
    ----------
    robot : Robot, optional
        Any arm; the Franka Panda without it.
    poses : mapping of name -> theta (n,), optional
        Configurations with a name, each with a button that drives the arm there; beyond the limits, too, and
        the sliders say so.
    theta : (n,), optional
        Where the arm stands at first, radians and metres.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: jacobian_space, jacobian_geometric, jacobian_by_differences,
        jacobian_column, transform_rate, torques, ellipsoid, dls_step, dls_loop (see `coursekit.view.mine`).
        ValueError for any other name.
    """
    robot = robots.franka_panda() if robot is None else robot
    named = {name: checks.joint_angles(pose, robot.n, robot.name) for name, pose in (poses or {}).items()}
    return _Jacobians(robot, named, mine).open(height, theta)


class _Jacobians(yours.Jacobians, Explorer):
    """The ellipsoids of the arm as it stands; Newton and damped least squares from there to the target."""

    name, title, opener = "jacobians", "Explorer of Jacobian methods", "explore_jacobians"

    def __init__(self, robot, poses, mine):
        super().__init__(mine, robot)
        self.poses = poses
        goal = robot.home
        # a goal that is singular itself shows nothing but slowness, one in the floor cannot be
        if singularity.sigma_min(robot, goal) < 0.05:
            beside = [np.clip(goal + by, robot.q_min, robot.q_max) for by in (0.5, -0.5)]
            goal = next((theta for theta in beside if robot.fk(theta)[2, 3] >= 0), beside[0])
        self.near = _nearly_singular(robot)
        self.pose = pose_sliders(robot.fk(goal), robot)
        self.pose.folded = "where {d} is"
        self.target = pose_of(self.pose.get())
        self._key, self._found = None, {}
        self.start, self.settings = self.near, ()  # of the runs
        self.playing = ""  # the run that a motion shows, or else it leads to another start
        self.arm = self.scene.robot(robot, self.near)
        pointing.axes(self.scene, self.arm, lambda k: f"J{k}")
        self.goal = self.scene.frame("/ck/target", self.target, letter="d", size=0.14 * self.scene.size)
        # metres drawn for 1 m/s and for 1 rad/s; rounded, so that the text is exact
        self.scale = {part: round(scale * self.scene.size, 2) for part, scale in SCALE.items()}
        self.arm.shapes = {f"/ck/{part}": (part, scale) for part, scale in self.scale.items()}
        self.scene.make_room(self.target[:3, 3], HELD * self.scene.size)
        self.scene.make_room(self._ends_of_ellipsoids([self.near, *poses.values()]))
        self.arm.shapes[COLUMNS], size = ("linear", 0), self.scale["linear"]
        for k in range(1, robot.n + 1):  # arrows of one shape that are placed and stretched
            look = pointing.COLOR, f"v{k}", 0.03 * size
            pointing.mean(self.scene.arrow(f"{COLUMNS}/{k}", np.zeros(3), [0, 0, size], *look), f"J{k}")

    def _ends_of_ellipsoids(self, thetas):
        """How far the linear ellipsoids reach, (2, m, 3), where the arm stands at these thetas (m, n)."""
        T, J = self.robot.fk(np.array(thetas)), self.robot.jacobian_geometric(np.array(thetas))
        tools, half = T[:, :3, 3], self.scale["linear"] * np.linalg.norm(J[:, 3:], axis=2)
        return np.stack([tools - half, tools + half])

    def start_at(self, theta):
        super().start_at(theta)
        self.start = theta

    def controls(self):
        self.joints = joint_sliders(self.robot, self.near)
        return [
            self.joints,
            self.pose,
            Toggle("linear", "linear ellipsoid (teal)", start=True),
            Toggle("angular", "angular ellipsoid (violet)"),
            Slider("damping", 0.1, 0.01, 1.0, step=0.01, label="damping k"),
            Action("bent", "home pose", lambda: self.panel.set(theta=self.robot.home)),
            Action("near", "near the singularity", lambda: self.panel.set(theta=self.near)),
            Action("newton", "play Newton", lambda: self.play("newton")),
            Action("damped", "play damped", lambda: self.play("damped")),
            *(
                Action("to_" + name.replace(" ", "_"), name, partial(self.drive_to, theta))
                for name, theta in self.poses.items()
            ),
        ]

    def below(self):
        return [Plot(self.plot, CAPTION, on_click=self.click, cursor=self.here, key=self.runs)]

    def update(self, values):
        settings = (values["damping"], *values["pose"])
        if settings != self.settings:  # another run, from the same start
            self.settings = settings
            if self.panel:
                self.joints.show(self.start)
        self.target = pose_of(values["pose"])
        self.goal.move(self.target)
        self.arm.theta = self.joints.get()
        if self.frame is None or not self.playing:
            self.start = self.arm.theta
        self.draw(self.arm.theta)
        for part in SCALE:
            self.scene[f"/ck/{part}"].show(values[part])

    def draw(self, theta):
        """Both ellipsoids at the tool, and how far each joint alone moves it, to the same scale."""
        J, tool = self.robot.jacobian_geometric(theta), self.robot.fk(theta)[:3, 3]
        for part, scale in self.scale.items():
            e = jacobians.ellipsoid(J, part)
            self.scene.ellipsoid(f"/ck/{part}", e.axes, scale * e.lengths, tool, COLOR[part])
        for k, v in enumerate(J[3:].T, 1):
            self.scene[f"{COLUMNS}/{k}"].move(arrow_at(v, tool))

    def formula(self, values):
        """The columns of the Jacobian: what each joint does to the tool, which is what is asked."""
        if self.asking:
            return []
        J = self.robot.jacobian_geometric(values["theta"])
        columns = (
            f"column {k}: joint {k} at 1 {'rad' if turns else 'm'}/s moves the tool point by "
            f"{text.row(column[3:])} m/s and turns the tool by {text.row(column[:3])} rad/s"
            for k, (column, turns) in enumerate(zip(J.T, hinges(self.robot), strict=True), 1)
        )
        return [["J(θ) = ( ", *pointing.series("J", columns), " )"]]

    # -- which way does the tool go?

    def begin(self, number):
        self.asked_at = self.joints.get()

    def question(self, values):
        robot, theta = self.robot, values["theta"]
        if not np.array_equal(theta, self.asked_at):
            return questions.MOVED
        J = robot.jacobian_geometric(theta)
        speed = np.linalg.norm(J[3:], axis=0)
        fast = np.flatnonzero(speed > max(0.1 * speed.max(), 1e-6))
        if not len(fast):
            return questions.NONE
        j = int(fast[self.number % len(fast)])
        w, v = J[:3, j], J[3:, j]
        others = {"that is the axis, and the tool moves across it": w}
        others["that is the lever, from the axis to the tool, and the tool moves across it"] = np.cross(v, w)
        others |= {f"as if joint {k + 1} moved": J[3:, k] for k in (j - 1, j + 1) if 0 <= k < robot.n}
        rate = "1 rad/s" if np.any(w) else "1 m/s"
        asked = f"joint {j + 1} alone moves, at {rate}. Which way does the tool go? Drag the arrow's tip."
        return questions.which_way(
            robot.fk(theta)[:3, 3], v, others, asked, (robot.name, j, *theta), self.scene.size
        )

    def words(self, values):
        J = self.robot.jacobian_geometric(values["theta"])
        for part, scale in self.scale.items():
            lengths, unit = jacobians.ellipsoid(J, part).lengths, UNIT[part]
            shown = f"drawn {text.number(1000 * scale, 0)} mm per {unit}" if values[part] else "hidden"
            yield f"{part:<8} half axes {text.row(lengths)} {unit}, {shown}"
        apart = (
            f"{name} {np.abs(method(self.robot, values['theta']) - J).max():.0e}"
            for name, method in METHODS.items()
        )
        yield f"largest difference to the exponentials: {', '.join(apart)}"
        yield f"smallest singular value {text.number(singularity.sigma_min(self.robot, values['theta']))}"
        yield self.comparison(values)

    def found(self, values):
        """Name -> Numeric from the start, computed once for the same sliders."""
        theta, k = self.start, values["damping"]
        key = (*theta, *self.settings)
        if key != self._key:
            common = {"max_iterations": STEPS, "tol": 1e-8, "rows": "all" if self.robot.n > 5 else "linear"}
            self._key = key
            self._found = {
                "newton": ik.newton(self.robot, self.target, theta, **common),
                "damped": ik.damped_least_squares(self.robot, self.target, theta, damping=k, **common),
            }
        return self._found

    def drive_to(self, theta):
        self.playing = ""
        self._drive_to(theta, self.draw)

    def play(self, name, autoplay=True):
        """Show the steps of one method, two a second."""
        steps = [step.theta for step in self.found(self.panel.values)[name].history]
        self.playing = name
        self.panel.play(np.array(steps), fps=2.0, autoplay=autoplay, follow=self.draw)

    def comparison(self, values):
        """Steps and longest step of both methods."""
        parts, unit = [], "rad" if hinges(self.robot).all() else "rad and m"
        titles = "Newton", f"damped, k = {text.number(values['damping'], 2)}"
        for title, found in zip(titles, self.found(values).values(), strict=True):
            longest = max(step.step for step in found.history)
            count = f"{found.iterations} steps" if found.converged else f"not there after {STEPS} steps"
            parts.append(f"{title}: {count}, the longest {text.number(longest, 2)} {unit}")
        begun = "" if self.frame is None or not self.playing else f" from the start, shown: step {self.frame}"
        return f"to {{d}}{begun}  " + "; ".join(parts)

    def plot(self, figure, values):
        """Length of each step, on a log axis."""
        ax = figure.subplots()
        for (name, found), style in zip(self.found(values).items(), ("o-", "s--"), strict=True):
            steps = _lengths_of(found)
            ax.semilogy(range(1, len(steps) + 1), steps, style, ms=4, label=name)
        ax.set(xlabel="step", ylabel="length of the step [rad]", ylim=(1e-9, 1e3))
        decades(ax, (-8, -6, -4, -2, 0, 2))
        ax.legend(frameon=False)

    def runs(self, values):
        """Where both methods start, and what else decides their steps."""
        return *self.start, *self.settings

    def here(self, values):
        """The step that led to what is shown."""
        found = self.found(values).get(self.playing)
        return [self.frame, _lengths_of(found)[self.frame - 1]] if found and self.frame else []

    def click(self, x, y):
        """Show what a step led to, of the method whose mark is nearer."""
        away = {}
        for name, found in self.found(self.panel.values).items():
            steps = _lengths_of(found)
            if len(steps):
                away[name] = abs(np.log(steps[min(max(round(x), 1), len(steps)) - 1] / y))
        if away:
            name = min(away, key=lambda name: away[name])
            if self.frame is None or self.playing != name:
                self.play(name, autoplay=False)
            self.panel.rest_at(round(x))


def arrow_at(v: ArrayLike, tool: ArrayLike) -> np.ndarray:
    """Where the arrow of a velocity (3,) stands at a point (3,), (4, 4); the page does the same by itself."""
    speed = float(np.linalg.norm(v))
    long = max(speed, 1e-6)
    T = frame_along(v if speed > 1e-6 else (0, 0, 1), tool, ASIDE)
    T[:3, :3] *= [np.sqrt(long), np.sqrt(long), long]  # a short one is not thin as a hair
    return T


def _lengths_of(found):
    """Length of each step as it is plotted: one of 0 has a place on a log axis, too."""
    return np.maximum([step.step for step in found.history[1:]], 1e-9)


def _nearly_singular(robot):
    """A start close to a singular configuration and inside the limits."""
    theta = np.array(STRETCHED) if robot.n == len(STRETCHED) else np.full(robot.n, NEARLY_ZERO)
    return np.clip(theta, robot.q_min, robot.q_max)

"""Notebook 03: every configuration that reaches a pose, and the one Newton's method finds from a guess."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import ik, robots, rotations
from coursekit.kinematics.robot import Robot
from coursekit.view import text
from coursekit.view.controls import Action, Slider, Sliders, Table, Toggle, joint_sliders
from coursekit.view.explorers import Explorer, yours
from coursekit.view.paint import PALETTE
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot

# The pose of table 4.1 of the TPK4170 report (2021) for the KR6; a pose in reach for every other arm.
CONFIGURATION = (2.0, -1.0, -1.0, 2.5, 0.6, 0.0)
GUESS = (-1.0, -2.0, 1.0, 0.0, 0.3, 0.0)
STEPS = 50


def explore_inverse(
    robot: Robot | None = None,
    height: int = 470,
    target: ArrayLike | None = None,
    mine: Callable | list | dict | None = None,
) -> Panel:
    """Open the explorer of inverse kinematics.

    Six sliders say where the tool should be. The branch chosen in the table is drawn solid, every other
    solution translucent; the table gives all joint angles and why a solution is outside the limits or does
    not exist. Newton's method starts from the guess of the last sliders; its error is plotted, and the button
    shows its steps. A target out of reach leaves the solid arm where it was and shows the closest pose found
    as a ghost.

    Parameters
    ----------
    robot : Robot, optional
        An arm with an analytic solution (`ik.analytic`); the KUKA KR6 without it. ValueError for any other.
    target : (4, 4), optional
        Where the tool should be at first.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: wrist_centre, elbow_solutions, wrist_angles, all_solutions,
        newton_step (see `coursekit.view.mine`). ValueError for any other name.
    """
    return _Inverse(robots.kuka_kr6() if robot is None else robot, target, mine).open(height)


class _Inverse(yours.Inverse, Explorer):
    """The target, its solutions, the branch that is shown and Newton's run."""

    name, title, opener = "inverse", "Explorer of inverse kinematics", "explore_inverse"

    def __init__(self, robot, target, mine):
        super().__init__(robot, mine)
        self.T = robot.fk(np.resize(CONFIGURATION, robot.n)) if target is None else np.array(target, float)
        solutions = ik.analytic(robot, self.T)  # refuses arms without an analytic solution
        self.chosen = int(solutions.nearest(np.resize(CONFIGURATION, robot.n)))
        self.shown = _half_turns(solutions.turned)[self.chosen]
        self.arm = self.scene.robot(robot, self.shown)
        self.target = self.scene.frame("/ck/target", self.T, size=0.08 * self.scene.size)

    def controls(self):
        robot = self.robot
        start = np.clip(np.resize(GUESS, robot.n), robot.q_min, robot.q_max)
        guess = joint_sliders(robot, start, name="guess")
        for slider in guess.sliders:
            slider.label = f"guess {slider.label}"
        return [
            Sliders("pose", _pose_sliders(self.T, np.ceil(12 * self.scene.size) / 10)),
            Toggle("others", "other solutions", start=True),
            Toggle("trace", "Newton's way"),
            Action("steps", "show Newton's steps", self.play),
            guess,
        ]

    def below(self):
        all_solutions = "All solutions; choose one."
        left = "Newton from the guess: angle (circles) and distance (squares) left before each step."
        return [Table("solution", self.table, all_solutions, True, self.chosen), Plot(self.plot, left)]

    def update(self, values):
        self.solve(values["pose"], values["guess"], values["solution"])
        self.arm.theta = self.shown
        self.target.move(self.T)
        self.draw_ghosts(self.others() if values["others"] else {})
        way = self.robot.fk(self.steps())[:, :3, 3]
        if values["trace"] and len(way) > 1:
            self.scene.curve("/ck/newton", way)
        else:
            self.scene.remove("/ck/newton")

    def play(self):
        self.panel.play(self.steps(), fps=2.0)

    def solve(self, pose, guess, row):
        self.T = np.eye(4)
        self.T[:3, :3], self.T[:3, 3] = rotations.from_zyx(pose[3:]), pose[:3]
        self.solutions = ik.analytic(self.robot, self.T)
        exists = self.solutions.exists
        if 0 <= row < len(exists) and exists[row]:
            self.chosen = row
        elif exists.any() and not exists[self.chosen]:
            self.chosen = int(self.solutions.nearest(self.shown))
        self.reached = bool(exists.any())
        self.theta = _half_turns(self.solutions.turned)
        if self.reached:
            self.shown = self.theta[self.chosen]
        rows = "linear" if self.robot.n < 6 else "all"
        self.found = ik.newton(self.robot, self.T, guess, max_iterations=STEPS, tol=1e-9, rows=rows)

    def others(self):
        """Ghost name -> configuration: the other solutions or, out of reach, the closest pose found.

        While the arm shows Newton's steps, the chosen solution is another one, too.
        """
        if not self.reached:
            return {"closest": self.found.theta}
        return {
            f"branch{k}": theta
            for k, theta in enumerate(self.theta)
            if self.solutions.exists[k] and (k != self.chosen or self.frame is not None)
        }

    def draw_ghosts(self, wanted):
        """Exactly these translucent arms. wanted: name -> configuration."""
        present = {
            name: arm
            for name, arm in self.scene.robots.items()
            if arm.style == "ghost" and arm.color == "ghost"
        }
        for name in present.keys() - wanted.keys():
            present[name].remove()
        for name, theta in wanted.items():
            if name in present:
                present[name].theta = theta
            else:
                self.scene.robot(self.robot, theta, name=name, style="ghost")

    def steps(self):
        """Newton's configurations (N, n), the guess first."""
        return np.array([step.theta for step in self.found.history])

    def words(self, values):
        exists, inside = self.solutions.exists, self.solutions.within_limits
        lines = [f"target: {text.pose(self.T)}"]
        if self.reached:
            count = f"{exists.sum()} of {len(exists)} solutions, {inside.sum()} inside the limits"
            lines += [f"{count}; {self.which()}"]
        else:
            lines += [f"out of reach: no solution; {self.which()}"]
        return "\n".join([*lines, f"Newton from the guess: {self.verdict()}"])

    def which(self):
        """What the solid arm shows."""
        if self.frame is None:
            name = f"shown: {self.solutions.branches[self.chosen]}," if self.reached else "the arm stays at"
            return f"{name} {text.degrees(self.shown)}"
        step = self.found.history[self.frame]
        angle, distance = text.degrees(step.error[0]), text.millimetres(step.error[1])
        at = f"{self.frame} of {self.found.iterations}, {text.degrees(step.theta)}"
        return f"shown: Newton's step {at}, {angle} and {distance} away"

    def verdict(self):
        """What Newton's method came to, in words."""
        angle, distance = self.found.error
        if self.found.converged:
            branch = self.solutions.branches[int(self.solutions.nearest(self.found.theta))]
            return f"{self.found.iterations} steps to {branch}"
        left = f"{text.degrees(angle)} and {text.millimetres(distance)} away"
        return f"no solution in {STEPS} steps; the closest pose found is {left}"

    def table(self, values):
        """Header and rows: branch, joint angles in degrees, whether the limits are kept, or why not."""
        header = ["branch", *(f"θ{i + 1} [deg]" for i in range(self.robot.n)), "limits"]
        rows = []
        for branch, theta, inside, reason in zip(
            self.solutions.branches,
            np.degrees(self.theta),
            self.solutions.within_limits,
            self.solutions.reasons(),
            strict=True,
        ):
            missing = "does not exist" if np.isnan(theta[0]) else ""
            rows.append(
                [branch, *(text.number(t, 1) for t in theta), "inside" if inside else reason or missing]
            )
        return header, rows

    def plot(self, figure, values):
        """Angle and distance before each step of Newton's method, on a log axis."""
        ax = figure.subplots()
        error = np.array([step.error for step in self.found.history])
        for column, name, style, color in (
            (0, "angle [rad]", "o-", "trace"),
            (1, "distance [m]", "s--", "accent"),
        ):
            ax.semilogy(
                np.maximum(error[:, column], 1e-17), style, ms=4, label=name, color=f"#{PALETTE[color]:06X}"
            )
        if self.frame is not None:
            ax.axvline(self.frame, color="black", ls="--", lw=1)
        ax.minorticks_off()  # many ticks are slow to draw
        ax.set(xlabel="step", ylabel="angle, distance left", ylim=(1e-17, 10), yticks=[1e-15, 1e-10, 1e-5, 1])
        ax.set_title(self.verdict().split(";")[0], fontsize=10)
        ax.legend(frameon=False)


def _half_turns(theta):
    """Half a turn is +180 degrees, whichever way rounding went."""
    return np.where(np.abs(theta + np.pi) < 1e-9, np.pi, theta)


def _pose_sliders(T, reach):
    """x, y, z and yaw, pitch, roll of the target."""
    turns = rotations.zyx(T[:3, :3])
    ends = {"yaw": np.pi, "pitch": np.pi / 2, "roll": np.pi}
    return [
        *(Slider(n, p, -reach, reach, "mm") for n, p in zip("xyz", T[:3, 3], strict=True)),
        *(Slider(n, t, -ends[n], ends[n], "deg") for n, t in zip(ends, turns, strict=True)),
    ]

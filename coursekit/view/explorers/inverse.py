"""Notebook 03: every configuration that reaches a pose, and the one Newton's method finds from a guess."""

import functools

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import ik, robots, rotations
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.chain import hinges, shown_per_si
from coursekit.view.controls import Action, Toggle, joint_sliders
from coursekit.view.explorers import Explorer, yours
from coursekit.view.explorers.solver import Solver
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot, decades
from coursekit.view.silhouettes import silhouettes
from coursekit.view.table import Table
from coursekit.view.target import HELD, pose_of, pose_sliders

# A pose in reach of every arm, where the eight solutions of a KR6 keep the limits and look different.
CONFIGURATION = (0.6, -1.0, 1.2, 0.7, 0.8, 0.3)
GUESS = (-1.0, -2.0, 1.0, 0.0, 0.3, 0.0)
FROM_HOME = (0.5, 0.3, -0.3, 0.4)  # rad, of an arm without a closed form; a slide goes a fifth of that in m
STEPS = 50


def explore_inverse(
    robot: Robot | None = None, height: int = 470, target: ArrayLike | None = None, mine: Given = None
) -> Panel:
    """Open the explorer of inverse kinematics.

    Six sliders say where the tool should be. For an arm with a closed form a line under each shows where
    along it there is a solution, the other five held, and a bar where one keeps the joint limits. The way
    chosen in the table is drawn solid, every other solution translucent; the table gives all joint angles and
    why a solution is outside the limits or does not exist. Newton's method starts from the guess of the last
    sliders; its error is plotted, and the button shows its steps. A target out of reach leaves the solid arm
    where it was and shows the closest pose found as a ghost.

    Parameters
    ----------
    robot : Robot, optional
        Any arm; the KUKA KR6 without it. Where it has no closed form (`ik.analytic`), the solutions are those
        that random starts find, as the text says.
    target : (4, 4), optional
        Where the tool should be at first.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: wrist_centre, elbow_solutions, wrist_angles, all_solutions,
        newton_step (see `coursekit.view.mine`). ValueError for any other name.
    """
    return _Inverse(robots.kuka_kr6() if robot is None else robot, target, mine).open(height)


class _Inverse(yours.Inverse, Explorer):
    """The target, its solutions, the one that is shown and Newton's run."""

    name, title, opener = "inverse", "Explorer of inverse kinematics", "explore_inverse"

    def __init__(self, robot, target, mine):
        super().__init__(mine, robot)
        self.solver = Solver(robot)
        self.start = start = _configuration(robot, self.solver.closed)
        self.T = robot.fk(start) if target is None else np.array(target, float)
        self.pose = pose_sliders(self.T, robot, reach=self.solver.reaches if self.solver.closed else None)
        self.ways = self.solver.solve(self.T, start[None])
        self.chosen = self.solver.nearest(self.ways, start)
        self.shown = self.ways.theta[self.chosen] if self.chosen >= 0 else start
        self.arm = self.scene.robot(robot, self.shown)
        pointing.axes(self.scene, self.arm)
        self.target = self.scene.frame("/ck/target", self.T, letter="d", size=0.08 * self.scene.size)
        self.arm.goal = self.target.path
        self.scene.make_room(robot.fk(self.shown)[:3, 3], HELD * self.scene.size)

    def controls(self):
        robot = self.robot
        start = np.clip(np.resize(GUESS, robot.n), robot.q_min, robot.q_max)
        guess = joint_sliders(robot, start, name="guess")
        guess.folded = "Newton's guess"
        for slider in guess.sliders:
            slider.label = f"guess {slider.label}"
        return [
            self.pose,
            Toggle("others", "other solutions", start=True),
            Toggle("trace", "Newton's way"),
            Action("steps", "show Newton's steps", self.play),
            guess,
        ]

    def below(self):
        which = "All solutions" if self.solver.closed else "Solutions found by restarts"
        left = "Newton from the guess: angle (circles) and distance (squares) left before each step."
        self.list = Table("solution", self.table, f"{which}; choose one.", True, self.chosen, self.figures)
        left += " Click to see the arm at a step."
        run = Plot(self.plot, left, on_click=self.click, cursor=self.here, key=self.run)
        return [self.list, run]

    def update(self, values):
        self.solve(values["pose"], values["guess"], values["solution"])
        self.arm.theta = self.shown
        self.target.move(self.T)
        self.draw_ghosts(self.others(), values["others"])
        if values["trace"] and self.found.iterations:
            self.scene.curve("/ck/newton", self.robot.fk(self.steps())[:, :3, 3])
        else:
            self.scene.remove("/ck/newton")

    def play(self, autoplay=True):
        self.panel.play(self.steps(), fps=2.0, autoplay=autoplay)

    # -- where will the elbow be?

    def begin(self, number):
        """Another target: the solutions of this one are known."""
        T = self.robot.fk(questions.a_pose(self.robot, self.start, number + 1))
        self.pose.put([*T[:3, 3], *rotations.zyx(T[:3, :3])])

    def question(self, values):
        if not self.reached:
            return "Predict: nothing, as this target is out of reach. Move it, or: next question."
        if "endlessly" in self.ways.count:
            return "Predict: not here: this arm has endlessly many solutions, and its elbow no place."
        rows, names = np.flatnonzero(self.ways.exists), np.array(self.ways.names)[self.ways.exists]
        asked = "the arm waits at home, and will go where the tool is at {d}."
        return questions.which_elbow(
            self.robot, self.robot.home, self.theta[rows], names, asked, lambda i: self.list.put(int(rows[i]))
        )

    def secret(self):
        self.arm.theta = self.robot.home
        self.draw_ghosts({}, False)

    def solve(self, pose, guess, row):
        """The ways to the target, which of them is shown, and Newton's run."""
        before, self.T = self.T, pose_of(pose)
        if self.solver.closed or not np.array_equal(before, self.T):
            known = self.ways.theta if self.ways.exists.any() else self.shown[None]
            self.ways = self.solver.solve(self.T, known)
            if not self.solver.closed:  # rows come and go: the same row may be another solution now
                row = self.solver.nearest(self.ways, self.shown)
                self.list.put(row)
        exists = self.ways.exists
        if 0 <= row < len(exists) and exists[row]:
            self.chosen = row
        elif exists.any() and not exists[self.chosen]:
            self.chosen = self.solver.nearest(self.ways, self.shown)
        self.reached, self.theta = bool(exists.any()), self.ways.theta
        if self.reached:
            self.shown = self.ways.theta[self.chosen]
        self.guess = guess
        self.__dict__.pop("found", None)  # it is of another target or guess

    @functools.cached_property
    def found(self):
        """Newton's run to this target: after the solutions are sent, unless the picture shows it, too."""
        rows = self.solver.rows
        return ik.newton(self.robot, self.T, self.guess, max_iterations=STEPS, tol=1e-9, rows=rows)

    def others(self):
        """Ghost name -> configuration: the other solutions or, out of reach, the closest pose found.

        While the arm shows Newton's steps, the chosen solution is another one, too.
        """
        if not self.reached:
            return {"closest": self.found.theta}
        return {
            f"branch{k}": theta
            for k, theta in enumerate(self.ways.theta)
            if self.ways.exists[k] and (k != self.chosen or self.frame is not None)
        }

    def draw_ghosts(self, wanted, shown):
        """Exactly these translucent arms, or only while one is pointed at. wanted: name -> theta."""
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
                self.scene.robot(self.robot, theta, name=name, style="ghost").goal = self.target.path
            pointing.mean(self.scene[f"/ck/{name}"], name, hidden=not shown)

    def steps(self):
        """Newton's configurations (N, n), the guess first."""
        return np.array([step.theta for step in self.found.history])

    def words(self, values):
        closed = self.solver.closed
        none = "no solution" if closed else "no restart found a solution"
        yield f"target: {text.pose(self.T)}"
        yield f"{self.ways.count if self.reached else f'out of reach: {none}'}; {self.which()}"
        if not closed:
            yield f"no closed form for this arm: {self.solver.why_not}"
        yield f"Newton from the guess: {self.verdict()}"

    def say(self, theta):
        return text.joints(self.robot.joint_types, theta)

    def which(self):
        """What the solid arm shows."""
        if self.asking:
            return "the arm waits at home"
        if self.frame is None:
            name = f"shown: {self.ways.names[self.chosen]}," if self.reached else "the arm stays at"
            return f"{name} {self.say(self.shown)}"
        step = self.found.history[self.frame]
        angle, distance = text.degrees(step.error[0]), text.millimetres(step.error[1])
        at = f"{self.frame} of {self.found.iterations}, {self.say(step.theta)}"
        return f"shown: Newton's step {at}, {angle} and {distance} away"

    def verdict(self):
        """What Newton's method came to, in words."""
        angle, distance = self.found.error
        if self.found.converged:
            return f"{self.found.iterations} steps to {self.reached_by_newton()}"
        left = f"{text.degrees(angle)} and {text.millimetres(distance)} away"
        return f"no solution in {STEPS} steps; the closest pose found is {left}"

    def reached_by_newton(self):
        """The name of the solution at which Newton's method ended."""
        nearest, apart = self.solver.nearest(self.ways, self.found.theta), self.solver.apart
        away = apart(self.ways.theta[nearest], self.found.theta) if nearest >= 0 else np.inf
        if self.solver.closed or np.abs(away).max() < 1e-3:
            return self.ways.names[nearest]
        return f"another solution, {self.say(apart(self.found.theta, 0))}"

    def table(self, values):
        """Header and rows: branch, joint values, whether the limits are kept, or why not."""
        if self.asking:
            return [], []
        per = shown_per_si(self.robot)
        units = ["deg" if turns else "mm" for turns in self.solver.turns]
        header = ["branch" if self.solver.closed else "solution"]
        header += [*(f"θ{i + 1} [{unit}]" for i, unit in enumerate(units)), "limits"]
        rows = []
        for k, name in enumerate(self.ways.names):
            reason = self.ways.reasons[k] or ("" if self.ways.exists[k] else "does not exist")
            values_shown = (text.number(t, 1) for t in per * self.ways.theta[k])
            rows.append([name, *values_shown, "inside" if self.ways.inside[k] else reason])
        return header, rows

    def figures(self, values):
        """Every solution as a small picture, in the order of the table."""
        ways = self.ways
        if self.asking:
            return []
        lines = silhouettes(self.robot, ways.theta, self.T[:3, 3])
        notes = np.where(ways.inside, "", np.where(ways.exists, "outside", "none"))
        return [
            {"lines": lines[k], "name": name, "note": str(notes[k]), "word": f"branch{k}"}
            for k, name in enumerate(ways.names)
        ]

    def plot(self, figure, values):
        """Angle and distance before each step of Newton's method, on a log axis."""
        ax = figure.subplots()
        error = np.array([step.error for step in self.found.history])
        for left, name, style in zip(error.T, ("angle [rad]", "distance [m]"), ("o-", "s--"), strict=True):
            ax.semilogy(np.maximum(left, 1e-17), style, ms=4, label=name)
        ax.set(xlabel="step", ylabel="angle, distance left", ylim=(1e-17, 10))
        decades(ax, (-15, -10, -5, 0))
        ax.set_title(self.verdict().split(";")[0], x=1, ha="right", fontsize=10)  # also of a narrow figure
        ax.legend(frameon=False)

    def run(self, values):
        """Newton's steps and where they end: what the plot shows."""
        return self.steps().tobytes(), self.T.tobytes(), self.verdict()

    def here(self, values):
        """The step that is shown."""
        return [] if self.frame is None else [self.frame, np.nan]

    def click(self, x, _y):
        """Show the step at x."""
        if self.frame is None:
            self.play(autoplay=False)
        self.panel.rest_at(round(x))


def _configuration(robot, closed):
    """Where the explorer opens."""
    if closed:
        return np.resize(CONFIGURATION, robot.n)
    away = np.resize(FROM_HOME, robot.n) * np.where(hinges(robot), 1, 0.2)
    return np.clip(robot.home + away, robot.q_min, robot.q_max)

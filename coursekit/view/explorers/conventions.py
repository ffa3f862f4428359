"""Notebook 01: one arm by three conventions, and their frames side by side."""

from itertools import accumulate

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import lie, robots
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.controls import Toggle, joint_sliders
from coursekit.view.explorers import Explorer
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.sketch import ZERO, Trouble


def explore(
    robot: Robot | None = None, height: int = 470, theta: ArrayLike | None = None, mine: Given = None
) -> Panel:
    """Open the explorer of standard DH, modified DH and the product of exponentials.

    Sliders move the arm; switches show the frames that standard DH and modified DH attach to its links, the
    screw axes of the product of exponentials, and the skeleton in place of the paint. The text gives the tool
    pose by all three and the largest difference between any two of their matrix entries.

    Parameters
    ----------
    robot : Robot, optional
        One arm. Without it the explorer offers every arm of the catalogue that has a DH table.
    theta : (n,), optional
        Where the arm stands at first, radians and metres.
    mine : function, list or dict of functions, optional
        What you wrote, beside the right arm: fk_poe, fk_dh, dh_transform, mdh_transform, screw_exp,
        screws_from_dh (see `coursekit.view.mine`). ValueError for any other name.

    >>> from coursekit import robots, view
    >>> def fk_poe(S, M, theta):
    ...     return M
    >>> panel = view.explore(robots.planar_2r(), theta=[0, 1], mine=fk_poe)
    >>> print(panel.line.value.splitlines()[-1])
    yours, fk_poe: all frames before the tool are right; the tool is off by 239.7 mm and 57.3 deg
    >>> panel.close()
    """
    arms = [robot] if robot else [arm for arm in robots.all().values() if _tables(arm)]
    return _Conventions(arms, mine).open(height, theta)


class _Conventions(Explorer):
    name, title, opener = "conventions", "Explorer of DH and PoE", "explore"

    def __init__(self, arms, mine):
        super().__init__(mine, *arms)
        self.joints = joint_sliders(max(arms, key=lambda arm: arm.n))
        self.show(self.robot)

    def controls(self):
        frames = [Toggle(name, f"{name} DH frames") for name in ("standard", "modified")]
        return [self.joints, *frames, Toggle("screws", "screw axes"), Toggle("skeleton")]

    def show(self, robot):
        """The arm with its tool frame and both sets of DH frames, each fixed to a link."""
        self.robot, scene = robot, self.scene
        self.arm = scene.robot(robot)
        scene.make_room(robot.M[:3, 3], 0.12 * scene.size)  # where the tool is at zero, to which M points
        scene.frame(self.arm.link(robot.n) + "/tool", robot.M, letter="tool")
        pointing.axes(scene, self.arm)
        pointing.mean(scene.frame("/ck/zero", robot.M, letter="M"), "M")
        self.frames = {}
        for name, table in _tables(robot).items():
            poses = [table.base, *table.frames(np.zeros(robot.n))]
            self.frames[name] = [
                scene.frame(f"{self.arm.link(k)}/{name}", T, letter=f"{name[0]}{k}", size=0.1 * scene.size)
                for k, T in enumerate(poses)
            ]
            for k, frame in enumerate(self.frames[name]):  # between two rows
                pointing.mean(frame, f"{name}{k}", f"{name}{k + 1}")
            pointing.rows(scene, self.arm, name, table, poses)
        self.far = list(_far_frames(robot, scene.size))
        self.joints.fit(robot)

    def update(self, values):
        self.arm.theta = self.joints.get()
        self.arm.look(solid=not values["skeleton"], skeleton=values["skeleton"])
        self.arm.show_axes(values["screws"])
        for name, frames in self.frames.items():
            for frame in frames:
                frame.show(values[name])

    def words(self, values):
        """The tool pose by every convention the robot has, and how far they are apart."""
        theta = values["theta"]
        poses = {"product of exponentials": self.robot.fk(theta)}
        poses |= {f"{name} DH": table.fk(theta) for name, table in _tables(self.robot).items()}
        lines = []
        for name, T in poses.items():
            x, y, z = np.round(1000 * T[:3, 3], 3) + 0.0
            lines.append(f"{name:<24} x = {x:9.3f}  y = {y:9.3f}  z = {z:9.3f} mm")
        if len(poses) == 1:
            return [*lines, "this arm is given by its screws alone; there is no DH table to compare with"]
        matrices = np.array(list(poses.values()))
        apart = float(np.max(matrices.max(axis=0) - matrices.min(axis=0)))
        agree = f"largest difference between any two matrix entries: {apart:.1e}"
        return [*lines, agree, *self.far]

    def formula(self, values):
        """The product of exponentials, and each table as a product of its rows."""
        theta = values["theta"]
        turns = [
            (
                pointing.numbered("e^[S", k) + "]" + pointing.numbered("θ", k),
                f"theta{k}",
                f"joint {k}: S{k} = {text.row(S)} at zero, theta{k} = {self.shown(k, theta)}",
            )
            for k, S in enumerate(self.robot.S.T, 1)
        ]
        lines = [["T = ", *turns, ("M", "M", f"the tool at zero: {text.pose(self.robot.M)}")]]
        for name, table in _tables(self.robot).items():
            rows = (pointing.row_says(table, k, q, name) for k, q in enumerate(theta, 1))
            lines.append([f"{name} DH:  T = ", *pointing.series("A", rows, name)])
        return lines

    def shown(self, k, theta):
        """Joint value k with its unit."""
        turns = self.robot.joint_types[k - 1] == "revolute"
        return (text.degrees if turns else text.millimetres)(theta[k - 1])

    # -- where will the tool be?

    def begin(self, number):
        self.joints.show(questions.a_pose(self.robot, self.robot.home, number))

    def question(self, values):
        robot, theta, number = self.robot, values["theta"], self.number
        if not np.array_equal(theta, questions.a_pose(robot, robot.home, number)):
            return questions.MOVED
        move = questions.a_move(robot, theta, number)
        if move is None:
            return questions.NONE
        j, by = move
        end = theta + by * np.eye(robot.n)[j]
        goes = f"theta{j + 1} goes from {self.shown(j + 1, theta)} to {self.shown(j + 1, end)}"
        asked = f"{goes}. Where will the tool be? Drag the point there."
        return questions.where_after(robot, theta, j, by, asked, show=lambda _right: self._drive_to(end))

    # -- the arm by the student's functions

    def _fk_poe(self, sketch, values):
        """Link k moves by the first k screws from where its frame stands at zero."""
        theta, S, frames = values["theta"], self.robot.S, self.robot.link_frames(np.zeros(self.robot.n))
        mine = [self.mine.ask("fk_poe", S[:, :k], M, theta[:k]) for k, M in enumerate(frames, 1)]
        return self._beside(sketch, theta, np.array(mine))

    def _screw_exp(self, sketch, values):
        pairs = zip(self.robot.S.T, values["theta"], strict=True)
        return self._carried(sketch, values, [self.mine.ask("screw_exp", S, float(q)) for S, q in pairs])

    def _screws_from_dh(self, sketch, values):
        table = self._table("modified", turning=True)
        S = self.mine.ask("screws_from_dh", _rows(table), table.base)
        if S.shape != self.robot.S.shape:
            raise Trouble(f"it returns {S.shape[1]} screws for {self.robot.n} rows")
        off = np.flatnonzero(np.abs(S - self.robot.S).max(axis=0) > ZERO) + 1
        note = f"; your screws that are off: {', '.join(map(str, off))}" if off.size else ""
        return self._carried(sketch, values, lie.exp6(S.T * values["theta"][:, None])) + note

    def _dh_transform(self, sketch, values):
        return self._rows_of(sketch, values, "dh_transform", "standard")

    def _mdh_transform(self, sketch, values):
        return self._rows_of(sketch, values, "mdh_transform", "modified")

    def _fk_dh(self, sketch, values):
        table, theta = self._table("standard", turning=True), values["theta"]
        rows, one = _rows(table), np.eye(4)
        mine = [self.mine.ask("fk_dh", rows[:k], theta[:k], table.base, one) for k in range(1, len(theta))]
        mine += [self.mine.ask("fk_dh", rows, theta, table.base, table.tool)]
        return self._beside(sketch, theta, np.array(mine), table)

    def _rows_of(self, sketch, values, name, convention):
        """The arm by the student's transform of each row of its table."""
        table = self._table(convention)
        rows = _rows(table, values["theta"])
        frames = _product(table.base, [self.mine.ask(name, *map(float, row)) for row in rows])
        frames[-1] = frames[-1] @ table.tool
        return self._beside(sketch, values["theta"], frames, table)

    def _carried(self, sketch, values, turns):
        """The arm by the student's motion of each joint, (n, 4, 4), which carries all that comes after it."""
        frames = _product(np.eye(4), turns) @ self.robot.link_frames(np.zeros(self.robot.n))
        return self._beside(sketch, values["theta"], frames)

    def _beside(self, sketch, theta, mine, table=None):
        """The student's frames (n, 4, 4), the tool's last, beside those of the table, or else of the arm."""
        both = np.array([theta, np.zeros(len(theta))])
        right = table.frames(both) if table else self.robot.link_frames(both)
        if table:
            right[:, -1] = right[:, -1] @ table.tool
        return sketch.poses(self.robot, mine, *right)

    def _table(self, convention, turning=False):
        """The robot's table of this convention; Trouble where it has none, or `turning` joints slide."""
        table = _tables(self.robot).get(convention)
        if table is None:
            raise Trouble(f"{self.robot.name} has no {convention} DH table to try it on")
        if turning and "prismatic" in table.joint_types:
            raise Trouble(f"it is for joints that turn, and one of {self.robot.name} slides")
        return table


def _rows(table, q=0):
    """(n, 4): a, alpha, d, theta at q (n,), or of the table alone."""
    turns = np.array(table.joint_types) == "revolute"
    return np.column_stack([table.a, table.alpha, table.d + q * ~turns, table.theta + q * turns])


def _product(first, factors):
    """first A_1, first A_1 A_2, ...: (n, 4, 4)."""
    return np.array(list(accumulate(factors, np.matmul, initial=first))[1:])


def _far_frames(robot, size):
    """Sentences about DH frames far outside the picture: where axes are parallel but for rounding."""
    for name, table in _tables(robot).items():
        places = table.frames(np.zeros(robot.n))[:, :3, 3]
        away = np.linalg.norm(places, axis=1)
        k = int(away.argmax())
        if away[k] > 100 * size:
            yield (
                f"{name} DH: frame {k + 1} stands {away[k] / 1000:.3g} km away, where nearly parallel axes "
                "have their common normal (`dh.steps`)"
            )


def _tables(robot):
    """Name -> DH table, of those the robot has."""
    tables = {"standard": robot.standard_dh, "modified": robot.modified_dh}
    return {name: table for name, table in tables.items() if table is not None}

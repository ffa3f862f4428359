"""Notebook 04: det J and its factors live, what is lost, and a map of the singularities over two joints."""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import robots, singularity
from coursekit.kinematics.robot import Robot
from coursekit.view import text
from coursekit.view.controls import Action, Choice, Toggle, joint_sliders
from coursekit.view.explorers import Explorer, yours
from coursekit.view.figures import nb04
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot
from coursekit.view.sketch import ROOT

UNITS = {"wrist": "", "elbow": " m^2", "shoulder": " m"}
JOINTS = {f"θ{k + 1}": k for k in range(1, 5)}  # det J depends on no other joint
CAPTION = (
    "Dark: det J is small. White lines: a factor is 0 (elbow dashed, shoulder solid, wrist dotted). "
    "The cross is the arm; click to move it."
)
NEAR = 0.05  # relative factor below which a singularity is called near: about 3 degrees


def explore_singularities(
    robot: Robot | None = None,
    height: int = 470,
    theta: ArrayLike | None = None,
    mine: Callable | list | dict | None = None,
) -> Panel:
    """Open the explorer of singularities.

    Sliders move the arm. The text gives det J, its three factors, the smallest singular value, the rank and
    the name of the singularity. Arrows at the wrist show what is lost: the force and the moment that no joint
    can feel (at a regular pose, those which the joints feel least). Where that is a pure force, its line is
    drawn: it meets all six axes. The map shows det J over two joints; a click on it sets them. Buttons drive
    the arm to the nearest singularity of each kind, by one joint.

    Parameters
    ----------
    robot : Robot, optional
        An arm whose det J has the three factors (`singularity.factors`); ValueError for any other. Without it
        the explorer offers every such arm of the catalogue.
    theta : (n,), optional
        Where the arm stands at first, radians and metres.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: elbow_angle, shoulder_theta3 (with buttons that drive there),
        lost_motion, rank, det_from_blocks (see `coursekit.view.mine`). ValueError for any other name.
    """
    arms = [arm for arm in robots.all().values() if _has_factors(arm)] if robot is None else [robot]
    singularity.factors(arms[0], arms[0].home)  # refuses an arm without the three factors
    return _Singularities(arms, mine).open(height, theta)


class _Singularities(yours.Singularities, Explorer):
    name, title, opener = "singularities", "Explorer of singularities", "explore_singularities"
    computed = ("/ck/lost", "/ck/meets_all")

    def __init__(self, arms, mine):
        super().__init__(arms[0], mine)
        self.arms = {arm.name: arm for arm in arms}
        self.joints = joint_sliders(self.robot, _start(self.robot))
        self.upwards = Choice("up", JOINTS, "θ3", "map, upwards")
        self.show(self.robot)

    def controls(self):
        return [
            *([Choice("robot", self.arms)] if len(self.arms) > 1 else []),
            self.joints,
            Choice("across", JOINTS, "θ2", "map, across"),
            self.upwards,
            Toggle("lost", "lost motion", start=True),
            Toggle("line", "line that meets all axes", start=True),
            Toggle("axes", "joint axes", start=True),
            *(
                Action(f"to_{kind}", f"to the {kind}", partial(self.drive_to, kind))
                for kind in singularity.NAMES
            ),
        ]

    def below(self):
        return [Plot(self.plot, CAPTION, on_click=self.click)]

    def show(self, robot):
        """The arm, and each joint axis as a long line that moves with its link."""
        self.robot, scene = robot, self.scene
        scene.remove("/ck/robot")
        scene.remove(ROOT)
        # the camera leaves room for the stretched arm
        self.arm = scene.robot(robot, nearest(robot, _start(robot), "elbow"))
        origins = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
        self.lines = []
        for k, (S, near) in enumerate(zip(robot.S.T, origins, strict=True), 1):
            w = S[:3]
            ends = np.cross(w, S[3:]) + w * (w @ near) + np.outer([-0.6, 0.6], w) * scene.size
            wire = np.linspace(*ends, 33)
            self.lines.append(scene.curve(self.arm.link(k) + "/line", wire, "axis", 0.002 * scene.size))
        for k, slider in enumerate(self.joints.used):
            slider.fit_joint(robot, k, _start(robot)[k])

    def update(self, values):
        if values.get("robot", self.robot) is not self.robot:
            self.show(values["robot"])
        if values["across"] == values["up"]:  # two different joints
            self.upwards.put("θ3" if values["across"] != JOINTS["θ3"] else "θ2")
        self.arm.theta = self.joints.get()
        for line in self.lines:
            line.show(values["axes"])
        _show_loss(self.scene, self.robot, self.arm.theta, values["lost"], values["line"])

    def words(self, values):
        return words(self.robot, values["theta"])

    def plot(self, figure, values):
        ax, i, j = figure.subplots(), values["across"], values["up"]
        nb04.draw_map(ax, self.robot, values["theta"], i, j)
        ax.plot(*np.degrees(values["theta"][[i, j]]), "X", color="#F07A2B", mec="w", ms=11)

    def click(self, x, y):
        values = self.panel.values
        theta = values["theta"]
        theta[[values["across"], values["up"]]] = np.radians([x, y])
        self.panel.set(theta=np.clip(theta, *_ends(self.robot)))

    def drive_to(self, kind):
        start = self.panel.values["theta"]
        end = nearest(self.robot, start, kind)
        if end is not None:
            self.panel.play(np.linspace(start, end, 31))


def nearest(robot: Robot, theta: ArrayLike, name: str) -> np.ndarray | None:
    """The configuration nearest to theta, by one joint and inside the limits, where a factor is 0; or None.

    A factor is A + B cos + C sin of any one joint angle, so its values at three angles tell its zeros.

    >>> kr6 = robots.kuka_kr6()
    >>> float(nearest(kr6, [0, -0.7, 0.9, 0.5, 0.8, 0.2], "elbow")[2].round(6))
    0.083141
    """
    theta = np.asarray(theta, float)
    low, high = _ends(robot)
    found = []
    for joint in range(1, 5):
        turned = np.array([theta] * 3)
        turned[:, joint] = 0, np.pi / 2, np.pi
        at_0, at_90, at_180 = singularity.factors(robot, turned)[name]
        A, B = (at_0 + at_180) / 2, (at_0 - at_180) / 2
        size = np.hypot(B, at_90 - A)
        if size < 1e-9 or abs(A) > size:
            continue
        middle, half = np.arctan2(at_90 - A, B), np.arccos(-A / size)
        roots = middle + np.outer([half, -half], np.ones(5)) + 2 * np.pi * np.arange(-2, 3)
        inside = roots[(roots >= low[joint]) & (roots <= high[joint])]
        found += [np.where(np.arange(robot.n) == joint, root, theta) for root in inside]
    return min(found, key=lambda end: np.abs(end - theta).max(), default=None)


def words(robot: Robot, theta: ArrayLike) -> str:
    """The numbers of the picture: determinant, factors, smallest singular value, rank, name, what is lost."""
    split = singularity.factors(robot, theta)
    parts = [f"{name} {text.number(split[name], 5)}{unit}" for name, unit in UNITS.items()]
    names, rank = singularity.classify(robot, theta), singularity.rank(robot, theta)
    verdict = " and ".join(names) + " singularity" if names else "regular"
    if singularity.aligned(robot, theta):
        verdict += ", axes 1 and 6 are one line"
    relative = singularity.relative_factors(robot, theta)
    near = [name for name in relative if abs(relative[name]) < NEAR and name not in names]
    verdict += f"; near: {', '.join(near)}" if near else ""
    sigma = text.number(singularity.sigma_min(robot, theta), 5)
    moment, force, pitch = _loss(robot, theta)
    what = "lost" if rank < 6 else "weakest"
    loss = f"{what}: force {text.row(force, 2)}, moment {text.row(moment, 2)} at the wrist"
    if rank == 5:
        loss += ", a line that meets all six axes" if abs(pitch) < 1e-6 else f", pitch {abs(pitch):.3f} m"
    elif rank < 5:
        loss += f": one of {6 - rank} motions that are lost"
    tool = f"tool at {text.millimetres(robot.fk(theta)[:3, 3])}"
    det = f"det J = {text.number(singularity.determinant(robot, theta), 6)} m^3 = {' x '.join(parts)}"
    return "\n".join([tool, det, f"smallest singular value {sigma}, rank {rank}: {verdict}", loss])


def _has_factors(robot):
    try:
        singularity.factors(robot, robot.home)
    except ValueError:
        return False
    return True


def _ends(robot):
    """Limits of the joints (n,), (n,); half a turn where there is none."""
    return tuple(np.nan_to_num(q, posinf=np.pi, neginf=-np.pi) for q in (robot.q_min, robot.q_max))


def _start(robot):
    """A regular configuration near home, (6,)."""
    return np.clip(robot.home + np.radians([0, 10, 20, 25, 45, 0]), *_ends(robot))


def _wrist(robot, theta):
    """The origin of frame 5, (3,): where the axes of a spherical wrist meet."""
    return robot.link_frames(theta)[4, :3, 3]


def _loss(robot, theta):
    """The lost wrench: moment about the wrist and force, together of length 1, and its pitch."""
    lost = singularity.lost_motion(robot, theta)
    moment = lost[:3] - np.cross(_wrist(robot, theta), lost[3:])
    size = np.sqrt(moment @ moment + lost[3:] @ lost[3:])
    return moment / size, lost[3:] / size, float(singularity.lost_wrench(robot, theta).pitch)


def _show_loss(scene, robot, theta, lost, line):
    """Arrows of what is lost, at the wrist, and the line that meets all axes where there is one."""
    wrist, (moment, force, pitch) = _wrist(robot, theta), _loss(robot, theta)
    what = "lost" if singularity.rank(robot, theta) < 6 else "weakest"
    for name, vector, color in (("force", force, "ghost"), ("moment", moment, "trace")):
        long = 0.35 * scene.size * vector if lost and np.linalg.norm(vector) > 1e-6 else np.zeros(3)
        scene.arrow(f"/ck/lost/{name}", wrist, long, color, f"{what}: {name}")
    wrench = singularity.lost_wrench(robot, theta)
    there = line and what == "lost" and abs(pitch) < 1e-6
    middle = wrench.point + wrench.direction * (wrench.direction @ (wrist - wrench.point)) if there else wrist
    ends = middle + np.outer([-1.1, 0.5], wrench.direction if there else np.zeros(3)) * scene.size
    scene.line("/ck/meets_all", *ends, "ghost", "meets all six axes", 0.004 * scene.size)

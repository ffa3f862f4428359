"""Notebook 04: det J and its factors live, what is lost, and a map of the singularities over two joints."""

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import axes, robots, singularity
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.chain import ends_of, hinges, shown_per_si
from coursekit.view.controls import Action, Choice, Toggle, joint_sliders
from coursekit.view.explorers import Explorer, yours
from coursekit.view.explorers.singular import nearest, singular_poses, start_of, weakest
from coursekit.view.figures import nb04
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.plots import Plot

UNITS = {"wrist": "", "elbow": " m^2", "shoulder": " m"}
ZERO_WHERE = {
    "wrist": "0 where axes 4 and 6 are one line",
    "elbow": "0 where the wrist's centre lies in the plane of axes 2 and 3",
    "shoulder": "0 where the wrist's centre lies on axis 1",
}
# the factor that is 0 where something lies at the axis of this joint
FACTOR_AT = {1: "shoulder", 2: "elbow", 3: "elbow", 4: "wrist", 5: "", 6: "wrist"}
JOINTS = {f"θ{k + 1}": k for k in range(1, 5)}  # det J depends on no other joint
CAPTION = (
    "Dark: det J is small. White lines: a factor is 0 (elbow dashed, shoulder solid, wrist dotted). "
    "The ring is the arm; click, or drag it."
)
CAPTION_OF_SIGMA = (
    "Dark: the smallest singular value is small, relative to the largest on this map. "
    "The ring is the arm; click, or drag it."
)
NEAR = 0.05  # relative factor below which a singularity is called near: about 3 degrees
LOST = 1e-9  # singular values below are 0


def explore_singularities(
    robot: Robot | None = None, height: int = 470, theta: ArrayLike | None = None, mine: Given = None
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
        Any arm. Where det J has not the three factors (`singularity.factors`), the text says why, arrows and
        numbers are at the tool, the map shows the smallest singular value, and one button drives to where one
        joint makes that smallest. Without it: every arm of the catalogue that has the factors.
    theta : (n,), optional
        Where the arm stands at first, radians and metres.
    mine : function, list or dict of functions, optional
        What you wrote, beside what is right: elbow_angle, shoulder_theta3 (with buttons that drive there),
        lost_motion, rank, det_from_blocks (see `coursekit.view.mine`). ValueError for any other name.
    """
    arms = [arm for arm in robots.all().values() if nb04.has_factors(arm)] if robot is None else [robot]
    return _Singularities(arms, mine).open(height, theta)


class _Singularities(yours.Singularities, Explorer):
    name, title, opener = "singularities", "Explorer of singularities", "explore_singularities"
    computed, around = ("/ck/lost", "/ck/meets_all"), 0.28  # the arrow of a loss, and its name

    def __init__(self, arms, mine):
        super().__init__(mine, *arms)
        self.split = nb04.has_factors(self.robot)  # all of them or, where it is one, this one
        self.joints = joint_sliders(self.robot, start_of(self.robot))
        n = self.robot.n
        some = {f"θ{k + 1}": k for k in range(1 if n > 2 else 0, n)}  # sigma does not depend on joint 1
        self.offered = JOINTS if self.split else some
        names = list(self.offered)
        self.across = Choice("across", self.offered, names[0], "map, across")
        self.upwards = Choice("up", self.offered, names[min(1, n - 1)], "map, up")
        self.show(self.robot)

    def controls(self):
        if self.split:
            kinds = {kind: f"to the {kind}" for kind in singularity.NAMES}
        else:
            kinds = {"weakest": "to the weakest pose by one joint"}
        return [
            self.joints,
            *([self.across, self.upwards] if len(self.offered) > 1 else []),
            Toggle("lost", "lost motion", start=True),
            *([Toggle("line", "line that meets all axes", start=True)] if self.robot.n >= 6 else []),
            Toggle("axes", "joint axes", start=True),
            *(Action(f"to_{kind}", label, partial(self.drive_to, kind)) for kind, label in kinds.items()),
        ]

    def below(self):
        if len(self.offered) < 2:
            return []
        hands = {"on_click": self.click, "on_step": self.step}
        caption = CAPTION if self.split else CAPTION_OF_SIGMA
        return [Plot(self.plot, caption, **hands, cursor=self.here, key=self.map_of)]

    def show(self, robot):
        """The arm, and each joint axis as a long line that moves with its link."""
        self.robot, scene = robot, self.scene
        # the camera leaves room for the stretched arm
        end = nearest(robot, start_of(robot), "elbow") if self.split else None
        self.arm = scene.robot(robot, start_of(robot) if end is None else end)
        origins = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
        places = np.where(hinges(robot)[:, None], axes.points_on(robot.S), origins)
        self.lines = []
        for k, (q, w) in enumerate(zip(places, axes.directions_of(robot.S), strict=True)):
            ends = axes.foot(origins[k], q, w) + np.outer([-0.6, 0.6], w) * scene.size
            wire = np.linspace(*ends, 33)
            path = self.arm.link(k + 1) + "/line"
            self.lines.append(scene.curve(path, wire, "axis", 0.002 * scene.size))
            upper = ends[0 if ends[0, 2] > ends[1, 2] + 1e-9 else 1]  # the other may be under the floor
            scene.point(f"{path}/number", upper, str(k + 1), "axis", 0.004 * scene.size)
        pointing.axes(scene, self.arm, FACTOR_AT.__getitem__ if self.split else "J{}".format)
        if self.split:  # the wrist's centre, for elbow and shoulder
            wrist = scene.point(
                self.arm.link(4) + "/wrist", origins[4], "wrist", pointing.COLOR, 0.02 * scene.size
            )
            pointing.mean(wrist, "elbow", "shoulder", "wrist")
        for k, slider in enumerate(self.joints.used):
            slider.fit_joint(robot, k, start_of(robot)[k])

    def update(self, values):
        names = list(self.offered)
        if len(names) > 1 and values["across"] == values["up"]:  # two different joints
            second = names[1] if values["across"] != self.offered[names[1]] else names[0]
            self.upwards.put(second)
        self.arm.theta = self.joints.get()
        for line in self.lines:
            line.show(values["axes"])
        _show_loss(self.scene, self.robot, self.arm.theta, values["lost"], values.get("line", False))

    def formula(self, values):
        """det J and its factors; of other arms, the columns."""
        if not self.split:
            columns = (f"column {k}: the axis of joint {k}" for k in range(1, self.robot.n + 1))
            return [["J(θ) = ( ", *pointing.series("J", columns), " )"]]
        split = singularity.factors(self.robot, values["theta"])
        factors = [
            (name, name, f"{name} {text.number(split[name], 5)}{unit}: {ZERO_WHERE[name]}")
            for name, unit in UNITS.items()
        ]
        return [["det J = ", factors[0], " · ", factors[1], " · ", factors[2]]]

    def words(self, values):
        lines = words(self.robot, values["theta"]).splitlines()
        return [line for line in lines if not (self.asking and line.startswith("lost: "))]

    # -- which motion is lost?

    def begin(self, number):
        """At a singular pose, where no question was asked before; another one for each question."""
        theta = self.joints.get()
        if number or not _one_is_lost(self.robot, theta):
            fit = (
                end for end in singular_poses(self.robot, self.split, number) if _one_is_lost(self.robot, end)
            )
            self.joints.show(next(fit, theta))

    def question(self, values):
        robot, theta = self.robot, values["theta"]
        if robot.n < 6:
            return (
                "Predict: an arm with fewer than six joints loses motions everywhere; nothing is asked here."
            )
        if not _one_is_lost(robot, theta):
            return "Predict: here not just one motion is lost. Go to a singular pose, or: next question."
        moment, force, _ = _loss(robot, theta)
        at, J = _reference(robot, theta), robot.jacobian_space(theta)
        free = np.flatnonzero(np.abs(J[:3].T @ moment) < 1e-6)  # joints whose part of the motion is not lost
        point = "wrist" if self.split else "tool point"
        if np.linalg.norm(moment) > 0.3:
            asked = f"while the {point} stands still, there is one axis about which the hand cannot turn"
            right, others = moment, {f"about axis {k + 1} it does turn": J[:3, k] for k in free}
        else:
            turn = "" if np.linalg.norm(moment) < 1e-6 else ", as long as the hand does not turn"
            asked = f"there is one direction in which the {point} cannot move{turn}"
            v = J[3:] + np.cross(J[:3].T, at).T
            right, others = force, {f"that way joint {k + 1} does move it": v[:, k] for k in free}
        asked += ". Point along it: drag the tip of the arrow; either way round is right."
        return questions.which_way(at, right, others, asked, (robot.name, *theta), self.scene.size, False)

    def secret(self):
        _show_loss(self.scene, self.robot, self.arm.theta, False, False)

    def plot(self, figure, values):
        nb04.draw_map(figure.subplots(), self.robot, values["theta"], values["across"], values["up"])

    def map_of(self, values):
        """The arm, the two joints of the map, and where the others are held."""
        chosen, held = (values["across"], values["up"]), values["theta"].copy()
        held[[*chosen]] = 0
        return self.robot.name, chosen, *held.round(9)

    def here(self, values):
        """The arm as a point of the map."""
        return (values["theta"] * shown_per_si(self.robot))[[values["across"], values["up"]]]

    def step(self, dx, dy):
        """By arrow keys: five degrees, or fifty millimetres."""
        values = self.panel.values
        chosen = [values["across"], values["up"]]
        per = shown_per_si(self.robot)[chosen]
        self.click(*(per * values["theta"][chosen] + np.where(per > 100, 50, 5) * [dx, dy]))

    def click(self, x, y):
        values = self.panel.values
        theta, chosen = values["theta"], [values["across"], values["up"]]
        theta[chosen] = np.array([x, y]) / shown_per_si(self.robot)[chosen]
        self.panel.set(theta=np.clip(theta, *ends_of(self.robot)))

    def drive_to(self, kind):
        robot, start = self.robot, self.panel.values["theta"]
        end = weakest(robot, start) if kind == "weakest" else nearest(robot, start, kind)
        if end is not None:
            self._drive_to(end)


def words(robot: Robot, theta: ArrayLike) -> str:
    """The numbers of the picture: determinant, factors, smallest singular value, rank, name, what is lost."""
    theta, rank, most = np.asarray(theta, float), int(singularity.rank(robot, theta, LOST)), min(robot.n, 6)
    split = nb04.has_factors(robot)
    first, verdict = _of_the_factors(robot, theta) if split else _without_factors(robot, rank, theta)
    if robot.n > 1 and singularity.aligned(robot, theta):
        verdict += f", axes 1 and {robot.n} are one line"
    sigma = text.number(singularity.sigma_min(robot, theta), 5)
    moment, force, pitch = _loss(robot, theta)
    what = "lost" if rank < most else "weakest"
    place = "wrist" if split else "tool"
    loss = f"{what}: force {text.row(force, 2)}, moment {text.row(moment, 2)} at the {place}"
    if robot.n >= 6 and rank == 5:
        every = "all six axes" if robot.n == 6 else f"all {robot.n} axes"
        loss += f", a line that meets {every}" if abs(pitch) < 1e-6 else f", pitch {abs(pitch):.3f} m"
    elif rank < most - 1:
        loss += f": one of {most - rank} motions that are lost"
    lines = [f"tool at {text.millimetres(robot.fk(theta)[:3, 3])}", *first]
    lines += [f"smallest singular value {sigma}, rank {rank}: {verdict}", loss]
    return "\n".join([*lines, *_of_few_joints(robot, theta)])


def _of_the_factors(robot, theta):
    """det J as a product, and the names of what is 0 or nearly so."""
    split = singularity.factors(robot, theta)
    parts = [f"{name} {text.number(split[name], 5)}{unit}" for name, unit in UNITS.items()]
    det = f"det J = {text.number(singularity.determinant(robot, theta), 6)} m^3 = {' x '.join(parts)}"
    names, relative = singularity.classify(robot, theta), singularity.relative_factors(robot, theta)
    verdict = " and ".join(names) + " singularity" if names else "regular"
    near = [name for name in relative if abs(relative[name]) < NEAR and name not in names]
    return [det], verdict + (f"; near: {', '.join(near)}" if near else "")


def _without_factors(robot, rank, theta):
    """What can be said where det J does not split, or where there is no square J."""
    verdict = "regular" if rank == min(robot.n, 6) else "singular"
    if robot.n != 6:
        return [f"J is 6 x {robot.n}: it has no determinant, its singular values tell"], verdict
    try:
        singularity.factors(robot, theta)
    except ValueError as error:
        reason = str(error).rsplit(": ", 1)[-1]
    det = text.number(singularity.determinant(robot, theta), 6)
    return [f"det J = {det}, not a product of wrist, elbow and shoulder: {reason}"], verdict


def _of_few_joints(robot, theta):
    """What an arm with fewer than six joints lacks everywhere, and how its tool point alone can move."""
    if robot.n >= 6:
        return []
    some = np.random.default_rng(1).uniform(*ends_of(robot), (5, robot.n))
    best = np.linalg.matrix_rank(robot.jacobian_geometric(some)[:, 3:], tol=LOST).max()
    sigma = np.linalg.svd(robot.jacobian_geometric(theta)[3:], compute_uv=False)[:best]
    rank = int((sigma > LOST).sum())
    verdict = "regular" if rank == best else "singular"
    few = f"{robot.n} joints: {6 - robot.n} of 6 motions are lost everywhere"
    return [f"{few}; the tool point alone: sigma {text.row(sigma, 5)}, rank {rank} of {best}, {verdict}"]


def _one_is_lost(robot, theta):
    """Whether five motions are left, and all five clearly."""
    sigma = np.linalg.svd(robot.jacobian_geometric(theta), compute_uv=False)
    return len(sigma) == 6 and sigma[5] < 1e-6 and sigma[4] > 1e-3


def _reference(robot, theta):
    """Where the loss is told and drawn, (3,): where the axes of a wrist meet (frame 5), or the tool."""
    return robot.link_frames(theta)[4, :3, 3] if nb04.has_factors(robot) else robot.fk(theta)[:3, 3]


def _loss(robot, theta):
    """The lost (or weakest) wrench: moment about the reference and force, together of length 1; its pitch."""
    lost = singularity.weakest_motion(robot, theta)
    moment = lost[:3] - np.cross(_reference(robot, theta), lost[3:])
    size = np.sqrt(moment @ moment + lost[3:] @ lost[3:])
    return moment / size, lost[3:] / size, float(singularity.wrench_of(lost).pitch)


def _show_loss(scene, robot, theta, lost, line):
    """Arrows of what is lost, at the reference, and the line that meets all axes where there is one."""
    at, (moment, force, pitch) = _reference(robot, theta), _loss(robot, theta)
    what = "lost" if singularity.rank(robot, theta) < min(robot.n, 6) else "weakest"
    for name, vector, color in (("force", force, "ghost"), ("moment", moment, "trace")):
        long = 0.35 * scene.size * vector if lost and np.linalg.norm(vector) > 1e-6 else np.zeros(3)
        scene.arrow(f"/ck/lost/{name}", at, long, color, f"{what}: {name}")
    there = line and what == "lost" and abs(pitch) < 1e-6
    middle, along = at, np.zeros(3)
    if there:
        wrench = singularity.lost_wrench(robot, theta)
        middle, along = axes.foot(at, wrench.point, wrench.direction), wrench.direction
    ends = middle + np.outer([-1.1, 0.5], along) * scene.size
    label = f"meets all {'six' if robot.n == 6 else robot.n} axes"
    scene.line("/ck/meets_all", *ends, "ghost", label, 0.004 * scene.size)

"""Notebook 02: one joint after the other at the home pose, from the axis and a point on it to the screw."""

import numpy as np

from coursekit.kinematics import axes, lie, robots
from coursekit.kinematics.robot import Robot
from coursekit.view import pointing, questions, text
from coursekit.view.chain import ends_of, hinges
from coursekit.view.controls import Choice, Slider
from coursekit.view.explorers import Explorer
from coursekit.view.mine import Given
from coursekit.view.panel import Panel
from coursekit.view.sketch import ZERO, Trouble, apart, gap, size


def explore_screws(robot: Robot | None = None, height: int = 470, mine: Given = None) -> Panel:
    """Open the explorer of screws: a joint axis, a point q on it, v = -w x q, and the column of S or B.

    The arm stands at zero and only the chosen joint moves. The point q can be slid along its axis, and the
    screw can be looked at from the space frame, from the tool, or from where the last two axes meet. A joint
    that slides has no w and needs no q: its column is (0; v).

    Parameters
    ----------
    robot : Robot, optional
        Any arm; the KUKA KR6 where none is given.
    mine : function, list or dict of functions, optional
        What you wrote, on the arm: screw_axis, axis_of, body_screws, home_pose (of the ABB), and the screws
        that you read off a drawing, {"S": S} with S (6, n). Each axis gets a tick where it is right; the
        chosen joint turns the translucent rest of the arm about *your* axis.

    >>> import numpy as np
    >>> from coursekit import robots, view
    >>> def screw_axis(w, q):
    ...     return np.concatenate([w, np.cross(w, q)]) / np.linalg.norm(w)
    >>> panel = view.explore_screws(robots.kuka_kr6(), mine=screw_axis)
    >>> panel.line.value.splitlines()[-1][:76]
    'yours, screw_axis: off: joints 2, 3, 4, 5, 6. Joint 2: the axes are 801.6 mm'
    >>> panel.close()
    """
    return _Screws(robots.kuka_kr6() if robot is None else robot, mine).open(height)


class _Screws(Explorer):
    name, title, opener = "screws", "Explorer of screws", "explore_screws"
    in_space = False  # but as one of the frames that look on

    def __init__(self, robot, mine):
        super().__init__(mine, robot)
        self.frames = _frames(robot)
        self.turn = Slider("turn", 0.0, -np.pi, np.pi, unit="deg", label="turn joint")
        joints = {f"joint {i + 1}": i for i in range(robot.n)}
        self.joint = Choice("joint", joints, start="joint 2" if robot.n > 1 else "joint 1")
        self.unit = "deg"  # of that slider, which serves every joint in turn
        self.origins = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
        self.directions, self.points = axes.directions_of(robot.S), axes.points_on(robot.S)
        self.arm = self.scene.robot(robot, np.zeros(robot.n))
        self.arm.look(solid=True, skeleton=True)
        pointing.axes(self.scene, self.arm)
        self.pointed = None  # for which frame, joint and point the screws stand ready

    def controls(self):
        return [
            self.joint,
            Choice("frame", self.frames, label="seen from"),
            Slider("slide", 0.0, -0.3, 0.3, unit="mm", label="slide q"),
            self.turn,
        ]

    def drivers(self, values):
        return [self.turn if k == values["joint"] else None for k in range(self.robot.n)]

    def slides(self, i):
        return self.robot.joint_types[i] == "prismatic"

    def fit_slider(self, i):
        """The last slider turns a hinge, in degrees, and moves a slide, in millimetres."""
        unit = "mm" if self.slides(i) else "deg"
        if unit != self.unit:
            self.unit = unit
            ends = [end[i] for end in ends_of(self.robot)] if unit == "mm" else [-np.pi, np.pi]
            self.turn.label = "slide joint" if unit == "mm" else "turn joint"
            self.turn.fit(0.0, *ends, unit)

    def update(self, values):
        i, scene = values["joint"], self.scene
        self.fit_slider(i)
        if self.frame is not None:
            self.turn.show(self.panel.motion.theta[i])
        self.S = self.robot.S[:, i]
        w, v, along = self.S[:3], self.S[3:], self.directions[i]
        on_axis = self.origins[i] if self.slides(i) else self.points[i]
        self.q = axes.foot(self.origins[i], on_axis, along) + along * values["slide"]
        self.arm.theta = self.turn.get() * np.eye(self.robot.n)[i]
        letter, T = values["frame"]
        scene.screw_axis("/ck/axis", self.S, label=f"S{i + 1}", at=self.q)
        scene.point("/ck/q", self.q, "q", color="accent")
        scene.frame("/ck/seen", T, letter=letter, size=0.14 * scene.size)
        # a slide's v is a direction and owes nothing to a lever
        lever = T[:3, 3] if self.slides(i) else self.q
        scene.line("/ck/lever", T[:3, 3], lever)
        # half of it: the whole, of a tool a metre away, would leave the picture
        drawn = 0.3 * scene.size * v if self.slides(i) else (v + np.cross(w, T[:3, 3])) / 2
        scene.arrow("/ck/v", T[:3, 3], drawn, color="trace", label="v" if self.slides(i) else "v/2")
        self.turn.word = f"theta{i + 1}"
        if self.pointed != (letter, i, values["slide"]):
            self.pointed = (letter, i, values["slide"])
            self.point_at(T, i)

    def point_at(self, T, i):
        """Every screw with its line, lever and v, seen from T; those of joint i each by itself, too."""
        for k, S in enumerate(self.robot.S.T):
            q, slides = self.q if k == i else self.origins[k], self.slides(k)
            q = axes.foot(q, q if slides else self.points[k], self.directions[k])
            own, at, thick = f"S{k + 1}", T[:3, 3], 0.009 * self.scene.size
            v = 0.3 * self.scene.size * S[3:] if slides else (S[3:] + np.cross(S[:3], at)) / 2
            path, color = f"/ck/screws/{k + 1}", pointing.COLOR
            parts = {
                "w": self.scene.screw_axis(f"{path}/w", S, label=own, at=q, color=color, radius=thick),
                "q": self.scene.line(f"{path}/q", at, at if slides else q, color, f"q{k + 1}", 0.6 * thick),
                "v": self.scene.arrow(
                    f"{path}/v", at, v, color, f"v{k + 1}" if slides else f"v{k + 1}/2", thick
                ),
            }
            for name, drawing in parts.items():
                pointing.mean(drawing, own, *([name] if k == i else []))

    def formula(self, values):
        """All columns, and how the column of the chosen joint is made."""
        i, (letter, T) = values["joint"], values["frame"]
        name, change = "S" if letter == "s" else "B", lie.adjoint(lie.inverse(T))
        columns = (f"column {k} of {name} = {text.row(change @ S)}" for k, S in enumerate(self.robot.S.T, 1))
        seen, q = change @ self.S, (lie.inverse(T) @ [*self.q, 1])[:3]
        w = ("ω", "w", f"w = {text.row(seen[:3])}, the direction of axis {i + 1}")
        v = ("v", "v", f"v = {text.row(seen[3:])}: how the point of the arm at {{{letter}}} goes, per radian")
        point = ("q", "q", f"q = {text.millimetres(q)}, a point of the axis, any one; the line is its lever")
        column = pointing.numbered(name, i + 1)
        made = [f"{column} = (", w, "; ", v, "),   v = −ω × ", point]
        if self.slides(i):
            v = ("v", "v", f"v = {text.row(seen[3:])}, the direction in which every point goes")
            made = [f"{column} = (0; ", v, ")"]
        return [[f"{name} = ( ", *pointing.series(name, columns, "S"), " )"], made]

    def words(self, values):
        i, (letter, T) = values["joint"], values["frame"]
        seen = lie.adjoint(lie.inverse(T)) @ self.S
        q_seen = (lie.inverse(T) @ [*self.q, 1])[:3]
        name = "S" if letter == "s" else "B"
        tool, moved = self.robot.fk(self.arm.theta)[:3, 3], self.turn.get()
        lines = [f"joint {i + 1} of {self.robot.name}, seen from frame {{{letter}}}"]
        if self.slides(i):
            return [
                *lines,
                "a slide turns nothing: w = 0, and no point q is needed (the one drawn is only its place)",
                f"v = {text.row(seen[3:])}: the direction in which every point goes, 1 m per metre",
                f"column {i + 1} of {name} = {text.row(seen)}    (0; v)",
                f"tool at {text.millimetres(tool)} after {text.millimetres(moved)}",
            ]
        pitch = float(self.S[:3] @ self.S[3:])
        formula = "v = -w x q"
        if abs(pitch) > axes.SAME:
            formula += f" + h w, with a pitch h of {text.number(1000 * pitch, 1)} mm per rad:"
        else:
            formula += " ="
        return [
            *lines,
            f"direction w = {text.row(seen[:3])}    point q = {text.millimetres(q_seen)}",
            f"{formula} {text.row(1000 * seen[3:], 1)} mm per rad, of the point at {{{letter}}}",
            f"column {i + 1} of {name} = {text.row(seen)}    (w; v), v in metres",
            f"tool at {text.millimetres(tool)} after {text.degrees(moved)}",
        ]

    # -- where will the tool be?

    def begin(self, number):
        move = questions.a_move(self.robot, np.zeros(self.robot.n), number, free=True)
        self.joint.put(self.joint.get() if move is None else move[0])
        self.turn.put(0.0)

    def question(self, values):
        robot, zero = self.robot, np.zeros(self.robot.n)
        move = questions.a_move(robot, zero, self.number, free=True)
        if move is None:
            return questions.NONE
        j, by = move
        if values["joint"] != j or self.turn.get():
            return questions.MOVED
        S = f"S{j + 1} = {text.row(robot.S[:, j])}"
        slides = f"slides by {text.millimetres(by, 0)} along" if self.slides(j) else ""
        goes = slides or f"turns by {text.degrees(by, 0)} about"
        asked = f"joint {j + 1} {goes} its screw {S}, all others rest at zero. Where will the tool be?"
        way = np.linspace(zero, by * np.eye(robot.n)[j], 31)
        asked += " Drag the point there."
        return questions.where_after(robot, zero, j, by, asked, show=lambda _right: self.panel.play(way))

    # -- the axes by the student's functions

    def _S(self, sketch, values):
        return self._axes(sketch, values, self.mine.ask("S"))

    def _body_screws(self, sketch, values):
        mine = self.mine.ask("body_screws", self.robot.S, self.robot.M)
        return self._axes(sketch, values, lie.adjoint(self.robot.M) @ mine)

    def _axis_of(self, sketch, values):
        turning = [self.mine.ask("axis_of", S) for S in self.robot.S[:, hinges(self.robot)].T]
        return self._hinges(sketch, values, [[*w, *(h * w - np.cross(w, q))] for w, q, h in turning])

    def _screw_axis(self, sketch, values):
        turning = hinges(self.robot)
        lines = zip(self.origins[turning], self.points[turning], self.directions[turning], strict=True)
        pairs = [(2 * w, axes.foot(near, q, w)) for near, q, w in lines]  # w may come in any length
        return self._hinges(sketch, values, [self.mine.ask("screw_axis", *pair) for pair in pairs])

    def _hinges(self, sketch, values, screws):
        S = self.robot.S.copy()  # a slide has no axis to be found
        S[:, hinges(self.robot)] = np.array(screws).T
        return self._axes(sketch, values, S)

    def _axes(self, sketch, values, S):
        """The axes of the student's screws in the space frame (6, n), beside the right ones."""
        i, right = values["joint"], self.robot.S
        if S.shape != right.shape:
            raise Trouble(f"it gives {S.shape[1]} screws, and {self.robot.name} has {self.robot.n} joints")
        off = [k for k in range(self.robot.n) if np.abs(S[:, k] - right[:, k]).max() > ZERO]
        for k in range(self.robot.n):
            self._axis(sketch, k, S[:, k], k in off, k == i)
        self._turn(sketch, S[:, i] * self.arm.theta[i], i)
        if not off:
            return "all axes agree with the arm's, below 1e-9"
        listed = f"joint{'s' if len(off) > 1 else ''} {', '.join(str(k + 1) for k in off)}"
        return f"off: {listed}" + (f". Joint {i + 1}: {_between(S[:, i], self.S)}" if i in off else "")

    def _axis(self, sketch, k, S, is_off, is_chosen):
        """The axis of joint k: an arrow where it is off, a tick where it is right."""
        key, label = f"axis{k + 1}", f"S{k + 1}"
        long, w, v = np.linalg.norm(S[:3]), S[:3], S[3:]
        if long < 1e-6:
            sketch.scene.remove(f"{sketch.path}/{key}")
            return
        unit = np.concatenate([w, v]) / long
        point = np.cross(unit[:3], unit[3:])
        at = self.q if is_chosen else self.origins[k]
        right = point if sketch.near(point) else at
        tick = "" if is_off else " \N{CHECK MARK}"
        if not sketch.near(point) or not (is_off or is_chosen):
            sketch.scene.point(f"{sketch.path}/{key}", at, label + tick, "accent" if is_off else "y")
            return
        start = right + unit[:3] * (unit[:3] @ (at - right))
        sketch.scene.screw_axis(
            f"{sketch.path}/{key}", unit, label=f"{sketch.label} {label}{tick}", at=start, color="accent"
        )
        if is_chosen:
            sketch.gap("gap", at, start)

    def _turn(self, sketch, xi, i):
        """The chosen joint and what it carries, turned about the student's axis."""
        moved, n = lie.exp6(xi), self.robot.n
        if sketch.near(moved[:3, 3]):
            sketch.arm(self.robot, np.array([moved if k >= i else np.eye(4) for k in range(n)]))
        else:
            sketch.scene.remove(f"{sketch.path}/arm")

    def _home_pose(self, sketch, _values):
        """The tool frame at zero, for the arm with those five lengths."""
        table = self.robot.standard_dh
        if not self.robot.name.startswith("ABB IRB 1200"):
            raise Trouble("it is the home pose of the ABB: open this with robots.abb_irb1200()")
        lengths = np.array([table.d[0], table.a[1], table.a[2], table.d[3], table.d[5]])
        T, M = self.mine.ask("home_pose", lengths), self.robot.M
        off, turned = apart(T, M)
        if sketch.near(T[:3, 3]) and not np.isnan(turned):
            sketch.frame("tool", T, sketch.label + ("" if max(off, turned) > ZERO else " \N{CHECK MARK}"))
            sketch.gap("gap", M[:3, 3], T[:3, 3])
        else:
            sketch.scene.remove(sketch.path)
        return f"your tool frame at zero and the arm's: {gap(off, turned)}"


def _between(S, right):
    """How a screw differs from the right one, in words."""
    long = np.linalg.norm(S[:3])
    if long < 1e-6:
        return "its first three numbers, the direction, are zero"
    parts = []
    if abs(long - 1) > 1e-6:
        parts.append(f"the direction has length {size(long)}, not 1")
    unit, w = S / long, right[:3]
    angle = np.arctan2(np.linalg.norm(np.cross(unit[:3], w)), unit[:3] @ w)
    if angle > ZERO:
        parts.append(f"the direction is {gap(0, angle)} away")
    foot, right_foot = np.cross(unit[:3], unit[3:]), np.cross(w, right[3:])
    beside = foot - right_foot
    distance = np.linalg.norm(beside - w * (w @ beside))
    if angle <= ZERO and distance > ZERO:
        parts.append(f"the axes are {gap(distance)} apart")
    v = np.linalg.norm(S[3:] - right[3:])
    return "; ".join([*parts, f"v is off by {size(1000 * v)} mm per rad"])


def _frames(robot):
    """Label -> (letter, pose at zero) of the frames from which a screw can be seen."""
    frames = {"space frame: S": ("s", np.eye(4)), "flange frame: B": ("b", robot.M)}
    if robot.n > 2 and robot.joint_types[-2:] == ("revolute", "revolute"):
        w, q = axes.directions_of(robot.S)[-2:], axes.points_on(robot.S)[-2:]
        on_before, on_last = axes.feet(q[0], w[0], q[1], w[1])
        if not axes.parallel(*w) and np.linalg.norm(on_last - on_before) < 1e-9:
            wrist = robot.M.copy()
            wrist[:3, 3] = on_last
            frames["wrist frame: B of the wrist"] = ("w", wrist)
    return frames

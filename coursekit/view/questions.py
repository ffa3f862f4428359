"""What a prediction asks, and what a wrong guess looks like.

A guess is compared with what it may have been meant as: each function that makes a Question knows the
mistakes that are common there, and computes where they would lead.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursekit.kinematics import axes, lie
from coursekit.kinematics.robot import Robot

from . import text
from .chain import chain, hinges

NEAR = 0.05  # of the arm's length: a point that is as near is right
ALONG = np.radians(10)  # a direction that is as near is right
TINY = 1e-6
MOVED = "You moved the arm, and so see it for yourself: this question is over. Another one: next question."
NONE = "Predict: no joint of this arm moves its tool far enough to ask for."
HINGE = np.radians([60, -30, 45, -60, 30, -45, 90, -90])  # turns that are asked for
SLIDE = np.array([0.2, -0.2, 0.1, -0.1, 0.3, -0.3, 0.05, -0.05])  # metres

Told = tuple[str, np.ndarray]  # what is said of a guess, and the right point (3,) nearest to it


@dataclass(frozen=True, eq=False)
class Question:
    """What is asked.

    words   the question
    key     what it depends on: another key is another question
    start   (3,) where the point stands at first
    judge   guess (3,) -> Told
    seen    (k, 3) what has to be in the picture: right and wrong places alike
    origin  (3,) where an arrow begins that the point is the tip of; None: the point itself is asked for
    show    called with the right point: moves the arm there
    """

    words: str
    key: tuple
    start: np.ndarray
    judge: Callable[[np.ndarray], Told]
    seen: np.ndarray
    origin: np.ndarray | None = None
    show: Callable[[np.ndarray], None] | None = None


def a_pose(robot: Robot, start: np.ndarray, number: int) -> np.ndarray:
    """Joint values (n,) of question `number`, easy to say: near `start`, multiples of 15 deg or 50 mm."""
    step = np.where(hinges(robot), np.pi / 12, 0.05)
    away = np.random.default_rng(number).integers(-3, 4, robot.n) if number else 0
    low, high = np.ceil(robot.q_min / step - TINY), np.floor(robot.q_max / step + TINY)
    return np.where(low <= high, step * np.clip(np.round(start / step) + away, low, high), start)


def a_move(robot: Robot, theta: np.ndarray, number: int, free: bool = False) -> tuple[int, float] | None:
    """Joint (from 0) and change that question `number` asks for at theta (n,); None: nothing moves the tool.

    Each joint in turn that moves the tool far enough to be seen, inside its limits or, of a hinge, `free`.
    """
    moves = []
    for j, turns in enumerate(hinges(robot)):
        ways, low, high = np.roll(HINGE if turns else SLIDE, -number), robot.q_min[j], robot.q_max[j]
        inside = (theta[j] + ways >= low - TINY) & (theta[j] + ways <= high + TINY) | (free and turns)
        for by in ways[inside][:1]:
            start = robot.fk(theta)[:3, 3]
            away = np.linalg.norm(_moved(robot.jacobian_space(theta)[:, j], by, start) - start)
            moves.append((float(away), j, float(by)))
    least = max(0.25 * max(moves, default=(0,))[0], 0.02 * chain(robot).size)
    far = [move for move in moves if move[0] > least]
    return far[number % len(far)][1:] if far else None


def where_after(robot: Robot, theta: np.ndarray, j: int, by: float, words: str, **more: Any) -> Question:
    """Where the tool will be when joint j (from 0) has gone on by `by` (rad or m) from theta (n,)."""
    S, start = robot.jacobian_space(theta), robot.fk(theta)[:3, 3]

    def moved(screw: np.ndarray, by: float = by) -> np.ndarray:
        return _moved(screw, by, start)

    right = moved(S[:, j])
    tol = min(NEAR * chain(robot).size, 0.25 * float(np.linalg.norm(right - start)))
    slides = robot.joint_types[j] == "prismatic"
    others = {
        f"you {'went' if slides else 'turned'} the other way": moved(S[:, j], -by),
        "that is where the tool is before the move": start,
        f"as if the axis were where it is at zero, before joints 1 to {j} carry it": moved(robot.S[:, j]),
        "as if theta went by its last value, and not by the difference": moved(S[:, j], theta[j] + by),
    }
    if not slides:
        no_lever = "you turned about the right direction, but through the base: no lever"
        others[no_lever] = lie.exp3(by * S[:3, j]) @ start
    for k in (j - 1, j + 1):
        if 0 <= k < robot.n and robot.joint_types[k] == robot.joint_types[j]:
            others[f"as if joint {k + 1} slid" if slides else f"as if about axis {k + 1}"] = moved(S[:, k])

    def judge(guess: np.ndarray) -> Told:
        parts = (_along_line if slides else _about_axis)(S[:, j], by, start, guess, tol)
        return near(guess, right, others, tol, list(parts)), right

    seen = np.array([start, right, moved(S[:, j], -by)])
    return Question(words, (robot.name, j, by, *theta), start, judge, seen, **more)


def which_elbow(
    robot: Robot,
    now: np.ndarray,
    theta: np.ndarray,
    names: Sequence[str],
    words: str,
    choose: Callable[[int], None],
) -> Question | str:
    """Where the elbow will be, which is now as theta = `now` (n,) says.

    Right is that of any of the solutions theta (k, n), each with its name; `choose` shows the nearest.
    """
    joints, turns, size = chain(robot).joints, hinges(robot), chain(robot).size
    # it bends far from the tool, and far from joint 2 or, where that stands beside axis 1, from joint 1
    beside = joints[min(1, robot.n - 1)].enter - joints[0].enter
    first = int(robot.n > 2 and np.linalg.norm(axes.across(joints[0].along, beside)) < 0.1 * size)
    ends = [joints[first].enter, robot.M[:3, 3]]
    room = [min(np.linalg.norm(one.enter - end) for end in ends) for one in joints]
    far = np.where(turns & (np.arange(robot.n) > first), room, 0.0)
    if far.max() < 0.1 * size:
        return "Predict: this arm has no elbow to ask for."
    e = int(np.argmax(far > 0.9 * far.max()))
    moved = robot.displacements(theta)
    before = _carried(moved[:, e - 1], joints[e - 1].enter)
    places = _carried(moved[:, e], joints[e].enter)
    last = e + 1 == robot.n
    after = _carried(moved[:, e], robot.M[:3, 3] if last else joints[e + 1].leave)
    others = [(turns[e - 1], e, before)] if turns[e - 1] else []
    others += [(True, 0 if last else e + 2, after)] if last or turns[e + 1] else []

    def judge(guess: np.ndarray) -> Told:
        away = np.linalg.norm(places - guess, axis=1)
        best = int(away.argmin())
        alike = np.linalg.norm(places - places[best], axis=1) < TINY
        shared = [name.split() for name, same in zip(names, alike, strict=True) if same]
        name = " ".join(w for w in shared[0] if all(w in other for other in shared)) or names[best]
        gap, said = text.millimetres(away[best], 0), []
        if away[best] <= NEAR * size:
            return f"You hit {name}: {gap} off.", places[best]
        for _, k, at in others:  # what is rigid has its length
            more = np.linalg.norm(guess - at[best]) - np.linalg.norm(places[best] - at[best])
            if abs(more) > NEAR * size:
                far = "far from" if more > 0 else "near to"
                said.append(f"{text.millimetres(abs(more), 0)} too {far} {f'joint {k}' if k else 'the tool'}")
        return f"{gap} off the nearest, {name}{': ' if said else ''}{', '.join(said)}.", places[best]

    words = f"{words} Where will joint {e + 1}, the elbow, be? Drag the point there."
    start, key = _carried(robot.displacements(now)[None, e], joints[e].enter)[0], theta.round(6).ravel()

    def show(right: np.ndarray) -> None:
        choose(int(np.linalg.norm(places - right, axis=1).argmin()))

    return Question(words, (robot.name, *key), start, judge, np.array([start, *places]), show=show)


def which_way(
    origin: np.ndarray,
    right: np.ndarray,
    others: Mapping[str, np.ndarray],
    words: str,
    key: tuple,
    size: float,
    signed: bool = True,
) -> Question:
    """A direction (3,) from origin (3,); others: name -> direction. Not `signed`: either way is right."""
    right = right / np.linalg.norm(right)
    start = origin + 0.2 * size * np.eye(3)[np.abs(right).argmin()]  # tells nothing: across the answer

    def between(way, other):
        angle = np.arctan2(np.linalg.norm(np.cross(way, other)), way @ other)
        return angle if signed else min(angle, np.pi - angle)

    def judge(guess: np.ndarray) -> Told:
        way = guess - origin
        tip = origin + 0.2 * size * right * (1 if signed or way @ right >= 0 else -1)
        if np.linalg.norm(way) < TINY:
            return "Your arrow has no direction.", tip
        off = between(way, right)
        told = f"{text.degrees(off, 0)} off"
        if off <= ALONG:
            return f"Right: {told}.", tip
        kinds = {name: between(way, d) for name, d in others.items() if np.linalg.norm(d) > TINY}
        if signed:
            kinds["you point the other way"] = between(way, -right)
        name = min(kinds, key=kinds.__getitem__, default="")
        meant = name and kinds[name] <= ALONG and kinds[name] < off
        return (f"{told}: {name}." if meant else f"{told}."), tip

    seen = origin + 0.2 * size * np.vstack([np.eye(3), -np.eye(3)])
    return Question(words, key, start, judge, seen, origin)


def near(
    guess: np.ndarray, right: np.ndarray, others: Mapping[str, np.ndarray], tol: float, parts: list
) -> str:
    """How far off a guess (3,) is, and what it looks like: one of `others`, or what of its parts fits."""
    off = float(np.linalg.norm(guess - right))
    told = f"{text.millimetres(off, 0)} off"
    if off <= tol:
        return f"Right: {told}."
    away = {name: float(np.linalg.norm(guess - p)) for name, p in others.items()}
    name = min(away, key=away.__getitem__, default="")
    if name and away[name] <= tol and away[name] < off:
        return f"{told}: {name}."
    good = [said for fits, said, _ in parts if fits]
    bad = [said for fits, _, said in parts if not fits]
    said = f"{' and '.join(good)}{', but ' if good and bad else ''}{', '.join(bad)}"
    return f"{told}: {said}." if said else f"{told}."


def _about_axis(S, by, start, guess, tol):
    """Whether plane, radius and angle are right, for a hinge of screw S (6,): (fits, words, words if not)."""
    w, q = S[:3], np.cross(S[:3], S[3:])
    right, at = _moved(S, by, start) - q, guess - q
    beside = abs(float(w @ (at - right)))
    r_0, r, r_1 = (axes.across(w, x) for x in (start - q, at, right))
    short = float(np.linalg.norm(r_1) - np.linalg.norm(r))
    turned = float(np.arctan2(w @ np.cross(r_0, r), r_0 @ r))
    yield beside <= tol, "right plane", f"{text.millimetres(beside, 0)} off the plane in which it moves"
    size = f"the radius is too {'small' if short > 0 else 'large'} by {text.millimetres(abs(short), 0)}"
    yield abs(short) <= tol, "right radius", size
    if np.linalg.norm(r) > tol:  # near the axis there is no angle
        off = abs(turned - by) * np.linalg.norm(r_1)
        yield off <= tol, "right angle", f"turned by {text.degrees(turned, 0)}, not {text.degrees(by, 0)}"


def _along_line(S, by, start, guess, tol):
    """The same for a slide."""
    gone = float((guess - start) @ S[3:])
    beside = float(np.linalg.norm(axes.across(S[3:], guess - start)))
    yield beside <= tol, "right line", f"{text.millimetres(beside, 0)} beside the line of the slide"
    slid = f"{text.millimetres(gone, 0)} along it, not {text.millimetres(by, 0)}"
    yield abs(gone - by) <= tol, "right length", slid


def _carried(T, p):
    return (T @ [*p, 1])[:, :3]


def _moved(S, q, p):
    return (lie.exp6(S * q) @ [*p, 1])[:3]

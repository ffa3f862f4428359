"""Questions and goals of notebook 02."""

import numpy as np

from coursekit.classroom.question import Question


def _lengths(rng):
    L1, L2 = 5 * int(rng.integers(60, 100)), 5 * int(rng.integers(70, 120))
    return {"L1": L1, "L2": L2, "L3": 5 * int(rng.integers(5, 14)), "L4": 5 * int(rng.integers(70, 120))}


def _two(rng):
    first, second = rng.choice(range(20, 60), 2, replace=False)
    return {"first": 10 * int(first), "second": 10 * int(second)}


def _lever(rng):
    return {"h": int(rng.integers(2, 9)) / 10, "x": int(rng.integers(2, 9)) / 10}


def _line(rng):
    return {"vx": int(rng.integers(1, 9)) / 10, "vy": -int(rng.integers(1, 9)) / 10}


def _change(rng):
    what = ("it is bolted to a table 700 mm high; the space frame stays on the floor", "a")
    grip = ("a gripper 150 mm long is mounted, and its tip becomes the tool frame", "b")
    text, letter = (what, grip)[int(rng.integers(2))]
    return {"what": text, "letter": letter}


QUESTIONS = [
    Question(
        name="recall_two_links",
        draw=_two,
        text="Notebook 01: a table with two rows, a = {first} and {second} mm, no twists, no shifts. At the\n"
        "joint angles 90 and -90 degrees, where is frame 2, seen from frame 0? [x, y, z] in mm",
        answer=lambda first, second: [second, first, 0],
        slips={
            "theta_2 counts from the first link, not from the ground.": (
                lambda first, second: [0, first - second, 0]
            ),
            "At 90 degrees the first link points along y.": lambda first, second: [first, -second, 0],
        },
    ),
    Question(
        name="recall_turn",
        draw=lambda rng: {"x": int(rng.integers(2, 9)) / 10},
        text="Notebook 01: a hinge along +z passes through ({x}, 0, 0) m and turns by 90 degrees. Where\n"
        "does the point at the origin go? [x, y, z] in metres",
        answer=lambda x: [x, -x, 0],
        slips={
            "The point lies behind the axis: about +z it turns towards -y.": lambda x: [x, x, 0],
            "It turns about the hinge, which is not at the origin.": lambda x: [0, 0, 0],
        },
    ),
    Question(
        name="abb_screw_4",
        draw=_lengths,
        text="An arm of the ABB's shape: L1 = {L1}, L2 = {L2}, L3 = {L3}, L4 = {L4} mm.\n"
        "The screw of joint 4, [omega; v], six numbers, v in mm?",
        answer=lambda L1, L2, L3, L4: [1, 0, 0, 0, L1 + L2 + L3, 0],
        slips={
            "v = -w x q has the other sign.": lambda L1, L2, L3, L4: [1, 0, 0, 0, -L1 - L2 - L3, 0],
            "The forearm runs L3 above the end of the upper arm.": (
                lambda L1, L2, L3, L4: [1, 0, 0, 0, L1 + L2, 0]
            ),
            "The direction comes first: (omega; v).": lambda L1, L2, L3, L4: [0, L1 + L2 + L3, 0, 1, 0, 0],
        },
    ),
    Question(
        name="abb_screw_5",
        draw=_lengths,
        text="An arm of the ABB's shape: L1 = {L1}, L2 = {L2}, L3 = {L3}, L4 = {L4} mm.\n"
        "The screw of joint 5, [omega; v], six numbers, v in mm?",
        answer=lambda L1, L2, L3, L4: [0, 1, 0, -L1 - L2 - L3, 0, L4],
        slips={
            "v = -w x q has the other sign.": lambda L1, L2, L3, L4: [0, 1, 0, L1 + L2 + L3, 0, -L4],
            "v is not the point q, but -w x q.": lambda L1, L2, L3, L4: [0, 1, 0, L4, 0, L1 + L2 + L3],
            "The forearm runs L3 above the end of the upper arm.": (
                lambda L1, L2, L3, L4: [0, 1, 0, -L1 - L2, 0, L4]
            ),
        },
    ),
    Question(
        name="lever",
        draw=_lever,
        text="A joint axis along +y passes through ({x}, 0, {h}) m. Its v, [x, y, z] in metres?",
        answer=lambda h, x: [-h, 0, x],
        slips={
            "That is w x q: v has the other sign.": lambda h, x: [h, 0, -x],
            "v is a velocity at the origin, not the point q.": lambda h, x: [x, 0, h],
        },
    ),
    Question(
        name="where_is_the_axis",
        draw=_line,
        text="S = (0, 0, 1; {vx}, {vy}, 0). The point of its axis nearest to the origin, [x, y, z] in m?",
        answer=lambda vx, vy: [-vy, vx, 0],
        slips={
            "That is v x omega: the point has the other sign.": lambda vx, vy: [vy, -vx, 0],
            "v is a velocity, not a point of the axis.": lambda vx, vy: [vx, vy, 0],
        },
    ),
    Question(
        name="pitch",
        draw=lambda rng: {"x": int(rng.integers(1, 9)) / 10, "h": int(rng.integers(2, 9)) / 100},
        text="S = (0, 1, 0; {x}, {h}, 0). By how many millimetres does it slide along its\n"
        "axis in one full turn?",
        answer=lambda x, h: 2000 * np.pi * h,
        slips={
            "That is per radian; a turn has 2 pi of them.": lambda x, h: 1000 * h,
            "The pitch is the part of v along omega, not the length of v.": (
                lambda x, h: 2000 * np.pi * float(np.hypot(x, h))
            ),
        },
        tolerance=0.5,
    ),
    Question(
        name="seen_from_the_tool",
        draw=lambda rng: {"px": int(rng.integers(4, 12)) / 10, "pz": int(rng.integers(2, 9)) / 10},
        text="The tool frame is parallel to the space frame and stands at ({px}, 0, {pz}) m. A joint turns\n"
        "about the z axis of the space frame. The lower half of its body screw B, [x, y, z] in metres?",
        answer=lambda px, pz: [0, px, 0],
        slips={
            "From the tool the axis lies behind: at -p.": lambda px, pz: [0, -px, 0],
            "It is 0 only from the space frame: the axis passes its origin, not that of the tool.": (
                lambda px, pz: [0, 0, 0]
            ),
        },
    ),
    Question(
        name="what_changes",
        draw=_change,
        text="One thing is changed on an arm: {what}.\nWhich of M, S and B change?\n"
        '"a" M and S   "b" M and B   "c" S and B   "d" all three',
        answer=lambda what, letter: letter,
        slips={
            "S is seen from the space frame, B from the tool; who has moved against the axes?": (
                lambda what, letter: "b" if letter == "a" else "a"
            )
        },
    ),
]

GOALS = {
    "Read M off a drawing": ["home_pose", "home_and_screws"],
    "Read screws off a drawing": ["screw_axis", "joint_screw", "abb_screw_4", "abb_screw_5", "lever"],
    "Read an axis back from its six numbers": ["axis_of", "where_is_the_axis", "pitch"],
    "Carry screws from one frame to another": ["adjoint", "body_screws", "from_another_frame"],
    "Name the frame of a list of screws": ["what_changes", "seen_from_the_tool"],
}

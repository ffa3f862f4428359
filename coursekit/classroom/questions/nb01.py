"""Questions and goals of notebook 01."""

import numpy as np

from coursekit.classroom.question import Question


def _frame(rng):
    px, py = (int(k) / 10 for k in rng.choice(range(2, 9), 2, replace=False))
    return {"px": px, "py": py, "x": int(rng.integers(1, 6)) / 10}


def _abb(rng):
    return {
        "L1": 5 * int(rng.integers(60, 100)),
        "L2": 5 * int(rng.integers(70, 120)),
        "L3": 5 * int(rng.integers(5, 14)),
        "L4": 5 * int(rng.integers(70, 120)),
    }


def _row(rng):
    return {
        "a": 10 * int(rng.integers(10, 60)),
        "d": 10 * int(rng.integers(-40, 40)),
        "alpha": int(rng.choice([-90, 90, 180])),
        "theta": int(rng.choice([-90, 90, 180])),
    }


def _at(a, d, theta):
    angle = np.radians(theta)
    return [a * np.cos(angle), a * np.sin(angle), d]


def _other_units(row):
    """Slips of a row in mm and degrees: what it reads in metres, in radians, in both."""

    def written(length, angle):
        return lambda **lengths: [float(x) for x in np.multiply(row(**lengths), [length, angle] * 2)]

    metres, radians = 0.001, np.pi / 180
    return {
        "a and d in mm, please, and angles in degrees: you have metres and radians.": written(
            metres, radians
        ),
        "a and d in mm, please: you have metres.": written(metres, 1),
        "alpha and theta in degrees, please: you have radians.": written(1, radians),
    }


OF_THE_FIGURE = "That is the arm of figure 3; this one has other lengths: they stand in the question."
WRONG = ("its origin is right, its rotation is not", "only the height of its origin is off")

QUESTIONS = [
    Question(
        name="read_t_ab",
        draw=_frame,
        text="Frame b stands at ({px}, {py}, 0) m in frame a and is turned by 90 degrees about z. A point\n"
        "has the coordinates ({x}, 0, 0) m in b. Its coordinates in a, [x, y, z] in metres?",
        answer=lambda px, py, x: [px, py + x, 0],
        slips={
            "The x axis of b points along y of a: turn first, then shift.": lambda px, py, x: [px + x, py, 0],
            "The origin of b is missing: turn, then add it.": lambda px, py, x: [0, x, 0],
            "Turned the wrong way: about z, x turns into y.": lambda px, py, x: [px, py - x, 0],
        },
    ),
    Question(
        name="other_way",
        draw=lambda rng: {k: v for k, v in _frame(rng).items() if k != "x"},
        text="Frame b stands at ({px}, {py}, 0) m in frame a and is turned by 90 degrees about z. Where\n"
        "is the origin of frame a, seen from b? [x, y, z] in metres",
        answer=lambda px, py: [-py, px, 0],
        slips={
            "-p is the way back, but written in a: seen from b it is turned, -R'p.": (
                lambda px, py: [-px, -py, 0]
            ),
            "That is R'p: the way back has the other sign.": lambda px, py: [py, -px, 0],
        },
    ),
    Question(
        name="abb_row_2",
        draw=_abb,
        text="An arm of the shape of figure 3: column {L1}, upper arm {L2}, elbow {L3}, forearm {L4} mm.\n"
        "Row 2 of its table, [a in mm, alpha in degrees, d in mm, theta in degrees]?",
        answer=lambda L1, L2, L3, L4: [L2, 0, 0, -90],
        slips={
            "x_1 points forward, x_2 up: about z_1, into the page, that is the other sense.": (
                lambda L1, L2, L3, L4: [L2, 0, 0, 90]
            ),
            "x_2 leads from axis 2 to axis 3, upwards; x_1 points forward. What turns one into the other?": (
                lambda L1, L2, L3, L4: [L2, 0, 0, 0]
            ),
            "The upper arm is the common normal of axes 2 and 3: an a, not a d.": (
                lambda L1, L2, L3, L4: [0, 0, L2, -90]
            ),
            "z_1 and z_2 both point into the page: there is no twist.": (
                lambda L1, L2, L3, L4: [L2, -90, 0, -90]
            ),
            OF_THE_FIGURE: lambda L1, L2, L3, L4: [448, 0, 0, -90],
            **_other_units(lambda L1, L2, L3, L4: [L2, 0, 0, -90]),
        },
    ),
    Question(
        name="abb_row_4",
        draw=_abb,
        text="An arm of the shape of figure 3: column {L1}, upper arm {L2}, elbow {L3}, forearm {L4} mm.\n"
        "Row 4 of its table, x_4 upwards as x_3: [a in mm, alpha in degrees, d in mm, theta in degrees]?",
        answer=lambda L1, L2, L3, L4: [0, 90, L4, 0],
        slips={
            "The forearm lies along axis 4, that is z_3: a d, not an a.": (
                lambda L1, L2, L3, L4: [L4, 90, 0, 0]
            ),
            "z_3 (forward) turns into z_4 (into the page) about x_4 (up): look at the sense.": (
                lambda L1, L2, L3, L4: [0, -90, L4, 0]
            ),
            "Axes 4 and 5 are perpendicular: there is a twist.": lambda L1, L2, L3, L4: [0, 0, L4, 0],
            OF_THE_FIGURE: lambda L1, L2, L3, L4: [0, 90, 451, 0],
            **_other_units(lambda L1, L2, L3, L4: [0, 90, L4, 0]),
        },
    ),
    Question(
        name="where_is_frame",
        draw=lambda rng: {
            "convention": str(rng.choice(["standard", "modified"])),
            "i": (i := int(rng.integers(2, 6))),
            "next": i + 1,
            "before": i - 1,
        },
        text="Where is frame {i} of a {convention} table?\n"
        '"a" on axis {before}   "b" on axis {i}   "c" on axis {next}   "d" between axes {i} and {next}',
        answer=lambda convention, **_: "b" if convention == "modified" else "c",
        slips={
            "Modified: link first, joint second. Standard: the other way round.": (
                lambda convention, **_: "c" if convention == "modified" else "b"
            )
        },
    ),
    Question(
        name="origin_of_row",
        draw=_row,
        text="A standard row has a = {a} mm, alpha = {alpha} deg, d = {d} mm, theta = {theta} deg. Where is\n"
        "the origin of frame i, seen from frame i - 1? [x, y, z] in mm",
        answer=lambda a, d, alpha, theta: _at(a, d, theta),
        slips={
            "a leads along the new x axis, which theta has turned.": lambda a, d, alpha, theta: [a, 0, d],
            "theta turns about z: the height stays d.": lambda a, d, alpha, theta: [a, 0, -d],
        },
    ),
    Question(
        name="slide_row",
        draw=lambda rng: {"d": 10 * int(rng.integers(5, 30)), "q": 10 * int(rng.integers(2, 20))},
        text="Joint 3 slides; its row has the offset d = {d} mm. At the joint value {q} mm, how far is the\n"
        "origin of frame 3 from the origin of frame 2, measured along z_2, in mm?",
        answer=lambda d, q: d + q,
        slips={
            "The joint value is added to the offset.": lambda d, q: q,
            "The offset alone: the joint has moved.": lambda d, q: d,
        },
    ),
    Question(
        name="offset_of_table",
        draw=lambda rng: {
            "turn": int(rng.choice([-90, 90, 180])),
            "angle": 5 * int(rng.integers(2, 9)),
        },
        text="A table was made with joint 3 turned by {turn} degrees from the robot's zero; its angle is 0\n"
        "there. The robot says {angle} degrees. What is the angle in the table, in degrees?",
        answer=lambda turn, angle: angle - turn,
        slips={
            "Where the joint is turned so far, the table says 0: the turn is subtracted.": (
                lambda turn, angle: angle + turn
            )
        },
    ),
    Question(
        name="where_is_the_fault",
        draw=lambda rng: {
            "i": (i := int(rng.integers(3, 6))),
            "before": i - 1,
            "what": WRONG[int(rng.integers(2))],
        },
        text="A check goes frame by frame: frames 1 to {before} are right. In frame {i}, seen from\n"
        "frame {before}, {what}. One number of row {i} is wrong, a is not zero. Which one?\n"
        '"a" a   "b" alpha   "c" theta   "d" d',
        answer=lambda what, **_: "d" if "height" in what else "b",
        slips={
            "theta swings a around: the origin would move as well.": (
                lambda what, **_: "x" if "height" in what else "c"
            ),
            "Height is measured along the old z axis, and that is d.": (
                lambda what, **_: "a" if "height" in what else "x"
            ),
        },
    ),
    Question(
        name="rounding_or_not",
        draw=lambda rng: {"gap": str(rng.choice(["2e-15", "1e-9", "4e-7"]))},
        text="Two ways to compute the tool pose of a KR6 differ by {gap} m. What is it?\n"
        '"a" rounding: both are right   "b" one of them is slightly different: look for a rounded constant',
        answer=lambda gap: "a" if gap == "2e-15" else "b",
        slips={
            "Rounding leaves about 1e-15 m on an arm of this size.": lambda gap: (
                "b" if gap == "2e-15" else "a"
            )
        },
    ),
]

GOALS = {
    "Read poses": ["read_t_ab", "other_way"],
    "Make a DH table": ["dh_table", "abb_row_2", "abb_row_4", "offset_of_table"],
    "Tool by both DH conventions": [
        "dh_transform",
        "mdh_transform",
        "fk_dh",
        "where_is_frame",
        "origin_of_row",
    ],
    "Tool by exponentials": ["screw_exp", "fk_poe"],
    "Hinges and slides alike": ["joint_transform", "slide_row"],
    "Find a fault by a check": ["where_is_the_fault", "rounding_or_not"],
    "Further: screws and ranges of a table": ["screws_from_dh", "ranges_to_dh"],
}

"""URDFs: public arms against another program that reads the same files, and what is refused, by line."""

import re
from pathlib import Path

import numpy as np
import pytest

from coursekit import Robot, dh
from tests.kinematics.conftest import load

FOLDER = Path(__file__).resolve().parents[1] / "urdf"
ARMS = load("urdf")["arms"]
every_arm = pytest.mark.parametrize("name", ARMS)


def robot_of(name):
    return Robot.from_urdf(FOLDER / f"{name}.urdf", ARMS[name]["tip"])


def test_every_file_has_its_golden_numbers():
    assert {path.stem for path in FOLDER.glob("*.urdf")} == set(ARMS)


@every_arm
def test_golden_poses_and_jacobians(name):
    robot, cases = robot_of(name), ARMS[name]["cases"]
    q = np.array([case["q"] for case in cases])
    for found, key in (
        (robot.fk(q), "T"),
        (robot.jacobian_space(q), "J_space"),
        (robot.jacobian_body(q), "J_body"),
    ):
        assert np.abs(found - [case[key] for case in cases]).max() <= 1e-14, key


@every_arm
def test_golden_joints_and_limits(name):
    robot, sheet = robot_of(name), ARMS[name]
    assert (robot.n, robot.joint_types) == (sheet["n"], tuple(sheet["joint_types"]))
    for key, none in (("q_min", -np.inf), ("q_max", np.inf)):
        wanted = [none if value is None else value for value in sheet[key]]
        assert np.allclose(getattr(robot, key), wanted, rtol=0, atol=1e-15)
    speeds = [np.nan if value == 0 else value for value in sheet["v_max"]]
    assert np.allclose(robot.v_max, speeds, rtol=0, atol=1e-15, equal_nan=True)
    assert robot.name == name


@every_arm
def test_joints_stand_where_the_file_puts_them_and_tables_follow(name):
    robot = robot_of(name)
    frames = robot.link_frames(np.zeros(robot.n))
    assert np.abs(frames[:-1, :3, 3] - robot.places[:-1]).max() <= 1e-15
    q = np.array([case["q"] for case in ARMS[name]["cases"]])
    # Axes that are parallel to 4e-6 rad have their common normals kilometres away, which costs the digits.
    slack = 1e-14 if name not in ("kinova_gen3", "universal_ur5") else 1e-9
    for table in (robot.standard_dh, robot.modified_dh):
        assert np.abs(table.fk(q) - robot.fk(q)).max() <= slack


def test_another_tip_is_another_tool():
    path = FOLDER / "franka_panda_hand.urdf"
    flange, tcp = Robot.from_urdf(path, "flange_link"), Robot.from_urdf(path, tip="tcp_link")
    assert flange.n == tcp.n == 7
    assert np.abs(flange.with_tool(np.linalg.inv(flange.M) @ tcp.M).M - tcp.M).max() < 1e-15
    finger = Robot.from_urdf(path, "left_finger_link")
    assert finger.joint_types[-1] == "prismatic" and finger.n == 8
    elbow = Robot.from_urdf(path, "joint4_link")
    assert elbow.n == 4


def test_what_the_file_says_can_be_said_otherwise():
    path = FOLDER / "kuka_iiwa14.urdf"
    robot = Robot.from_urdf(str(path), name="iiwa", home=[0, 0.5, 0, -1.5, 0, 1, 0])
    assert (robot.name, robot.home[1], robot.source) == ("iiwa", 0.5, "kuka_iiwa14.urdf")
    assert dh.from_axes(robot.S[:3].T, robot.places, robot.M).n == 7


# -- what is refused: the text of the robot, and what is said about it --

LINKS = '<link name="a"/>\n<link name="b"/>\n<link name="c"/>'


def arm(joints, links=LINKS, head="<robot name='r'>"):
    return f"{head}\n{links}\n{joints}\n</robot>"


def joint(inside="", kind="revolute", ends='<parent link="a"/><child link="b"/>', name="j"):
    return f'<joint name="{name}" type="{kind}">\n{ends}\n{inside}\n</joint>'


LIMIT = '<limit lower="-1" upper="1" velocity="2"/>'
REFUSED = {
    "floating": (
        joint(kind="floating"),
        "<joint name='j'> (line 5) is of type 'floating'; a chain is made of",
    ),
    "planar": (joint(kind="planar"), "<joint name='j'> (line 5) is of type 'planar'"),
    "ball": (joint(kind="ball"), "<joint name='j'> (line 5) is of type 'ball'"),
    "mimic": (
        joint(LIMIT + '<mimic joint="k"/>'),
        "<joint name='j'> (line 5) follows another joint (<mimic>)",
    ),
    "no type": (
        '<joint name="j"><parent link="a"/><child link="b"/></joint>',
        "(line 5) needs the attribute 'type'",
    ),
    "no limit": (joint(), "<joint name='j'> (line 5) is revolute and needs <limit lower=... upper=...>"),
    "no range": (joint(kind="prismatic"), "<joint name='j'> (line 5) is prismatic and needs <limit"),
    "limits crossed": (
        joint('<limit lower="2" upper="1"/>'),
        "<joint name='j'> (line 5): its lower limit 2 is above its upper limit 1",
    ),
    "no number": (
        joint('<limit lower="-pi" upper="1"/>'),
        "<limit> (line 7): lower must be 1 finite numbers, got '-pi'",
    ),
    "two numbers": (
        joint(LIMIT + '<origin xyz="0 1"/>'),
        "<origin> (line 7): xyz must be 3 finite numbers, got '0 1'",
    ),
    "not finite": (
        joint(LIMIT + '<origin rpy="0 nan 0"/>'),
        "<origin> (line 7): rpy must be 3 finite numbers",
    ),
    "no axis": (joint(LIMIT + '<axis xyz="0 0 0"/>'), "<joint name='j'> (line 5): its axis is 0 0 0"),
    "no parent": (
        joint(LIMIT, ends='<child link="b"/>'),
        "<joint name='j'> (line 5) needs <parent link=...>",
    ),
    "no child": (joint(LIMIT, ends='<parent link="a"/>'), "<joint name='j'> (line 5) needs <child link=...>"),
    "nameless parent": (
        joint(LIMIT, ends="<parent/>"),
        "<parent> (line 6) needs the attribute 'link'; it has: none",
    ),
    "unknown link": (
        joint(LIMIT, ends='<parent link="a"/><child link="z"/>'),
        "<joint name='j'> (line 5): its child 'z' is no <link> of this robot",
    ),
    "carried twice": (
        joint(LIMIT) + joint(LIMIT, ends='<parent link="c"/><child link="b"/>', name="k"),
        "<joint name='k'> (line 8) carries link 'b', which <joint name='j'> (line 5) carries already",
    ),
    "a loop": (
        joint(LIMIT) + joint(LIMIT, ends='<parent link="b"/><child link="a"/>', name="k"),
        "<joint name='j'> (line 5) is part of a loop: no link is the root",
    ),
    "nothing moves": (
        joint(kind="fixed"),
        "nothing moves between the root of <robot name='r'> (line 1) and its tip",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_chain_cannot_be_made_of_is_named_with_its_line(case):
    joints, message = REFUSED[case]
    with pytest.raises(ValueError, match=re.escape(message)):
        Robot.from_urdf(arm(joints), "b")


def test_a_joint_beside_the_chain_does_not_matter():
    beside = joint(kind="floating", ends='<parent link="b"/><child link="c"/>', name="loose")
    assert Robot.from_urdf(arm(joint(LIMIT) + beside), "b").n == 1


@pytest.mark.parametrize(
    "text, tip, message",
    [
        (
            arm(joint(LIMIT)),
            None,
            "<robot name='r'> (line 1) has 2 ends: say which link is the tip, one of b, c",
        ),
        (arm(joint(LIMIT)), "z", "<robot name='r'> (line 1) has no link 'z'; it has: a, b, c"),
        (arm("", links="<link/>"), None, "<link> (line 2) needs the attribute 'name'; it has: none"),
        ("<sdf/>", None, "a URDF begins with <robot>, this file with <sdf> (line 1)"),
        ("<robot>", None, "this is no XML: no element found: line 1"),
        ("<robot a='1' a='2'/>", None, "this is no XML: duplicate attribute: line 1"),
        (
            "<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY e 'e'>]>\n<robot name='&e;'/>",
            None,
            "a URDF has no document type: <!DOCTYPE> in line 2",
        ),
        ("<!DOCTYPE robot SYSTEM 'http://localhost/x'><robot/>", None, "a URDF has no document type"),
        ("<robot name='&e;'/>", None, "this is no XML: undefined entity: line 1"),
        (
            arm("<xacro:include filename='x'/>"),
            None,
            "this is a xacro file, from which a URDF must first be made",
        ),
    ],
)
def test_what_is_no_robot(text, tip, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        Robot.from_urdf(text, tip)


def test_a_file_that_is_not_there():
    with pytest.raises(FileNotFoundError):
        Robot.from_urdf(FOLDER / "nobody.urdf")

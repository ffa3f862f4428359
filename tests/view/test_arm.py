"""The drawn arm: joined up, reaching the tool, standing on its foot, and the same at any size."""

import numpy as np
import pytest

from coursekit import Robot, dh, robots
from coursekit.view import arm, chain, shapes

CATALOGUE = robots.all()


def scara():
    table = dh.Table(
        [0.325, 0.225, 0, 0], [0, np.pi, 0, 0], [0.4, 0, 0.1, 0], np.zeros(4), joint_types="RRPR"
    )
    return Robot.from_dh(table, name="scara", q_min=[-2, -2, 0, -3], q_max=[2, 2, 0.2, 3])


def stanford():
    z, y = [0, 0, 1], [0, 1, 0]
    wrist = [0, 0.15, 0.9]
    M = [[1, 0, 0, 0], [0, 1, 0, 0.15], [0, 0, 1, 1.05], [0, 0, 0, 1]]
    points = [[0, 0, 0], [0, 0, 0.4], wrist, wrist, wrist, wrist]
    limits = {"q_min": [-3, -3, -0.2, -3, -3, -3], "q_max": [3, 3, 0.3, 3, 3, 3]}
    return Robot.from_axes([z, y, z, z, y, z], points, M, joint_types="RRPRRR", name="Stanford arm", **limits)


def gantry():
    M = [[1, 0, 0, 0.4], [0, 1, 0, 0.3], [0, 0, 1, 0.5], [0, 0, 0, 1]]
    return Robot.from_axes(
        np.eye(3), np.zeros((3, 3)), M, joint_types="PPP", q_min=[0] * 3, q_max=[0.5, 0.4, 0.3], name="gantry"
    )


OTHERS = {"scara": scara(), "stanford": stanford(), "gantry": gantry()}
ALL = {**CATALOGUE, **OTHERS}
every_robot = pytest.mark.parametrize("robot", ALL.values(), ids=ALL.keys())


def vertices(parts):
    return np.concatenate([part.mesh().vertices for part in parts])


def surface(parts, fine=4):
    """Points all over the surface of the parts."""
    points = []
    for part in parts:
        mesh = part.mesh()
        corner = mesh.vertices[mesh.faces]
        for u in np.linspace(0, 1, fine):
            for v in np.linspace(0, 1 - u, fine):
                points.append(corner[:, 0] * (1 - u - v) + corner[:, 1] * u + corner[:, 2] * v)
    return np.concatenate(points)


def gap(a, b):
    """Smallest distance between two clouds of points."""
    return np.sqrt(((a[:, None] - b) ** 2).sum(-1).min())


def around(points, center, radius, most=400):
    """At most so many of the points within a radius."""
    near = points[np.linalg.norm(points - center, axis=1) < radius]
    return near[:: len(near) // most + 1]


def poses(robot, count=2):
    """Configurations inside the limits (half a turn where there are none)."""
    rng = np.random.default_rng(5)
    low, high = np.clip(robot.q_min, -np.pi, np.pi), np.clip(robot.q_max, -np.pi, np.pi)
    return [np.zeros(robot.n), low, high, *(rng.uniform(low, high) for _ in range(count))]


@every_robot
def test_every_part_is_a_closed_surface_seen_from_outside(robot):
    for parts in [*arm.solid(robot), *arm.skeleton(robot)]:
        for part in parts:
            mesh = part.mesh()
            assert np.isfinite(mesh.vertices).all()
            a, b, c = np.swapaxes(mesh.vertices[mesh.faces], 0, 1)
            volume = np.einsum("ij,ij->", a - mesh.vertices[0], np.cross(b - a, c - a)) / 6
            size = np.ptp(mesh.vertices, axis=0).max()
            assert volume > 1e-6 * size**3
            area = np.cross(b - a, c - a)
            facing = np.einsum("ij,ij->i", mesh.normals[mesh.faces].sum(axis=1), area)
            assert (facing > -1e-3 * np.linalg.norm(area, axis=1)).all()  # no normal points inwards
            np.testing.assert_allclose(area.sum(axis=0), 0, atol=1e-9 * size**2)  # closed


@every_robot
def test_neighbouring_links_touch_in_every_pose(robot):
    joints = chain.chain(robot).joints
    links = [surface(parts, 9) for parts in arm.solid(robot)]
    for theta in poses(robot):
        moved = [np.eye(4), *robot.displacements(theta)]
        for i, joint in enumerate(joints):
            reach = 2 * joint.radius + (np.abs(joint.travel).max() if joint.travel else 0)
            here, there = (
                around(links[k], joint.split, reach) @ moved[k][:3, :3].T + moved[k][:3, 3]
                for k in (i, i + 1)
            )
            assert gap(here, there) < (0.8 if joint.travel else 0.3) * joint.radius, (
                f"links {i} and {i + 1} are apart"
            )


@every_robot
def test_the_last_link_reaches_the_tool_point(robot):
    last = chain.chain(robot).joints[-1]
    assert gap(surface(arm.solid(robot)[-1], 3), robot.M[None, :3, 3]) < 2.2 * last.radius
    assert gap(surface(arm.skeleton(robot)[-1]), robot.M[None, :3, 3]) < 0.02 * chain.chain(robot).size


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_base_stands_on_the_foot_and_axis_1(name):
    robot = CATALOGUE[name]
    standing = chain.chain(robot)
    base = vertices(arm.solid(robot)[0])
    assert base[:, 2].min() == pytest.approx(standing.foot[2], abs=1e-9)
    lowest = base[base[:, 2] < standing.foot[2] + 1e-6]
    np.testing.assert_allclose(
        (lowest.min(axis=0) + lowest.max(axis=0))[:2] / 2, standing.foot[:2], atol=1e-9
    )
    if name != "planar_2r":  # the planar arm lies in the plane z = 0 and needs a pedestal below
        np.testing.assert_allclose(standing.foot, 0, atol=1e-12)


@pytest.mark.parametrize("scale", [0.01, 100])
@every_robot
def test_an_arm_looks_the_same_at_any_size(robot, scale):
    S, M = robot.S.copy(), robot.M.copy()
    slides = np.array([kind == "prismatic" for kind in robot.joint_types])
    S[3:, ~slides] *= scale
    M[:3, 3] *= scale
    limits = {key: np.where(slides, scale, 1) * getattr(robot, key) for key in ("q_min", "q_max")}
    small, large = Robot.from_screws(robot.S, robot.M), Robot.from_screws(S, M)
    if slides.any():
        small = Robot.from_screws(robot.S, robot.M, q_min=robot.q_min, q_max=robot.q_max)
        large = Robot.from_screws(S, M, **limits)
    for a, b in zip(arm.solid(small), arm.solid(large), strict=True):
        np.testing.assert_allclose(scale * vertices(a), vertices(b), rtol=1e-7, atol=1e-7 * scale)


@pytest.mark.parametrize("name", CATALOGUE)
def test_proportions(name):
    """Neither spindly nor bloated: thinner from base to tool, and between 2 and 10 % of the length."""
    standing = chain.chain(CATALOGUE[name])
    radii = np.array([joint.radius for joint in standing.joints]) / standing.size
    assert (np.diff(radii[1:]) <= 1e-12).all()
    assert radii.max() < 0.1
    assert radii.min() > 0.015


def test_the_drum_of_an_elbow_is_about_the_axis():
    """Joint 2 of the KR6: the drum on link 1 is round about axis 2, through (25, 0, 400) mm along y."""
    drum = next(part for part in arm.solid(robots.kuka_kr6())[1] if abs(part.pose[1, 2]) > 0.9)
    p = drum.mesh().vertices
    ring = np.hypot(p[:, 0] - 0.025, p[:, 2] - 0.4)
    joint = chain.chain(robots.kuka_kr6()).joints[1]
    assert ring.max() == pytest.approx(joint.radius, rel=1e-9)
    assert np.isclose(ring, joint.radius, rtol=1e-9).sum() >= 40


def test_a_rod_stays_in_its_sleeve_over_the_whole_travel():
    robot = OTHERS["scara"]
    sleeve = [part for part in arm.solid(robot)[2] if part.color == "body"][-1].mesh().vertices
    rod = next(part for part in arm.solid(robot)[3] if part.color == "metal").mesh().vertices
    along = robot.S[3:, 2]
    for q in (robot.q_min[2], robot.q_max[2]):
        moved = (rod + q * along) @ along
        assert moved.min() < (sleeve @ along).mean() < moved.max()


def test_the_skeleton_reaches_a_slide_that_is_out():
    robot = OTHERS["scara"]
    lines = [part for part in arm.skeleton(robot)[3] if part.color == "bone"]
    along, enter = robot.S[3:, 2], chain.chain(robot).joints[2].enter
    stick = np.concatenate([part.mesh().vertices for part in lines]) @ along
    for q in (robot.q_min[2], robot.q_max[2]):
        assert (stick + q).min() <= enter @ along + 1e-9 <= (stick + q).max() + 2e-9


def test_skeleton_axes_lie_on_the_screws():
    robot = robots.puma560()
    for S, parts in zip(robot.S.T, arm.skeleton(robot)[1:], strict=True):
        dashes = [part for part in parts if part.color == "axis"]
        assert dashes
        for dash in dashes:
            middle = dash.mesh().vertices.mean(axis=0)
            np.testing.assert_allclose(np.cross(middle, S[:3]), S[3:], atol=1e-9)


def test_a_tube_is_as_thick_as_it_says_and_does_not_twist():
    t = np.linspace(0, 6, 200)
    points = np.column_stack([np.cos(t), np.sin(t), 0.1 * t])
    mesh = shapes.tube(points, 0.01, segments=8)
    rings = mesh.vertices.reshape(-1, 8, 3)[2:-2]
    np.testing.assert_allclose(np.linalg.norm(rings - points[:, None], axis=-1), 0.01, rtol=1e-9)
    step = np.linalg.norm(np.diff(rings, axis=0), axis=-1)
    assert step.max() < 1.05 * np.linalg.norm(np.diff(points, axis=0), axis=-1).max()

"""The walk along the arm: for few and for many configurations the same, and frames as they are promised."""

import numpy as np
import pytest

from coursekit import Robot, lie, robots
from coursekit.kinematics import links
from tests.kinematics.test_robot import random_robot


@pytest.mark.parametrize("robot", robots.all().values(), ids=lambda robot: robot.name)
def test_few_and_many_walk_alike(robot):
    theta = np.random.default_rng(0).uniform(-3, 3, (robot.n, links.FEW + 5))
    few, many = list(robot.links._along_few(theta)), list(robot.links._along_many(theta))
    assert len(few) == len(many) == robot.n + 1
    assert max(np.abs(a - b).max() for a, b in zip(few, many, strict=True)) < 3e-15


@pytest.mark.parametrize("draw", range(10))
def test_few_and_many_walk_alike_along_any_chain(draw):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng, helical=draw % 2 == 0)
    theta = rng.uniform(-3, 3, (robot.n, 7))
    for a, b in zip(robot.links._along_few(theta), robot.links._along_many(theta), strict=True):
        assert np.abs(a - b).max() < 1e-14 * (3 + 3 * robot.n)


def test_links_multiply_to_the_home_pose():
    for robot in robots.all().values():
        product = np.eye(4)
        for L in robot.links.L:
            product = product @ L
        assert np.abs(product - robot.M).max() < 1e-15


def test_frames_stand_on_the_axes_that_the_screws_say():
    rng = np.random.default_rng(3)
    robot = random_robot(rng, 5)
    for i, frame in enumerate(robot.links.at_zero[:-1]):
        along_z = [0, 0, 1, 0, 0, 0] if robot.joint_types[i] == "revolute" else [0, 0, 0, 0, 0, 1]
        assert np.abs(lie.adjoint(frame) @ along_z - robot.S[:, i]).max() < 1e-14


def test_nan_stays_in_its_configuration():
    robot = Robot.from_axes([[0, 0, 1], [0, 1, 0]], np.zeros((2, 3)), np.eye(4), "RP")
    theta = np.zeros((3, 2))
    theta[1, 0] = np.nan
    for many in (1, 100):
        T = robot.fk(np.tile(theta, (many, 1)))
        assert np.isnan(T[:, :3, 0]).any(axis=1).tolist() == [False, True, False] * many

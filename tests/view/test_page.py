"""The page's own functions, tested in node: what they compute needs no browser."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coursekit import Robot, ik, jacobians, lie, robots, view
from coursekit.view import marks, prediction
from coursekit.view.explorers.jacobians import arrow_at
from coursekit.view.script import STATIC

TESTS = Path(__file__).resolve().parents[1] / "page"


def in_node(*command, **more):
    node = shutil.which("node")
    if not node:
        (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)("node is not installed")
    done = subprocess.run([node, *command], capture_output=True, text=True, **more)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]
    return done


@pytest.mark.parametrize("path", sorted(TESTS.glob("*.test.mjs")), ids=lambda path: path.stem)
def test_in_node(path):
    in_node("--test", path)


# -- kinematics in the page: the numbers of Robot, to 1e-12

SLIDES = Robot.from_axes(
    [[0, 0, 1], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 0, 0.3], [0.2, 0, 0.3]], np.eye(4), "RPR", name="slide"
)
ARMS = [*robots.all().values(), SLIDES]
COMPUTE = """
import { describe, displacements, product, reachFor, shapesOf } from "%s";
const cases = JSON.parse(await new Promise((done) => {
  let text = "";
  process.stdin.on("data", (part) => (text += part)).on("end", () => done(text));
}));
const answer = ({ theta, ...arm }) => {
  const links = displacements(arm.screws, theta);
  const tool = product(links.at(-1), arm.M);
  return { links, tool, shapes: shapesOf(arm, links), words: describe(arm, theta) };
};
console.log(JSON.stringify(cases.map(answer)));
"""
FOLLOW = (
    COMPUTE[: COMPUTE.index("const answer")]
    + """
console.log(JSON.stringify(cases.map(({ screws, M, theta, goal }) => reachFor({ screws, M }, theta, goal))));
"""
)


def compute(script, cases):
    done = in_node(
        "--input-type=module", "-e", script % (STATIC / "kinematics.js").as_uri(), input=json.dumps(cases)
    )
    return json.loads(done.stdout)


def told(robot, theta):
    return {"screws": robot.S.T.tolist(), "M": robot.M.T.ravel().tolist(), "theta": theta.tolist()}


@pytest.fixture(scope="module")
def computed():
    """(robot, theta) and what the page's script makes of them."""
    rng, cases = np.random.default_rng(5), []
    for robot in ARMS:
        for theta in (robot.home, np.zeros(robot.n), 1e-9 * np.ones(robot.n), rng.uniform(-7, 7, robot.n)):
            cases.append((robot, theta))
    more = {"shapes": {"/v": ("linear", 0), "/linear": ("linear", 0.3), "/angular": ("angular", 0.1)}}
    found = compute(COMPUTE, [{"name": robot.name, **more, **told(robot, theta)} for robot, theta in cases])
    return list(zip(cases, found, strict=True))


def test_the_page_has_the_numbers_of_the_kernel(computed):
    for (robot, theta), found in computed:
        links = np.reshape(found["links"], (-1, 4, 4)).transpose(0, 2, 1)
        np.testing.assert_allclose(links, robot.displacements(theta), rtol=0, atol=1e-12)
        tool = np.reshape(found["tool"], (4, 4)).T
        np.testing.assert_allclose(tool, robot.fk(theta), rtol=0, atol=1e-12)


def placed(found, path):
    return np.reshape(found["shapes"][path], (4, 4)).T


def test_the_page_places_the_arrows_of_the_columns_as_the_kernel_does(computed):
    for (robot, theta), found in computed:
        tool = robot.fk(theta)[:3, 3]
        for k, v in enumerate(robot.jacobian_geometric(theta)[3:].T, 1):
            np.testing.assert_allclose(placed(found, f"/v/{k}"), arrow_at(v, tool), rtol=0, atol=1e-12)


@pytest.mark.parametrize(("part", "scale"), [("linear", 0.3), ("angular", 0.1)])
def test_the_page_places_the_ellipsoids_as_the_kernel_does(computed, part, scale):
    for (robot, theta), found in computed:
        J, tool = robot.jacobian_geometric(theta), robot.fk(theta)[:3, 3]
        e = jacobians.ellipsoid(J, part)
        kernels = marks.ellipsoid(e.axes, scale * e.lengths, tool, "trace", 0.3, 0.002)
        body, theirs = placed(found, f"/{part}/body"), kernels["body"][1]
        np.testing.assert_allclose(body[:3, 3], tool, rtol=0, atol=1e-12)
        assert np.linalg.det(body) > 0
        # the same surface x = A u, |u| = 1, whatever the order and the sense of its half axes
        np.testing.assert_allclose(body @ body.T, theirs @ theirs.T, rtol=0, atol=1e-12)
        half = body[:3, :3]
        np.testing.assert_allclose(half.T @ half, np.diag(np.diag(half.T @ half)), rtol=0, atol=1e-12)
        for k in range(3):
            rod = placed(found, f"/{part}/axis{k + 1}")[:3, :3]
            np.testing.assert_array_equal(rod[:, 2], half[:, k])
            np.testing.assert_allclose(rod[:, :2].T @ rod[:, :2], np.eye(2), rtol=0, atol=1e-12)
            assert np.linalg.det(rod) > 0


def test_the_page_says_it_in_the_words_of_the_kernel(computed):
    for (robot, theta), found in computed:
        scene = view.Scene()
        scene.robot(robot, theta)
        assert found["words"] == scene.text()


@pytest.mark.parametrize("robot", [robots.kuka_kr6(), robots.abb_irb1200()], ids=lambda robot: robot.name)
def test_in_the_page_every_solution_follows_a_target_on_its_own_branch(robot):
    """Where the closed form has it: the page steps there from the solution of the target before."""
    theta = np.array([0.6, -1.0, 1.2, 0.7, 0.8, 0.3])
    T = robot.fk(theta)
    before = ik.analytic(robot, T)
    for twist in ([0, 0, 0, 0.05, -0.02, 0.03], [0.1, -0.2, 0.1, 0, 0, 0], [0.05, 0.1, 0, 0.02, 0, 0.04]):
        goal = T @ lie.exp6(np.array(twist))
        after = ik.analytic(robot, goal)
        both = np.flatnonzero(before.exists & after.exists)
        assert len(both) >= 4
        moved = {"goal": goal.T.ravel().tolist()}
        found = compute(FOLLOW, [{**told(robot, before.theta[k]), **moved} for k in both])
        for k, one in zip(both, found, strict=True):
            assert one["far"] < 1e-5
            links = np.reshape(one["D"], (-1, 4, 4)).transpose(0, 2, 1)
            np.testing.assert_allclose(links, robot.displacements(after.theta[k]), rtol=0, atol=1e-4)


@pytest.mark.parametrize(
    "explorer", ["explore", "explore_screws", "explore_singularities", "explore_jacobians"]
)
def test_what_moves_with_the_arm_is_a_link_or_said_to_be_computed(explorer):
    panel = getattr(view, explorer)()
    sliders = [slider for slider in panel.drivers() if slider is not None]

    def drawn():
        commands = view.meshcat.commands(panel.scene)
        return {**commands, **{path: T.tolist() for path, T in panel.scene.moved.items()}}

    try:
        panel.refresh()
        before = drawn()
        told = panel.viewer.drive
        for slider in sliders:
            slider.show(slider.get() + 0.1)
        after = drawn()
        moved = {key.split("#")[0] for key in after if before.get(key) != after[key]}
        moved = {path for path in moved if not path.startswith(tuple(told["shapes"]))}  # by the page, too
        assert all(path.startswith(tuple(panel.computed or ["none"])) for path in moved)
        assert bool(moved) == bool(set(panel.computed) - {prediction.ROOT})  # nothing is asked now
    finally:
        panel.close()

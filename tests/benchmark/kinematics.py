"""How fast the kinematics is, beside the libraries of the field: one process, one thread, CPU time.

    python tests/benchmark/kinematics.py          (with the packages of requirements.txt in this folder)

Every line is measured five times, all lines in turn each time, because a machine is now faster and now
slower: what is printed are medians and ranges of the five. Microseconds per configuration of a KUKA KR6 and,
where a goal is set, the ratio to the peer, taken at the same moment. Peers that are not installed are left
out. Before that, the arms of tests/urdf are compared with pinocchio's reading of the same files.
Nothing in the test command reads this file.
"""

import os
import sys
import time
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from statistics import median

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np  # noqa: E402 (after the thread limits)

from coursekit import Robot, ik, lie, robots, singularity  # noqa: E402

RUNS = 5
ROBOT = robots.kuka_kr6()
RNG = np.random.default_rng(2026)
THETA = RNG.uniform(ROBOT.q_min, ROBOT.q_max, (10_000, 6))
POSES = ROBOT.fk(THETA)
URDFS = Path(__file__).resolve().parents[1] / "urdf"


@dataclass
class Line:
    """One line of the table: `run` handles `count` configurations, the peer's `run` so many of its own."""

    what: str
    run: Callable[[], object]
    count: int
    peer: str = ""
    peer_run: Callable[[], object] | None = None
    peer_count: int = 1
    goal: float | None = None
    own_times: list[float] = field(default_factory=list)
    peer_times: list[float] = field(default_factory=list)

    def measure(self):
        self.own_times.append(cost(self.run, self.count))
        if self.peer_run:
            self.peer_times.append(cost(self.peer_run, self.peer_count))

    def __str__(self):
        text = f"{self.what:<58}{spread(self.own_times)} us"
        if not self.peer_run:
            return text
        ratios = [peer / own for own, peer in zip(self.own_times, self.peer_times, strict=True)]
        text += f"   {self.peer}: {spread(self.peer_times)} us, ratio {spread(ratios)}"
        if self.goal is not None:
            reached = "reached" if median(ratios) >= self.goal else "NOT reached"
            text += f" (goal {self.goal:g}: {reached})"
        return text


def spread(values):
    """Median and range, in three figures."""
    low, middle, high = (f"{value:.3g}" for value in (min(values), median(values), max(values)))
    return f"{middle} ({low} to {high})"


def cost(function, count):
    """CPU time of `function()` in microseconds per item: the quicker of two calls."""
    times = []
    for _ in range(2):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return 1e6 * min(times) / count


def looped(function, items):
    """A call that handles one item at a time, as a loop over all of them."""

    def run():
        for item in items:
            function(item)

    return run


# -- peers: each returns functions on one configuration, or None where the package is not installed -------


def pinocchio():
    """Kinematic chain with the same axes. -> (forward kinematics, joint Jacobians) of one configuration."""
    try:
        import pinocchio as pin
    except ImportError:
        return None
    model, parent, origin = pin.Model(), 0, np.zeros(3)
    for i, s in enumerate(ROBOT.S.T):
        point = np.cross(s[:3], s[3:])
        placement = pin.SE3(np.eye(3), point - origin)
        parent = model.addJoint(parent, pin.JointModelRevoluteUnaligned(s[:3]), placement, f"joint{i + 1}")
        origin = point
    tool = pin.SE3(ROBOT.M[:3, :3], ROBOT.M[:3, 3] - origin)
    frame = model.addFrame(pin.Frame("tool", parent, tool, pin.FrameType.OP_FRAME))
    data = model.createData()

    def forward(q):
        pin.framesForwardKinematics(model, data, q)
        return data.oMf[frame].homogeneous

    def jacobian(q):
        return pin.computeJointJacobians(model, data, q)

    assert np.allclose(forward(THETA[0]), POSES[0], atol=1e-12), "pinocchio's model is another robot"
    return forward, jacobian


def toolbox():
    """roboticstoolbox's elementary transforms in C++. -> forward kinematics of a batch (N, 6)."""
    try:
        import roboticstoolbox as rtb
    except ImportError:
        return None
    table = ROBOT.standard_dh
    links = [
        rtb.RevoluteDH(a=a, alpha=alpha, d=d, offset=offset)
        for a, alpha, d, offset in zip(table.a, table.alpha, table.d, table.theta, strict=True)
    ]
    chain = rtb.DHRobot(links).ets()
    assert np.allclose(table.base @ chain.eval(THETA[:2]) @ table.tool, POSES[:2], atol=1e-9)
    return lambda: chain.eval(THETA)


def eaik():
    """EAIK's subproblem solver. -> all solutions of one pose."""
    try:
        from eaik.IK_HP import HPRobot
    except ImportError:
        return None
    points = [np.cross(s[:3], s[3:]) for s in ROBOT.S.T]
    points[3] = points[5] = points[4]  # the wrist centre lies on all three wrist axes
    steps = np.diff([np.zeros(3), *points, ROBOT.M[:3, 3]], axis=0)
    robot = HPRobot(ROBOT.S[:3].T, steps)
    return robot.IK


def modern_robotics():
    """The textbook's own code. -> the module."""
    try:
        import modern_robotics as mr
    except ImportError:
        return None
    return mr


# -- what is measured ---------------------------------------------------------------------------------------


def lines():
    """Every line of the table, with the peers that are installed."""
    pin, rtb, mr, solver = pinocchio(), toolbox(), modern_robotics(), eaik()
    n = len(THETA)

    def beside(line, peer, run=None, count=1, goal=None):
        if run:
            line.peer, line.peer_run, line.peer_count, line.goal = peer, run, count, goal
        return line

    fk = lambda: ROBOT.fk(THETA)  # noqa: E731
    space = lambda: ROBOT.jacobian_space(THETA)  # noqa: E731
    million = RNG.uniform(ROBOT.q_min, ROBOT.q_max, (1_000_000, 6))
    twists = RNG.normal(size=(n, 6))
    transforms = lie.exp6(twists)
    targets, guess = POSES[:100], ROBOT.home
    theta = np.zeros((200, 200, 6))
    theta[..., 1], theta[..., 2] = np.meshgrid(np.linspace(-3, 1, 200), np.linspace(-2, 2.5, 200))
    theta[..., 4] = 0.6
    damped = looped(lambda T: ik.damped_least_squares(ROBOT, T, guess), targets)
    textbook = mr and looped(lambda T: mr.IKinBody(ROBOT.B, ROBOT.M, T, guess, 1e-6, 1e-6), targets[:20])
    restarts = lambda: ik.damped_least_squares(  # noqa: E731
        ROBOT, POSES, guess, restarts=20, rng=np.random.default_rng(0)
    )
    forward, jacobian = pin or (None, None)
    return [
        beside(
            Line("forward kinematics, 10^4 at once", fk, n),
            "pinocchio, looped",
            forward and looped(forward, THETA),
            n,
            6,
        ),
        beside(Line("forward kinematics, 10^4 at once", fk, n), "roboticstoolbox's batch in C++", rtb, n, 3),
        Line("forward kinematics, 10^6 at once", lambda: ROBOT.fk(million), len(million)),
        beside(
            Line("forward kinematics, one at a time", looped(ROBOT.fk, THETA[:1000]), 1000),
            "Modern Robotics",
            mr and looped(lambda q: mr.FKinSpace(ROBOT.M, ROBOT.S, q), THETA[:100]),
            100,
        ),
        Line("link frames, 10^4 at once", lambda: ROBOT.link_frames(THETA), n),
        beside(
            Line("space Jacobian, 10^4 at once", space, n),
            "pinocchio, looped bare call",
            jacobian and looped(jacobian, THETA),
            n,
            2.5,
        ),
        Line("determinant over a map of 200 x 200", lambda: singularity.determinant(ROBOT, theta), 40_000),
        Line("exp6, 10^4 at once", lambda: lie.exp6(twists), n),
        Line("log6, 10^4 at once", lambda: lie.log6(transforms), n),
        beside(
            Line("analytic inverse, all eight, 10^4 at once", lambda: ik.analytic(ROBOT, POSES), n),
            "EAIK, a call per pose",
            solver and looped(solver, POSES[:2000]),
            2000,
            4,
        ),
        Line("Newton, one at a time", looped(lambda T: ik.newton(ROBOT, T, guess), targets), len(targets)),
        beside(Line("damped, one at a time", damped, len(targets)), "IKinBody", textbook, 20, 20),
        Line(f"damped, restarts, 10^4 targets ({100 * restarts().converged.mean():.2f} %)", restarts, n),
    ]


def urdfs():
    """The arms of tests/urdf against pinocchio's reading of the same files: largest difference of poses."""
    try:
        import pinocchio as pin
    except ImportError:
        return
    for path in sorted(URDFS.glob("*.urdf")):
        tip = "tcp_link" if path.stem == "franka_panda_hand" else None
        robot, model = Robot.from_urdf(path, tip), pin.buildModelFromUrdf(str(path))
        data, worst = model.createData(), 0.0
        frame = model.getFrameId(tip) if tip else model.nframes - 1
        for _ in range(100):
            q = RNG.uniform(-2, 2, robot.n)
            full = pin.neutral(model)
            for joint, angle in zip(list(model.joints)[1 : robot.n + 1], q, strict=True):
                endless = joint.nq == 2  # pinocchio keeps the cosine and sine of a joint without limits
                full[joint.idx_q : joint.idx_q + joint.nq] = (
                    (np.cos(angle), np.sin(angle)) if endless else angle
                )
            pin.framesForwardKinematics(model, data, full)
            worst = max(worst, np.abs(data.oMf[frame].homogeneous - robot.fk(q)).max())
        print(f"{path.name:<28} {robot.n} joints, {worst:.1e} from pinocchio")


def memory():
    """What a million forward kinematics need beyond their result."""
    million = RNG.uniform(ROBOT.q_min, ROBOT.q_max, (1_000_000, 6))
    tracemalloc.start()
    T = ROBOT.fk(million)
    peak = tracemalloc.get_traced_memory()[1] - T.nbytes
    tracemalloc.stop()
    print(f"peak memory of 10^6 forward kinematics beyond the result: {peak / 1e6:.1f} MB (goal 10 MB)")


def main():
    names = ("numpy", "pin", "roboticstoolbox-python", "EAIK", "modern_robotics")
    found = []
    for name in names:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} not installed")
    print(f"Python {sys.version.split()[0]}, {', '.join(found)}; one thread, CPU time, {RUNS} runs in turn\n")
    urdfs()
    memory()
    table = lines()
    for _ in range(RUNS):
        for line in table:
            line.measure()
    print("\n" + "\n".join(map(str, table)))


if __name__ == "__main__":
    main()

"""How fast the kinematics is, beside the libraries of the field: one process, one thread, CPU time, medians.

    python tests/benchmark/kinematics.py          (with the packages of requirements.txt in this folder)

Prints microseconds per configuration of a KUKA KR6 and, where a goal is set, the ratio to the peer. A
ratio is taken inside this process, so it means the same on a slow machine. Peers that are not installed are
left out.
Nothing in the test command reads this file.
"""

import os
import sys
import time
import tracemalloc
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np  # noqa: E402 (after the thread limits)

from coursekit import ik, lie, robots, singularity  # noqa: E402

REPEATS = 7
ROBOT = robots.kuka_kr6()
RNG = np.random.default_rng(2026)
THETA = RNG.uniform(ROBOT.q_min, ROBOT.q_max, (10_000, 6))
POSES = ROBOT.fk(THETA)


def cost(function, count):
    """Median CPU time of `function()` over REPEATS runs, in microseconds per item."""
    function()
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return 1e6 * sorted(times)[REPEATS // 2] / count


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


def report(what, own, peer=None, peer_name="", goal=None):
    ratio = f"{peer / own:8.1f}x" if peer else " " * 9
    target = (
        f"   goal {goal:g}x: {'reached' if peer / own >= goal else 'NOT reached'}" if goal and peer else ""
    )
    other = f"{peer:10.2f} {peer_name}" if peer else ""
    print(f"{what:<46}{own:10.3f} us{ratio}  {other}{target}")


def forward_kinematics():
    own = cost(lambda: ROBOT.fk(THETA), len(THETA))
    pin, rtb, mr = pinocchio(), toolbox(), modern_robotics()
    report("forward kinematics, 10^4 at once", own)
    if pin:
        report("  against a looped call", own, cost(looped(pin[0], THETA), len(THETA)), "pinocchio", 3.5)
    if rtb:
        report("  against a batch in C++", own, cost(rtb, len(THETA)), "roboticstoolbox", 1.8)
    if mr:
        one = cost(looped(lambda q: mr.FKinSpace(ROBOT.M, ROBOT.S, q), THETA[:200]), 200)
        report("  against a looped call", own, one, "Modern Robotics")
    report("forward kinematics, one at a time", cost(looped(ROBOT.fk, THETA[:1000]), 1000))
    million = RNG.uniform(ROBOT.q_min, ROBOT.q_max, (1_000_000, 6))
    large = cost(lambda: ROBOT.fk(million), len(million))
    report(f"forward kinematics, 10^6: {large / own:.2f} times the cost at 10^4 (goal 1.3)", large)
    tracemalloc.start()
    T = ROBOT.fk(million)
    peak = tracemalloc.get_traced_memory()[1] - T.nbytes
    tracemalloc.stop()
    print(f"  peak memory beyond the result: {peak / 1e6:.1f} MB (goal 10 MB)")
    report("link frames, 10^4 at once", cost(lambda: ROBOT.link_frames(THETA), len(THETA)))


def jacobians():
    own, pin = cost(lambda: ROBOT.jacobian_space(THETA), len(THETA)), pinocchio()
    report("space Jacobian, 10^4 at once", own)
    if pin:
        report("  against a looped bare call", own, cost(looped(pin[1], THETA), len(THETA)), "pinocchio", 1.5)
    theta = np.zeros((200, 200, 6))
    theta[..., 1], theta[..., 2] = np.meshgrid(np.linspace(-3, 1, 200), np.linspace(-2, 2.5, 200))
    theta[..., 4] = 0.6
    milliseconds = cost(lambda: singularity.determinant(ROBOT, theta), 1) / 1000
    print(f"determinant over a 200 x 200 map: {milliseconds:.1f} ms (goal 25 ms)")
    twists = RNG.normal(size=(10_000, 6))
    transforms = lie.exp6(twists)
    report("exp6, 10^4 at once", cost(lambda: lie.exp6(twists), len(twists)))
    report("log6, 10^4 at once", cost(lambda: lie.log6(transforms), len(twists)))


def inverse_kinematics():
    own, solver, mr = cost(lambda: ik.analytic(ROBOT, POSES), len(POSES)), eaik(), modern_robotics()
    report("analytic, all eight, with limits, 10^4 at once", own)
    if solver:
        report("  against a call per pose", own, cost(looped(solver, POSES[:2000]), 2000), "EAIK", 3)
    targets, guess = POSES[:300], ROBOT.home
    solved = [ik.newton(ROBOT, T, guess).converged for T in targets]
    one = cost(looped(lambda T: ik.newton(ROBOT, T, guess), targets), len(targets))
    report(f"Newton, one at a time, {100 * np.mean(solved):.1f} % from home", one)
    damped = [ik.damped_least_squares(ROBOT, T, guess).converged for T in targets]
    one = cost(looped(lambda T: ik.damped_least_squares(ROBOT, T, guess), targets), len(targets))
    report(f"damped, one at a time, {100 * np.mean(damped):.1f} % from home (goal 97 %)", one)
    if mr:
        textbook = lambda T: mr.IKinBody(ROBOT.B, ROBOT.M, T, guess, 1e-6, 1e-6)  # noqa: E731
        right = 100 * np.mean([textbook(T)[1] for T in targets[:100]])
        peer = cost(looped(textbook, targets[:100]), 100)
        report("  against its IKinBody", one, peer, f"Modern Robotics ({right:.0f} %)", 20)
    solve = lambda: ik.damped_least_squares(ROBOT, POSES, guess, restarts=20, rng=np.random.default_rng(0))  # noqa: E731
    found = solve().converged.mean()
    report(
        f"damped, restarts, 10^4 targets, {100 * found:.2f} % (goals 100 %, 20 us)", cost(solve, len(POSES))
    )


def main():
    names = ("numpy", "pin", "roboticstoolbox-python", "EAIK", "modern_robotics")
    found = []
    for name in names:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} not installed")
    print(
        f"Python {sys.version.split()[0]}, {', '.join(found)}; one thread, CPU time, medians of {REPEATS}\n"
    )
    forward_kinematics()
    jacobians()
    inverse_kinematics()


if __name__ == "__main__":
    main()

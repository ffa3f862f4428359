"""What a function may be given: poses and rotations that are none say which condition fails."""

import numpy as np
import pytest

from coursekit import lie
from coursekit.kinematics import checks

POSE = lie.exp6([0.1, 0.2, 0.3, 1, 2, 3])


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_poses_pass_as_they_are(shape):
    T = np.broadcast_to(POSE, (*shape, 4, 4))
    assert np.array_equal(checks.pose(T, "T"), T)
    assert np.array_equal(checks.rotation(T[..., :3, :3], "R"), T[..., :3, :3])


def test_one_bad_pose_in_a_batch_is_found():
    T = np.tile(POSE, (5, 1, 1))
    T[3, 0, 0] += 1e-3
    with pytest.raises(ValueError, match=r"T_sb is not in SE\(3\): R'R differs from the identity by 0\.0"):
        checks.pose(T, "T_sb")


@pytest.mark.parametrize(
    "change, message",
    [
        (np.diag([1, 1, -1, 1]), r"T is not in SE\(3\): det R = -1, so R is a reflection"),
        (np.diag([1, 1, 1, 2]), r"T is not in SE\(3\): its last row must be 0 0 0 1"),
        (1.1 * np.eye(4), r"T is not in SE\(3\): R'R differs from the identity by 0\.21"),
        (np.eye(3), r"T must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        ([["a"]], r"T must be an array of real numbers of shape \(\.\.\., 4, 4\)"),
    ],
)
def test_what_is_no_pose(change, message):
    with pytest.raises(ValueError, match=message):
        checks.pose(change, "T")


def test_what_is_no_rotation():
    with pytest.raises(ValueError, match=r"R is not in SO\(3\): det R = -1"):
        checks.rotation(np.diag([1, 1, -1]), "R")
    with pytest.raises(ValueError, match=r"R must have shape \(\.\.\., 3, 3\), got \(4, 4\)"):
        checks.rotation(POSE, "R")


def test_rounding_is_no_error_and_nan_passes_in_silence():
    checks.pose(POSE + 1e-8, "T")
    T = np.stack([POSE, np.full((4, 4), np.nan)])
    assert np.isnan(checks.pose(T, "T")[1]).all()
    assert np.isnan(checks.rotation(T[:, :3, :3], "R")[1]).all()


def test_frozen_is_a_copy():
    value = np.zeros(3)
    copy = checks.frozen(value, "w", (3,))
    value[0] = 1
    assert copy.tolist() == [0, 0, 0]
    assert not copy.flags.writeable
    with pytest.raises(ValueError, match="w must have shape"):
        checks.frozen(np.zeros((2, 3)), "w", (3,))

"""The groups SO(3) and SE(3): hat, vee, exp, log, inverse, adjoint. Every function takes batches.

Twists are ordered (omega; v). Formulas: Lynch & Park, Modern Robotics (2017), chapter 3; the forms used here
keep 14 digits from 1e-12 rad to pi, because no small number is ever the difference of two large ones.
"""

import numpy as np
from numpy.typing import ArrayLike

from . import checks
from .rotations import quaternion

SMALL = 1e-2  # rad; below it (1 - sin t / t) / t^2 loses digits, and three terms of its series have them all


def hat3(w: ArrayLike) -> np.ndarray:
    """[w]: the matrix with [w] x = w cross x. w (..., 3) -> (..., 3, 3). Eq. 3.30.

    >>> hat3([1, 2, 3]).tolist()
    [[0.0, -3.0, 2.0], [3.0, 0.0, -1.0], [-2.0, 1.0, 0.0]]
    """
    w = checks.array(w, (3,), "w")
    W = np.zeros((*w.shape, 3))
    W[..., 2, 1], W[..., 0, 2], W[..., 1, 0] = w[..., 0], w[..., 1], w[..., 2]
    return W - np.swapaxes(W, -1, -2)


def vee3(W: ArrayLike) -> np.ndarray:
    """w of a skew-symmetric [w]. W (..., 3, 3) -> (..., 3).

    >>> vee3(hat3([1, 2, 3])).tolist()
    [1.0, 2.0, 3.0]
    """
    W = checks.array(W, (3, 3), "W")
    return np.stack([W[..., 2, 1], W[..., 0, 2], W[..., 1, 0]], axis=-1)


def hat6(xi: ArrayLike) -> np.ndarray:
    """[xi]: the 4x4 matrix of a twist. xi (..., 6) = (omega; v) -> (..., 4, 4). Eq. 3.71.

    >>> hat6([0, 0, 1, 4, 5, 6]).tolist()
    [[0.0, -1.0, 0.0, 4.0], [1.0, 0.0, 0.0, 5.0], [0.0, 0.0, 0.0, 6.0], [0.0, 0.0, 0.0, 0.0]]
    """
    xi = checks.array(xi, (6,), "xi")
    X = np.zeros((*xi.shape[:-1], 4, 4))
    X[..., :3, :3], X[..., :3, 3] = hat3(xi[..., :3]), xi[..., 3:]
    return X


def vee6(X: ArrayLike) -> np.ndarray:
    """xi of [xi]. X (..., 4, 4) -> (..., 6) = (omega; v).

    >>> vee6(hat6([1, 2, 3, 4, 5, 6])).tolist()
    [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    """
    X = checks.array(X, (4, 4), "X")
    return np.concatenate([vee3(X[..., :3, :3]), X[..., :3, 3]], axis=-1)


def exp3(w: ArrayLike) -> np.ndarray:
    """Rotation by |w| rad about w (Rodrigues). w (..., 3) -> R (..., 3, 3). Eq. 3.51.

    R = I + sin t / t [w] + (1 - cos t) / t^2 [w]^2, where t = |w|.

    >>> exp3([0, 0, np.pi / 2]).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    w = checks.array(w, (3,), "w")
    W, (A, B, _) = hat3(w), _exp_coefficients(w)
    return np.eye(3) + A * W + B * (W @ W)


def exp6(xi: ArrayLike) -> np.ndarray:
    """Pose that the twist xi reaches after unit time. xi (..., 6) = (omega; v) -> T (..., 4, 4). Eq. 3.88.

    R = exp3(omega) and p = (I + (1 - cos t) / t^2 [w] + (t - sin t) / t^3 [w]^2) v, where t = |omega|.
    For a joint: T = exp6(S * theta). A twist with omega = 0 is a pure translation by v.

    >>> exp6([0, 0, np.pi, 0, -np.pi, 0]).round(12)[:3, 3].tolist()      # half a turn about the line x = 1
    [2.0, 0.0, 0.0]
    """
    xi = checks.array(xi, (6,), "xi")
    w, v = xi[..., :3], xi[..., 3:, None]
    W, (A, B, C) = hat3(w), _exp_coefficients(w)
    W2 = W @ W
    T = np.zeros((*xi.shape[:-1], 4, 4))
    T[..., :3, :3] = np.eye(3) + A * W + B * W2
    T[..., :3, 3] = (v + B * (W @ v) + C * (W2 @ v))[..., 0]
    T[..., 3, 3] = 1
    return T


def _exp_coefficients(w):
    """A = sin t / t, B = (1 - cos t) / t^2, C = (t - sin t) / t^3 for t = |w|, each (..., 1, 1)."""
    t = np.sqrt((w * w).sum(axis=-1))[..., None, None]
    A = np.sinc(t / np.pi)
    B = 0.5 * np.sinc(t / (2 * np.pi)) ** 2  # half angles: 1 - cos t = 2 sin^2(t / 2)
    small = t < SMALL
    t2 = np.where(small, 1.0, t * t)
    C = np.where(small, 1 / 6 - t**2 / 120 + t**4 / 5040, (1 - A) / t2)
    return A, B, C


def log3(R: ArrayLike) -> np.ndarray:
    """w with exp3(w) = R and |w| <= pi: the angle-axis product. R (..., 3, 3) -> (..., 3). Section 3.2.3.3.

    Taken from the quaternion, never from arccos(trace): exact to rounding at 0 and at pi too. At a half turn
    both w and -w are right; the first component that is not 0 is positive.

    >>> log3(exp3([0.1, 0.2, 0.3])).round(12).tolist()
    [0.1, 0.2, 0.3]
    """
    q = quaternion(R)
    w, v = q[..., :1], q[..., 1:]
    half_sine = np.sqrt((v * v).sum(axis=-1, keepdims=True))
    safe = np.where(half_sine == 0, 1.0, half_sine)
    return v * np.where(half_sine == 0, 2.0, 2 * np.arctan2(half_sine, w) / safe)


def slerp(R_0: ArrayLike, R_1: ArrayLike, t: ArrayLike) -> np.ndarray:
    """On the short way from one attitude to another, by one turn at constant speed: R_0 e^[t log(R_0^T R_1)].

    Half a turn apart there are two short ways: that of `log3` is taken. Source: Lynch & Park, section 9.2.1.

    Parameters
    ----------
    R_0, R_1 : (..., 3, 3)
    t : (...), from 0 to 1

    Returns
    -------
    R : (..., 3, 3)

    Examples
    --------
    >>> half = slerp(np.eye(3), exp3([0, 0, 1.0]), 0.5)
    >>> log3(half).round(12).tolist()
    [0.0, 0.0, 0.5]
    """
    R_0, R_1 = checks.rotation(R_0, "R_0"), checks.rotation(R_1, "R_1")
    left = log3(np.swapaxes(R_0, -1, -2) @ R_1)
    return R_0 @ exp3(left * checks.array(t, (), "t")[..., None])


def log6(T: ArrayLike) -> np.ndarray:
    """xi with exp6(xi) = T and |omega| <= pi. T (..., 4, 4) -> (..., 6) = (omega; v). Eqs. 3.90-3.92.

    v = (I - 1/2 [w] + D [w]^2) p, where t = |w| and D = (1 - t/2 cot(t/2)) / t^2.

    >>> log6(exp6([0.1, 0.2, 0.3, 4, 5, 6])).round(12).tolist()
    [0.1, 0.2, 0.3, 4.0, 5.0, 6.0]
    """
    T = checks.array(T, (4, 4), "T")
    w, p = log3(T[..., :3, :3]), T[..., :3, 3, None]
    W, t = hat3(w), np.sqrt((w * w).sum(axis=-1))[..., None, None]
    small = t < SMALL
    half = np.where(small, 1.0, 0.5 * t)
    D = (1 - half * np.cos(half) / np.sin(half)) / (4 * half * half)
    D = np.where(small, 1 / 12 + t**2 / 720 + t**4 / 30240, D)
    v = p - 0.5 * (W @ p) + D * (W @ (W @ p))
    return np.concatenate([w, v[..., 0]], axis=-1)


def inverse(T: ArrayLike) -> np.ndarray:
    """T_ba of T_ab, without a matrix inversion. T (..., 4, 4) -> (..., 4, 4). Eq. 3.64.

    >>> inverse([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])[:3, 3].tolist()
    [-2.0, 1.0, -3.0]
    """
    T = checks.array(T, (4, 4), "T")
    Rt = np.swapaxes(T[..., :3, :3], -1, -2)
    result = np.zeros_like(T)
    result[..., :3, :3] = Rt
    result[..., :3, 3] = -(Rt @ T[..., :3, 3, None])[..., 0]
    result[..., 3, 3] = 1
    return result


def adjoint(T: ArrayLike) -> np.ndarray:
    """[Ad_T]: maps a twist in frame b to frame a, for T = T_ab. T (..., 4, 4) -> (..., 6, 6). Eq. 3.83.

    [Ad_T] = [[R, 0], [[p] R, R]] for twists (omega; v).

    >>> (adjoint([[1, 0, 0, 0], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 0, 1]]) @ [0, 0, 1, 0, 0, 0]).tolist()
    [0.0, 0.0, 1.0, 2.0, 0.0, 0.0]
    """
    T = checks.array(T, (4, 4), "T")
    R = T[..., :3, :3]
    Ad = np.zeros((*T.shape[:-2], 6, 6))
    Ad[..., :3, :3] = Ad[..., 3:, 3:] = R
    Ad[..., 3:, :3] = hat3(T[..., :3, 3]) @ R
    return Ad

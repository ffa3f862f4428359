"""The matrices of kinematics in sympy: turns, poses, adjoints, e^[S]theta and DH links, all exact."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import sympy as sp
else:

    class _Sympy:
        """sympy, once something is asked of it: of all that a notebook names it takes longest to import."""

        def __getattr__(self, name):
            import sympy

            return getattr(sympy, name)

    sp = _Sympy()

Scalar: TypeAlias = "sp.Expr | float"


def rotx(angle: Scalar) -> sp.Matrix:
    """Turn by an angle about x, a (3, 3) Matrix.

    >>> rotx(sp.pi / 2)
    Matrix([
    [1, 0,  0],
    [0, 0, -1],
    [0, 1,  0]])
    """
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]])


def roty(angle: Scalar) -> sp.Matrix:
    """Turn by an angle about y, a (3, 3) Matrix.

    >>> roty(sp.pi / 2)[:, 0].T
    Matrix([[0, 0, -1]])
    """
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def rotz(angle: Scalar) -> sp.Matrix:
    """Turn by an angle about z, a (3, 3) Matrix.

    >>> rotz(sp.pi / 2)[:, 0].T
    Matrix([[0, 1, 0]])
    """
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def xyx(a: Scalar, b: Scalar, c: Scalar) -> sp.Matrix:
    """R_x(a) R_y(b) R_x(c): a wrist whose axes are x, y, x. TPK4170 report 2021, eq. 4.17.

    Parameters
    ----------
    a, b, c : expressions, rad

    Returns
    -------
    R : (3, 3) Matrix

    Examples
    --------
    >>> a, b, c = sp.symbols("a b c")
    >>> xyx(a, b, c)[1, 1]
    -sin(a)*sin(c)*cos(b) + cos(a)*cos(c)
    """
    return rotx(a) * roty(b) * rotx(c)


def pose(R: sp.Matrix | None = None, p: Iterable[Scalar] = (0, 0, 0)) -> sp.Matrix:
    """The (4, 4) Matrix of a rotation R and a position p.

    >>> pose(p=(1, 2, 3))[:3, 3].T
    Matrix([[1, 2, 3]])
    """
    T = sp.eye(4)
    T[:3, :3] = sp.eye(3) if R is None else R
    T[:3, 3] = sp.Matrix(p)
    return T


def inverse(T: sp.Matrix) -> sp.Matrix:
    """T^-1 = [[R', -R' p], [0, 1]], (4, 4).

    >>> inverse(pose(rotz(sp.pi / 2), (1, 2, 3)))[:3, 3].T
    Matrix([[-2, 1, -3]])
    """
    R, p = T[:3, :3], T[:3, 3]
    return pose(R.T, -R.T * p)


def adjoint(T: sp.Matrix) -> sp.Matrix:
    """[Ad_T] = [[R, 0], [[p] R, R]] for twists (omega; v), a (6, 6) Matrix.

    >>> (adjoint(pose(p=(0, 2, 0))) * sp.Matrix([0, 0, 1, 0, 0, 0])).T
    Matrix([[0, 0, 1, 2, 0, 0]])
    """
    R, p = T[:3, :3], T[:3, 3]
    return sp.Matrix(sp.BlockMatrix([[R, sp.zeros(3, 3)], [hat3(p) * R, R]]))


def hat3(w: Iterable[Scalar]) -> sp.Matrix:
    """[w]: the matrix with [w] x = w cross x, (3, 3).

    >>> hat3([1, 2, 3]) * sp.Matrix([0, 0, 1])
    Matrix([
    [ 2],
    [-1],
    [ 0]])
    """
    x, y, z = w
    return sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def screw_exp(S: Iterable[Scalar], theta: Scalar) -> sp.Matrix:
    """e^[S]theta of a unit screw S = (omega; v), a hinge or a slide: a (4, 4) Matrix.

    R = I + sin(theta) [w] + (1 - cos(theta)) [w]^2 and
    p = (theta I + (1 - cos(theta)) [w] + (theta - sin(theta)) [w]^2) v. Lynch & Park, eqs. 3.51 and 3.88.

    >>> t, l = sp.symbols("theta l")
    >>> screw_exp([0, 0, 1, 0, -l, 0], t)[:2, 3].T
    Matrix([[l*(1 - cos(theta)), -l*sin(theta)]])
    """
    screw = sp.Matrix(S)
    W, v = hat3(screw[:3]), sp.Matrix(screw[3:])
    sine, versine = sp.sin(theta), 1 - sp.cos(theta)
    R = sp.eye(3) + sine * W + versine * W**2
    p = (theta * sp.eye(3) + versine * W + (theta - sine) * W**2) * v
    # What is left of theta itself (a hinge has no term in it) cancels when the entry is expanded.
    return pose(R.applyfunc(sp.expand), p.applyfunc(lambda e: sp.collect(sp.expand(e), screw.free_symbols)))


def half_steps(a: Scalar, alpha: Scalar, d: Scalar, theta: Scalar) -> tuple[sp.Matrix, sp.Matrix]:
    """The two halves of a DH link: about and along z, then about and along x.

    TPK4170 report 2021, eqs. 2.2 and 2.3.

    Parameters
    ----------
    a, alpha, d, theta : expressions, rad and m

    Returns
    -------
    two (4, 4) Matrices

    Examples
    --------
    >>> along_z, along_x = half_steps(*sp.symbols("a alpha d theta"))
    >>> along_z[:3, 3].T, along_x[:3, 3].T
    (Matrix([[0, 0, d]]), Matrix([[a, 0, 0]]))
    """
    return pose(rotz(theta), (0, 0, d)), pose(rotx(alpha), (a, 0, 0))


def dh_matrix(a: Scalar, alpha: Scalar, d: Scalar, theta: Scalar, convention: str = "standard") -> sp.Matrix:
    """A_i of one DH row.

    Raises ValueError for another convention. Siciliano et al., eq. 2.52; Lynch & Park, appendix C.

    Parameters
    ----------
    a, alpha, d, theta : expressions, rad and m
    convention : "standard": z then x; "modified": x then z, with a and alpha of the row before

    Returns
    -------
    A : (4, 4) Matrix

    Examples
    --------
    >>> a, d, theta = sp.symbols("a d theta")
    >>> dh_matrix(a, sp.pi / 2, d, theta)[0, :]
    Matrix([[cos(theta), 0, sin(theta), a*cos(theta)]])
    """
    along_z, along_x = half_steps(a, alpha, d, theta)
    if convention not in ("standard", "modified"):
        raise ValueError(f"convention must be 'standard' or 'modified', got {convention!r}")
    return along_z * along_x if convention == "standard" else along_x * along_z


def turn(w: Iterable[Scalar], angle: Scalar) -> sp.Matrix:
    """Rotation by an angle about the unit vector w, (3, 3).

    >>> turn([0, 0, 1], sp.pi / 2)[:, 0].T
    Matrix([[0, 1, 0]])
    """
    return screw_exp([*w, 0, 0, 0], angle)[:3, :3]

"""The data sheets: each robot with every form that their sources allow, and where each number comes from.

Screws are read off the drawing (a direction and a point per axis); DH tables are the published ones. That
both describe the same arm is not assumed here: the tests compare them. Lengths are written in millimetres and
angles in degrees where the sheet does so.
"""

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from . import dh
from .robot import Robot

X, Y, Z = np.eye(3)


class Catalogue(Mapping[str, Robot]):
    """{name: Robot}: a robot is made when it is first asked for."""

    def __init__(self, *makers: Callable[[], Robot]) -> None:
        self._makers = {make.__name__: make for make in makers}
        self._made: dict[str, Robot] = {}

    def __getitem__(self, name: str) -> Robot:
        if name not in self._made:
            self._made[name] = self._makers[name]()
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


def all() -> Catalogue:
    """Every robot of the catalogue by the name of its function. -> {name: Robot}

    >>> all()["abb_irb1200"].name
    'ABB IRB 1200-5/0.9'
    """
    return Catalogue(
        kuka_kr6,
        abb_irb1200,
        kuka_kr10,
        kuka_kr10_report,
        franka_panda,
        kawasaki_s030,
        planar_2r,
        puma560,
        ur5,
        scara,
        stanford,
    )


def kuka_kr6() -> Robot:
    """KUKA KR6 R900 sixx (Agilus): 6R, spherical wrist, joints 1, 4 and 6 about -z, -x and -x.

    Source: TPK4170 report 2021, table 3.1 and eq. 3.5; limits and speeds: KUKA's data as in the
    ROS-Industrial description kr6r900sixx.

    >>> kuka_kr6().M[:3, 3].tolist()
    [0.98, 0.0, 0.435]
    """
    sheet = _Agilus(upper_arm=455, elbow_offset=35, forearm=420, flange=80)
    limits_deg = [(-170, 170), (-190, 45), (-120, 156), (-185, 185), (-120, 120), (-350, 350)]
    return sheet.robot(
        "KUKA KR6 R900 sixx",
        limits=np.radians(limits_deg),
        v_max=np.radians([360, 300, 360, 381, 388, 615]),
        source="TPK4170 report 2021, table 3.1, eqs. 3.2-3.5; limits and speeds: ROS-Industrial kr6r900sixx",
        discrepancies=(
            "The report's eq. 3.6 prints B for the wrist centre (x = 900 mm), not for the flange (980 mm).",
            "The report's eq. 3.7 prints M with 900 mm; its figure 3.6 was computed with 980 mm.",
            "The home pose (0, -90, 90, 0, 0, 0) deg is KUKA's custom and not in the report.",
        ),
    )


def kuka_kr10() -> Robot:
    """KUKA KR10 R1100-2, the true robot: the forearm is offset 25 mm upwards, perpendicular to itself.

    Source: KUKA's data sheet (limits, reach 1101 mm) and the public description kr10_r1100_2.

    >>> kuka_kr10().M[:3, 3].round(3).tolist()
    [1.19, 0.0, 0.425]
    """
    sheet = _Agilus(upper_arm=560, elbow_offset=25, forearm=515, flange=90)
    return sheet.robot(
        "KUKA KR10 R1100-2",
        limits=_KR10_LIMITS,
        v_max=_KR10_SPEEDS,
        source="KUKA KR10 R1100-2 data sheet; public URDF description kr10_r1100_2",
        discrepancies=(
            "The Innopolis assignment 3 (2020) lays the 25 mm along the forearm: kuka_kr10_report.",
            "The older KR10 R1100 sixx (35 mm offset, 80 mm flange) is another robot.",
        ),
    )


def kuka_kr10_report() -> Robot:
    """The KR10 as the Innopolis assignment 3 (2020) models it: a straight forearm of 25 + 515 = 540 mm.

    Its reach would be 1125 mm; the true robot's is 1101 mm. Joints 1, 4 and 6 turn about +z, +x and +x.

    >>> kuka_kr10_report().M[:3, 3].round(3).tolist()
    [1.215, 0.0, 0.4]
    """
    q_mm = [(0, 0, 400), (25, 0, 400), (585, 0, 400), (610, 0, 400), (1125, 0, 400), (1125, 0, 400)]
    return Robot.from_axes(
        [Z, Y, Y, X, Y, X],
        np.array(q_mm) / 1000,
        _pose(np.eye(3), (1215, 0, 400)),
        name="KUKA KR10 R1100-2 (model of the report)",
        **_limits(_KR10_LIMITS),
        v_max=_KR10_SPEEDS,
        source="Innopolis assignment 3 (2020), sections 2 and 3; lengths and limits: the author's repository",
        discrepancies=("The true robot carries the 25 mm offset perpendicular to the forearm: kuka_kr10.",),
    )


def abb_irb1200() -> Robot:
    """ABB IRB 1200-5/0.9: 6R, spherical wrist, upright at zero.

    Source: RPI mini project 3 (2021) for the frames, ROS-Industrial irb1200_5_90 for the numbers.

    >>> abb_irb1200().M[:3, 3].tolist()
    [0.533, 0.0, 0.8891]
    """
    quarter = np.pi / 2
    table = dh.Table(
        a=np.array([0, 448, 42, 0, 0, 0]) / 1000,
        alpha=[-quarter, 0, -quarter, quarter, -quarter, 0],
        d=np.array([399.1, 0, 0, 451, 0, 82]) / 1000,
        theta=[0, -quarter, 0, 0, 0, 0],
        tool=_pose(np.array([Z, -Y, X]), (0, 0, 0)),
    )
    q_mm = [(0, 0, 399.1), (0, 0, 399.1), (0, 0, 847.1), (451, 0, 889.1), (451, 0, 889.1), (451, 0, 889.1)]
    return Robot.from_axes(
        [Z, Y, Y, X, Y, X],
        np.array(q_mm) / 1000,
        _pose(np.eye(3), (533, 0, 889.1)),
        name="ABB IRB 1200-5/0.9",
        standard_dh=table,
        q_min=[-2.967, -1.745, -3.491, -4.712, -2.269, -6.283],
        q_max=[2.967, 2.269, 1.222, 4.712, 2.269, 6.283],
        v_max=[5.027, 4.189, 5.236, 6.981, 7.069, 10.472],
        source="RPI mini project 3 (2021), problem 2; lengths, limits, speeds: ROS-Industrial irb1200_5_90",
        discrepancies=(
            "The project uses a flat bound of 2 rad/s for every joint instead of the robot's own speeds.",
            "350 and 351 mm, found in the project's code, belong to the IRB 1200-7/0.7.",
        ),
    )


def franka_panda() -> Robot:
    """Franka Emika Panda: 7R, redundant, no spherical wrist (88 mm between axes 6 and 7). Tool: the flange.

    Source: Franka's modified DH table (franka_ros); the Panda programming assignment gives no numbers.

    >>> franka_panda().M[:3, 3].tolist()
    [0.088, 0.0, 0.926]
    """
    quarter = np.pi / 2
    table = dh.Table(
        a=np.array([0, 0, 0, 82.5, -82.5, 0, 88]) / 1000,
        alpha=[0, -quarter, quarter, quarter, -quarter, quarter, quarter],
        d=np.array([333, 0, 316, 0, 384, 0, 107]) / 1000,
        theta=np.zeros(7),
        convention="modified",
    )
    q_mm = [(0, 0, 333), (0, 0, 333), (0, 0, 649), (82.5, 0, 649), (0, 0, 1033), (0, 0, 1033), (88, 0, 1033)]
    return Robot.from_axes(
        [Z, Y, Z, -Y, Z, -Y, -Z],
        np.array(q_mm) / 1000,
        _pose(np.diag([1, -1, -1]), (88, 0, 926)),
        name="Franka Emika Panda",
        modified_dh=table,
        q_min=[-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973],
        q_max=[2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973],
        v_max=[2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61],
        home=[0, -quarter / 2, 0, -3 * quarter / 2, 0, quarter, quarter / 2],
        source="franka_ros: franka_arm.xacro and joint_limits.yaml; home pose: Franka's ready pose",
        discrepancies=("theta = 0 lies outside the limits of joint 4 (-3.0718 to -0.0698 rad).",),
    )


def kawasaki_s030() -> Robot:
    """Kawasaki S030: 6R, spherical wrist, every twist angle 0 or +90 deg.

    Source: Robotics I exam, 17 June 2019, table 1; its speeds of joints 1 to 3, the wrist's are not given.

    >>> (kawasaki_s030().fk(kawasaki_s030().home).round(3) + 0.0)[:3, 3].tolist()
    [1.395, 0.0, 1.55]
    """
    quarter = np.pi / 2
    table = dh.Table(
        a=np.array([150, 870, 0, 0, 0, 0]) / 1000,
        alpha=[quarter, 0, quarter, quarter, quarter, 0],
        d=np.array([680, 0, 0, 1080, 0, 165]) / 1000,
        theta=np.zeros(6),
    )
    q_mm = [(0, 0, 680), (150, 0, 680), (1020, 0, 680), (1020, 0, -400), (1020, 0, -400), (1020, 0, -400)]
    limits_deg = [(-180, 180), (-50, 195), (-65, 225), (-360, 360), (35, 325), (-360, 360)]
    return Robot.from_axes(
        [Z, -Y, -Y, -Z, Y, Z],
        np.array(q_mm) / 1000,
        _pose(np.eye(3), (1020, 0, -235)),
        name="Kawasaki S030",
        standard_dh=table,
        **_limits(np.radians(limits_deg)),
        v_max=[*np.radians([180, 180, 185]), np.nan, np.nan, np.nan],
        home=[0, quarter, 0, 2 * quarter, 2 * quarter, 0],
        source="Robotics I exam, 17 June 2019, table 1 and exercise 1e",
        discrepancies=(
            "Table 1 calls the flange length d_4 a second time; it is d_6 = 165 mm.",
            "The exam rejects theta_2 = -174.72 deg; one turn further, 185.28 deg, is inside -50 to 195 deg.",
            "The joint ranges come from a maker's sheet that is not part of the exam text.",
        ),
    )


def planar_2r(l1: float = 0.5, l2: float = 0.25) -> Robot:
    """A planar arm with two hinges about z and links l1, l2 in metres. Source: the same exam, exercise 2.

    Raises ValueError where a length is not positive.

    >>> planar_2r(1.0, 0.8).M[:3, 3].tolist()
    [1.8, 0.0, 0.0]
    """
    for name, length in (("l1", l1), ("l2", l2)):
        if not length > 0:
            raise ValueError(f"planar_2r: {name} must be a positive length in metres, got {length}")
    table = dh.Table(a=[l1, l2], alpha=[0, 0], d=[0, 0], theta=[0, 0])
    return Robot.from_dh(
        table,
        name="planar 2R",
        q_min=[-np.pi, -np.pi],
        q_max=[np.pi, np.pi],
        home=[np.pi / 4, -np.pi / 2],
        source="Robotics I exam, 17 June 2019, exercise 2",
    )


def puma560() -> Robot:
    """PUMA 560: 6R, spherical wrist, 150 mm shoulder offset. Practice robot.

    Source: Corke's table as in robotics-toolbox-python, models.DH.Puma560.

    >>> puma560().M[:3, 3].round(5).tolist()
    [0.4521, -0.15005, 1.10363]
    """
    quarter = np.pi / 2
    table = dh.Table(
        a=np.array([0, 431.8, 20.3, 0, 0, 0]) / 1000,
        alpha=[quarter, 0, -quarter, quarter, -quarter, 0],
        d=np.array([671.83, 0, 150.05, 431.8, 0, 0]) / 1000,
        theta=np.zeros(6),
    )
    wrist = (452.1, -150.05, 1103.63)
    q_mm = [(0, 0, 671.83), (0, 0, 671.83), (431.8, 0, 671.83), wrist, wrist, wrist]
    limits_deg = [(-160, 160), (-45, 225), (-225, 45), (-110, 170), (-100, 100), (-266, 266)]
    return Robot.from_axes(
        [Z, -Y, -Y, Z, -Y, Z],
        np.array(q_mm) / 1000,
        _pose(np.eye(3), wrist),
        name="PUMA 560",
        standard_dh=table,
        **_limits(np.radians(limits_deg)),
        source="robotics-toolbox-python, models.DH.Puma560",
    )


def ur5() -> Robot:
    """Universal Robots UR5: 6R, no spherical wrist, axes 2, 3 and 4 parallel. Practice robot.

    Source: robotics-toolbox-python, models.DH.UR5; limits of 360 deg and 180 deg/s from UR's own description.

    >>> ur5().M[:3, 3].round(6).tolist()
    [-0.81725, -0.19145, -0.005191]
    """
    quarter = np.pi / 2
    table = dh.Table(
        a=np.array([0, -425, -392.25, 0, 0, 0]) / 1000,
        alpha=[quarter, 0, 0, quarter, -quarter, 0],
        d=np.array([89.459, 0, 0, 109.15, 94.65, 82.3]) / 1000,
        theta=np.zeros(6),
    )
    q_mm = [
        (0, 0, 89.459),
        (0, 0, 89.459),
        (-425, 0, 89.459),
        (-817.25, 0, 89.459),
        (-817.25, -109.15, 89.459),
        (-817.25, -109.15, -5.191),
    ]
    return Robot.from_axes(
        [Z, -Y, -Y, -Y, -Z, -Y],
        np.array(q_mm) / 1000,
        _pose(np.array([X, -Z, Y]), (-817.25, -191.45, -5.191)),
        name="Universal Robots UR5",
        standard_dh=table,
        **_limits(np.radians([(-360, 360)] * 6)),
        v_max=np.radians([180] * 6),
        source="robotics-toolbox-python, models.DH.UR5; limits and speeds: Universal Robots' description",
        discrepancies=(
            "Speeds and limits are the customary ones and were not checked against a data sheet.",
        ),
    )


def scara() -> Robot:
    """Adept Cobra 600: a SCARA, two hinges, a slide and a hinge, all vertical. Practice robot.

    Joint 3 counts downwards, and so does joint 4. Source: robotics-toolbox-python, models.DH.Cobra600.

    >>> scara().joint_types, scara().M[:3, 3].round(3).tolist()
    (('revolute', 'revolute', 'prismatic', 'revolute'), [0.6, 0.0, 0.387])
    """
    table = dh.Table(
        a=np.array([325, 275, 0, 0]) / 1000,
        alpha=[0, np.pi, 0, 0],
        d=np.array([387, 0, 0, 0]) / 1000,
        theta=np.zeros(4),
        joint_types="RRPR",
    )
    limits = np.array([*np.radians([(-50, 50), (-88, 88)]), (0, 0.210), np.radians((-360, 360))])
    return Robot.from_axes(
        [Z, Z, -Z, -Z],
        np.array([(0, 0, 387), (325, 0, 387), (600, 0, 387), (600, 0, 387)]) / 1000,
        _pose(np.diag([1, -1, -1]), (600, 0, 387)),
        joint_types="RRPR",
        name="Adept Cobra 600",
        standard_dh=table,
        **_limits(limits),
        home=[*np.radians([-30, 60]), 0.1, 0],
        source="robotics-toolbox-python, models.DH.Cobra600",
        discrepancies=(
            "The toolbox gives no limits of joint 4; 360 deg are customary and were not checked.",
            "The home pose is this course's own: the toolbox's zero is singular, the arm stretched out.",
        ),
    )


def stanford() -> Robot:
    """Stanford arm (Scheinman): two hinges, a slide, three hinges that meet in one point. Practice robot.

    Joint 3 pushes the hand out; theta = 0 lies below its limits. Source: robotics-toolbox-python,
    models.DH.Stanford, after Stanford AIM-177, figure 2.3.

    >>> stanford().joint_types[2], stanford().M[:3, 3].round(4).tolist()
    ('prismatic', [0.0, 0.1337, 0.412])
    """
    quarter, inch = np.pi / 2, 0.0254
    table = dh.Table(
        a=np.array([0, 0, 20.3, 0, 0, 0]) / 1000,
        alpha=[-quarter, quarter, 0, -quarter, quarter, 0],
        d=np.array([412, 154, 0, 0, 0, 0]) / 1000,
        theta=[0, 0, -quarter, 0, 0, 0],
        joint_types="RRPRRR",
    )
    wrist = (0, 154 - 20.3, 412)
    q_mm = [(0, 0, 412), (0, 154, 412), (0, 154, 412), wrist, wrist, wrist]
    hinges = np.radians([(-170, 170), (-170, 170), (-170, 170), (-90, 90), (-170, 170)])
    return Robot.from_axes(
        [Z, Y, Z, Z, X, Z],
        np.array(q_mm) / 1000,
        _pose(np.array([Y, -X, Z]), wrist),
        joint_types="RRPRRR",
        name="Stanford arm",
        standard_dh=table,
        **_limits(np.insert(hinges, 2, [12 * inch, 50 * inch], axis=0)),
        home=[0, np.pi / 3, 0.6, 0, np.pi / 4, 0],
        source="robotics-toolbox-python, models.DH.Stanford, after Stanford AIM-177, figure 2.3",
        discrepancies=(
            "The home pose is this course's own: at the toolbox's zero joint 3 would be inside its housing.",
        ),
    )


class _Agilus:
    """What KUKA's small robots share: a 400 mm column, a shoulder 25 mm in front of it, joint directions.

    Lengths in mm. The DH table is that of the TPK4170 report: z_0 points down, theta_3 is shifted by -90 deg.
    """

    column, shoulder = 400, 25

    def __init__(self, upper_arm, elbow_offset, forearm, flange):
        self.upper_arm, self.elbow_offset, self.forearm, self.flange = (
            upper_arm,
            elbow_offset,
            forearm,
            flange,
        )

    def robot(self, name, limits, v_max, source, discrepancies):
        quarter = np.pi / 2
        elbow, height = self.shoulder + self.upper_arm, self.column + self.elbow_offset
        wrist = (elbow + self.forearm, 0, height)
        q_mm = [(0, 0, 0), (self.shoulder, 0, self.column), (elbow, 0, self.column), wrist, wrist, wrist]
        table = dh.Table(
            a=np.array([self.shoulder, self.upper_arm, self.elbow_offset, 0, 0, 0]) / 1000,
            alpha=[quarter, 0, quarter, -quarter, quarter, 0],
            d=np.array([-self.column, 0, 0, -self.forearm, 0, 0]) / 1000,
            theta=[0, 0, -quarter, 0, 0, 0],
            base=_pose(np.diag([1, -1, -1]), (0, 0, 0)),
            tool=_pose(np.array([Z, Y, -X]), (0, 0, -self.flange)),
        )
        return Robot.from_axes(
            [-Z, Y, Y, -X, Y, -X],
            np.array(q_mm) / 1000,
            _pose(np.eye(3), (wrist[0] + self.flange, 0, height)),
            name=name,
            standard_dh=table,
            **_limits(limits),
            v_max=v_max,
            home=[0, -quarter, quarter, 0, 0, 0],
            source=source,
            discrepancies=discrepancies,
        )


# The limits of the KR10 stand in the author's repository as degrees times 0.0174532925, not times pi / 180.
_KR10_DEGREE = 0.0174532925
_KR10_LIMITS = _KR10_DEGREE * np.array(
    [(-170, 170), (-190, 45), (-120, 156), (-185, 185), (-120, 120), (-350, 350)], dtype=float
)
_KR10_SPEEDS = np.radians([300, 225, 330, 360, 360, 433])


def _limits(pairs):
    """(n, 2) lower and upper limits as keywords."""
    return {"q_min": pairs[:, 0], "q_max": pairs[:, 1]}


def _pose(R, p_mm):
    """Pose with rotation R and position p_mm in millimetres."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, np.array(p_mm) / 1000
    return T

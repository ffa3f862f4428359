"""Notebook 04: where the student's angles lead, and what they say is lost."""

from functools import partial

import numpy as np

from coursekit.view import text
from coursekit.view.controls import Action
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import ZERO, Trouble, gap, like_the_kr6, size

from .steps import wrist


class Singularities(Explorer):
    """Notebook 04: where the student's angles lead, and what they say is lost."""

    def _more(self):
        self.ends = {}  # name -> where the student's angle leads
        labels = {"elbow_angle": "to your elbow", "shoulder_theta3": "to your shoulder"}
        return [
            Action(name, label, partial(self._drive, name))
            for name, label in labels.items()
            if name in self.mine.functions
        ]

    def _is_ready(self, name):
        return self.ends.get(name) is not None

    def _rank(self, _sketch, values):
        J = self.robot.jacobian_body(values["theta"])
        sigma, mine = np.linalg.svd(J)[1], float(self.mine.ask("rank", J, 1e-9))
        right = int((sigma > 1e-9 * sigma[0]).sum())
        return f"{mine:g}, which is right" if mine == right else f"{mine:g}; the rank is {right}"

    def _det_from_blocks(self, _sketch, values):
        J = self._at_the_wrist(values["theta"])
        mine, right = float(self.mine.ask("det_from_blocks", J)), float(np.linalg.det(J))
        off = abs(mine - right)
        told = "below 1e-9 of the right one" if off <= ZERO else f"the right one is {text.number(right, 6)}"
        return f"det J = {text.number(mine, 6)} m^3, {told}"

    def _at_the_wrist(self, theta):
        """J with its reference point at the wrist centre."""
        J, tool = self.robot.jacobian_geometric(theta), self.robot.fk(theta)[:3, 3]
        if self.robot.n != 6:
            raise Trouble(f"it is for six joints, and {self.robot.name} has {self.robot.n}")
        wrist = self.robot.link_frames(theta)[4, :3, 3]
        J = np.vstack([J[:3], J[3:] + np.cross(J[:3].T, wrist - tool).T])
        if np.abs(J[3:, 3:]).max() > ZERO:
            raise Trouble(f"it is for arms whose last three axes meet; those of {self.robot.name} do not")
        J[3:, 3:] = 0
        return J

    def _drive(self, name):
        self._drive_to(self.ends[name])

    def _elbow_angle(self, sketch, values):
        self.ends["elbow_angle"] = None
        (_, _, a2, a3, d4), tool = like_the_kr6(self.robot)
        angle = float(self.mine.ask("elbow_angle", a3, d4))
        P, shoulder, elbow = self._stand(sketch, "elbow_angle", values["theta"], angle, tool)
        along = (elbow - shoulder) / a2
        foot = shoulder + along * (along @ (P - shoulder))
        doubt = "; but the arm is folded, not stretched" if (P - elbow) @ along < 0 else ""
        return self._miss(sketch, angle, P, foot, "the line through axes 2 and 3", doubt)

    def _shoulder_theta3(self, sketch, values):
        self.ends["shoulder_theta3"], theta = None, values["theta"]
        (a1, _, a2, a3, d4), tool = like_the_kr6(self.robot)
        reach = -(a1 + a2 * np.cos(theta[1])) / np.hypot(a3, d4)
        if abs(reach) > 1:
            raise Trouble("at this theta_2 no theta_3 brings the wrist to axis 1")
        higher = np.arctan2(a3, d4) - np.arccos(reach) - theta[1]
        lengths = np.array([a1, a2, a3, d4, tool])
        angle = float(self.mine.ask("shoulder_theta3", float(theta[1]), lengths))
        P, *_ = self._stand(sketch, "shoulder_theta3", theta, angle, tool)
        doubt = "" if np.cos(angle - higher) > 1 - ZERO else "; but that is the lower of the two"
        return self._miss(sketch, angle, P, np.array([0, 0, P[2]]), "axis 1", doubt)

    def _stand(self, sketch, name, theta, angle, tool):
        """Draw the arm at the student's theta_3; its wrist, shoulder and elbow there."""
        self.ends[name] = end = np.array([*theta[:2], angle, *theta[3:]])
        sketch.arm(self.robot, self.robot.displacements(end))
        return wrist(self.robot.fk(end), tool), *self.robot.link_frames(end)[1:3, :3, 3]

    def _miss(self, sketch, angle, P, foot, where, doubt):
        """How far the wrist is from where it should be; `doubt` is said of one that is there."""
        sketch.gap("gap", foot, P)
        off = float(np.linalg.norm(P - foot))
        told = f"at your theta_3 = {text.degrees(angle)} the wrist centre is {gap(off)} from {where}"
        return told + (doubt if off <= ZERO else "")

    def _lost_motion(self, sketch, values):
        """The student's twist, read as the load that no joint feels: at the wrist, as arrows."""
        theta = values["theta"]
        J = self.robot.jacobian_space(theta)
        s = self.mine.ask("lost_motion", J)
        long = np.linalg.norm(s)
        if long < 1e-6:
            raise Trouble("it returns a twist of length 0")
        at = self.robot.link_frames(theta)[min(4, self.robot.n - 1), :3, 3]
        moment, force = s[:3] - np.cross(at, s[3:]), s[3:]
        scale = 0.35 * self.scene.size / max(np.hypot(np.linalg.norm(moment), np.linalg.norm(force)), 1e-9)
        for what, vector in (("force", force), ("moment", moment)):
            sketch.arrow(what, at, scale * vector, f"{sketch.label}: {what}")
        given, sigma = np.linalg.norm(J.T @ s) / long, np.linalg.svd(J)[1]
        least = sigma[-1] if len(sigma) == 6 else 0.0
        length = "" if abs(long - 1) < 1e-6 else f"; its length is {size(long)}, not 1"
        if given <= ZERO:
            return f"no joint rate gives it, below 1e-9{length}"
        if given <= least + 1e-6:
            return (
                f"nothing is lost here; yours is what joint rates give least, {text.number(given, 3)}{length}"
            )
        part = text.number(given, 3)
        return f"joint rates of length 1 give {part} of it, of the weakest {text.number(least, 3)}{length}"

"""URDF: the chain from the root of a robot description to its tip, as axes.

Only what kinematics needs is read: links, joints, their origins, axes and limits. Reading is strict: what the
chain cannot be made of is refused with the element's name and line. There is no network, no entity and no
document type: a file that brings one is refused. Source: the URDF specification, wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from . import rotations

MOVING = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


@dataclass
class Element:
    """<tag name="..."> with its line, attributes and children."""

    tag: str
    line: int
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)

    def __str__(self) -> str:
        name = self.attributes.get("name")
        return f"<{self.tag}{f' name={name!r}' if name else ''}> (line {self.line})"

    def child(self, tag: str) -> Element | None:
        """The first child with this tag, or None."""
        return next((child for child in self.children if child.tag == tag), None)

    def needed(self, key: str) -> str:
        """An attribute; a ValueError names the element that lacks it."""
        if key not in self.attributes:
            present = ", ".join(self.attributes) or "none"
            raise ValueError(f"{self} needs the attribute {key!r}; it has: {present}")
        return self.attributes[key]

    def numbers(self, key: str, default: str) -> np.ndarray:
        """An attribute as numbers, as many as the default has."""
        text, count = self.attributes.get(key, default), len(default.split())
        try:
            values = np.array([float(word) for word in text.split()])
        except ValueError:
            values = np.array([np.nan])
        if len(values) != count or not np.isfinite(values).all():
            raise ValueError(f"{self}: {key} must be {count} finite numbers, got {text!r}")
        return values


def read(source: str | Path, tip: str | None) -> dict[str, Any]:
    """What Robot.from_urdf needs: w, q (n, 3), M (4, 4), joint_types, q_min, q_max, v_max and name.

    source: the name of a file, or the text of one. tip: the link that carries the tool frame.
    """
    is_text = isinstance(source, str) and source.lstrip().startswith("<")
    robot = parse(str(source).encode() if is_text else Path(source).read_bytes())
    if robot.tag != "robot":
        raise ValueError(f"a URDF begins with <robot>, this file with {robot}")
    if any(child.tag.startswith("xacro:") for child in robot.children):
        raise ValueError(
            "this is a xacro file, from which a URDF must first be made: xacro FILE > robot.urdf"
        )
    T, w, q, types, limits = np.eye(4), [], [], [], []
    for joint in chain(robot, tip):
        T = T @ _origin(joint)
        kind = joint.needed("type")
        if kind == "fixed":
            continue
        if kind not in MOVING:
            raise ValueError(f"{joint} is of type {kind!r}; a chain is made of {', '.join(MOVING)} and fixed")
        if joint.child("mimic"):
            raise ValueError(f"{joint} follows another joint (<mimic>): it has no angle of its own")
        w.append(T[:3, :3] @ _axis(joint))
        q.append(T[:3, 3])
        types.append(MOVING[kind])
        limits.append(_limits(joint, kind))
    if not w:
        raise ValueError(f"nothing moves between the root of {robot} and its tip")
    q_min, q_max, v_max = np.transpose(limits)
    about = {"q_min": q_min, "q_max": q_max, "v_max": v_max, "name": robot.attributes.get("name", "robot")}
    about["source"] = "a URDF" if is_text else Path(source).name
    return {"w": w, "q": q, "M": T, "joint_types": types, **about}


def parse(text: bytes) -> Element:
    """The root element of an XML text. Raises ValueError where it is none, or has a document type."""
    root = Element("", 0, {})
    stack = [root]
    parser = expat.ParserCreate()

    def start(tag, attributes):
        stack.append(Element(tag, parser.CurrentLineNumber, attributes))
        stack[-2].children.append(stack[-1])

    def doctype(*_):
        raise ValueError(f"a URDF has no document type: <!DOCTYPE> in line {parser.CurrentLineNumber}")

    parser.StartElementHandler, parser.StartDoctypeDeclHandler = start, doctype
    parser.EndElementHandler = lambda tag: stack.pop()
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise ValueError(f"this is no XML: {error}") from None
    return root.children[0]


def chain(robot: Element, tip: str | None) -> list[Element]:
    """The joints from the root link to the tip, in this order. tip None: the only link that carries none."""
    links = [element.needed("name") for element in robot.children if element.tag == "link"]
    carrier: dict[str, tuple[Element, str]] = {}  # link -> the joint it hangs on, and the link before
    for joint in (element for element in robot.children if element.tag == "joint"):
        parent, child = (_link_of(joint, tag, links) for tag in ("parent", "child"))
        if child in carrier:
            raise ValueError(f"{joint} carries link {child!r}, which {carrier[child][0]} carries already")
        carrier[child] = joint, parent
    parents = {parent for _, parent in carrier.values()}
    ends = [link for link in links if link not in parents]
    if tip is None and len(ends) != 1:
        which = f"say which link is the tip, one of {', '.join(ends or links)}" if links else "it has no link"
        raise ValueError(f"{robot} has {len(ends)} ends: {which}")
    tip = ends[0] if tip is None else tip
    if tip not in links:
        raise ValueError(f"{robot} has no link {tip!r}; it has: {', '.join(links)}")
    found: list[Element] = []
    while tip in carrier:
        joint, tip = carrier[tip]
        if joint in found:
            raise ValueError(f"{joint} is part of a loop: no link is the root")
        found.append(joint)
    return found[::-1]


def _link_of(joint, tag, links):
    """The name of the parent or child link of a joint."""
    element = joint.child(tag)
    if element is None:
        raise ValueError(f"{joint} needs <{tag} link=...>")
    if element.needed("link") not in links:
        raise ValueError(f"{joint}: its {tag} {element.needed('link')!r} is no <link> of this robot")
    return element.needed("link")


def _origin(joint):
    """Pose of the joint in the frame of its parent: roll, pitch, yaw about fixed x, y, z."""
    T, origin = np.eye(4), joint.child("origin")
    if origin is not None:
        T[:3, 3] = origin.numbers("xyz", "0 0 0")
        T[:3, :3] = rotations.from_zyx(origin.numbers("rpy", "0 0 0")[::-1])
    return T


def _axis(joint):
    """Direction of the axis in the frame of the joint, of length 1; along x where none is given."""
    element = joint.child("axis")
    axis = np.array([1.0, 0, 0]) if element is None else element.numbers("xyz", "1 0 0")
    if not np.any(axis):
        raise ValueError(f"{joint}: its axis is 0 0 0, which is no direction")
    return axis / np.linalg.norm(axis)


def _limits(joint, kind):
    """Lowest and highest position, and speed (NaN where none or 0 is given)."""
    limit = joint.child("limit")
    if limit is None and kind != "continuous":
        raise ValueError(f"{joint} is {kind} and needs <limit lower=... upper=...>")
    lower, upper, speed = -np.inf, np.inf, np.nan
    if limit is not None:
        speed = float(limit.numbers("velocity", "0")[0]) or np.nan
        if kind != "continuous":
            lower, upper = (float(limit.numbers(key, "0")[0]) for key in ("lower", "upper"))
    if lower > upper:
        raise ValueError(f"{joint}: its lower limit {lower:g} is above its upper limit {upper:g}")
    return lower, upper, speed

"""Golden data: numbers that other programs computed (tests/golden/README.md says which and how)."""

import json
from functools import cache
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[1] / "golden"

# The golden data call the robots by their full type names. A robot that stands here is tested against them.
GOLDEN_ROBOTS = {
    "kuka_kr6_r900_sixx": "kuka_kr6",
    "abb_irb1200_5_90": "abb_irb1200",
    "kuka_kr10_r1100_2": "kuka_kr10",
    "kuka_kr10_r1100_2_report": "kuka_kr10_report",
    "franka_panda": "franka_panda",
    "kawasaki_s030": "kawasaki_s030",
    "planar_2r": "planar_2r",
    "puma560": "puma560",
    "ur5": "ur5",
    "adept_cobra600": "scara",
    "stanford_arm": "stanford",
}
# those with six hinges and a closed form; others with golden data are excepted by name
SIX_HINGES = {
    full: name
    for full, name in GOLDEN_ROBOTS.items()
    if name not in ("franka_panda", "planar_2r", "scara", "stanford")
}


@cache
def load(name):
    """One golden file as Python objects, by its name without the ending."""
    return json.loads((FOLDER / f"{name}.json").read_text())


@pytest.fixture(name="golden")
def golden_fixture():
    return load

"""An arm of one's own: distinct, reachable, regular, and found from the folder that a notebook runs in."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest

from coursekit import classroom, ik, robots, singularity
from coursekit.classroom import own

CLASS = [own.seed_of(f"s{number}") for number in range(300)]


def test_no_two_of_a_class_have_the_same_arm():
    sheets = [own.sheet_of(seed) for seed in CLASS]
    drawn = {(*s.lengths.values(), s.forward, s.upright, s.signs) for s in sheets}
    assert len(drawn) == len(CLASS)
    for of in ("forward", "upright", "signs"):
        assert len({getattr(s, of) for s in sheets}) > 1, of


@pytest.mark.parametrize("seed", [own.NOBODY, *CLASS[:40]])
def test_every_arm_is_reachable_and_regular_at_home(seed):
    robot = own.arm_of(seed)
    assert robot.within_limits(robot.home)
    assert min(abs(value) for value in singularity.relative_factors(robot, robot.home).values()) > 0.2
    found = ik.analytic(robot, robot.fk(robot.home))
    assert found.exists.sum() >= 4 and found.within_limits.any()
    assert np.nanmin(np.abs(found.theta - robot.home).max(axis=-1)) < 1e-9


@pytest.mark.parametrize("seed", CLASS[:20])
def test_the_sheet_says_what_the_arm_is(seed):
    """Added up along the links, as a student does who reads the drawing."""
    sheet, robot = own.sheet_of(seed), own.arm_of(seed)
    L = sheet.lengths
    out = L["shoulder"] + L["forearm"] + L["flange"] + (0 if sheet.upright else L["upper_arm"])
    up = L["column"] + L["elbow"] + (L["upper_arm"] if sheet.upright else 0)
    where = [out, 0, up] if sheet.forward == "x" else [0, out, up]
    np.testing.assert_allclose(robot.M[:3, 3], where, atol=1e-12)
    assert robot.S[2, 0] == sheet.signs[0]
    left = {"x": [0, 1, 0], "y": [-1, 0, 0]}[sheet.forward]
    np.testing.assert_allclose(robot.S[:3, 1], sheet.signs[1] * np.array(left), atol=1e-15)


def test_without_a_student_everybody_has_the_practice_arm():
    assert classroom.own_seed() == 0
    assert classroom.own_arm().name == "practice arm"
    assert classroom.own_sheet() == own.sheet_of(0)


def test_the_seed_is_found_from_the_notebooks_folder(tmp_path, monkeypatch):
    (tmp_path / own.FILE).write_text(json.dumps({"id": "s7", "seed": own.seed_of("s7")}))
    (tmp_path / "notebooks").mkdir()
    monkeypatch.chdir(tmp_path / "notebooks")
    assert classroom.own_seed() == own.seed_of("s7")
    np.testing.assert_array_equal(classroom.own_arm().S, own.arm_of(own.seed_of("s7")).S)
    with own.using(5):
        assert classroom.own_seed() == 5
        with own.using(None):
            assert classroom.own_seed() == 5
    assert classroom.own_seed() == own.seed_of("s7")


@pytest.mark.parametrize("text", ["", "{}", '{"seed": "5"}', '{"seed": -1}', '{"seed": true}', "[]"])
def test_a_damaged_file_is_named(text, tmp_path, monkeypatch):
    (tmp_path / own.FILE).write_text(text)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=r"student\.json holds no \"seed\""):
        classroom.own_seed()


def test_the_seed_of_an_id_is_the_same_in_every_process():
    code = "from coursekit.classroom import own; print(own.seed_of('s1001'))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(run.stdout) == own.seed_of("s1001")
    assert own.seed_of("s1001") not in (own.NOBODY, own.seed_of("S1001"))
    assert "practice arm" not in {robot.name for robot in robots.all().values()}

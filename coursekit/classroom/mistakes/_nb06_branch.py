"""Typical mistakes of notebook 06 in going on: which solution belongs to the branch, and with which turns."""

from __future__ import annotations

import numpy as np

TURN = 2 * np.pi


def _nearest(last, candidates):
    return np.argmin(np.linalg.norm(candidates - last, axis=1))


def _turned(last, solutions):
    return solutions + TURN * np.round((last - solutions) / TURN)


def branch_as_numbers(last, solutions):
    return solutions[_nearest(last, solutions)]


def branch_not_turned(last, solutions):
    return solutions[_nearest(last, _turned(last, solutions))]


def branch_chosen_first(last, solutions):
    return _turned(last, branch_as_numbers(last, solutions))


def branch_turned_away(last, solutions):
    turned = solutions - TURN * np.round((last - solutions) / TURN)
    return turned[_nearest(last, turned)]


def branch_one_turn(last, solutions):
    turned = solutions + TURN * np.clip(np.round((last - solutions) / TURN), -1, 1)
    return turned[_nearest(last, turned)]


def branch_rounded_down(last, solutions):
    turned = solutions + TURN * np.floor((last - solutions) / TURN)
    return turned[_nearest(last, turned)]


def branch_mixed(last, solutions):
    turned = _turned(last, solutions)
    return turned[np.argmin(np.abs(turned - last), axis=0), np.arange(len(last))]


def branch_first_row(last, solutions):
    return _turned(last, solutions)[0]


def branch_last_row(last, solutions):
    return _turned(last, solutions)[-1]


def branch_all_joints_alike(last, solutions):
    whole = np.round((last - solutions).mean(axis=1, keepdims=True) / TURN)
    turned = solutions + TURN * whole
    return turned[_nearest(last, turned)]


WRONG = {
    "next_on_branch": {
        "nothing_turned": branch_as_numbers,
        "not_turned": branch_not_turned,
        "nearest_first": branch_chosen_first,
        "turned_away": branch_turned_away,
        "one_turn": branch_one_turn,
        "rounded_down": branch_rounded_down,
        "mixed": branch_mixed,
        "first_row": branch_first_row,
        "joints_alike": branch_all_joints_alike,
        "last_row": branch_last_row,
    },
}

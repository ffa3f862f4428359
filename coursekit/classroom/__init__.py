"""The classroom: exercises, feedback, releases, grades."""

from .check import CheckFailed, check

__all__ = ["CheckFailed", "check"]

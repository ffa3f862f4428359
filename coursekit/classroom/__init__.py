"""The classroom: exercises, feedback, releases, grades."""

from .check import CheckFailed, Diagnosis, check, diagnose, example

__all__ = ["CheckFailed", "Diagnosis", "check", "diagnose", "example"]

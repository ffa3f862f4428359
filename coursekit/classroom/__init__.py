"""The classroom: exercises, feedback, releases, grades.

From a student's function to a sentence: `check` finds the exercise (`exercise`, `course`) and its public
examples (`samples/`), `attempt` calls the function on each of them, `verdict` asks one question after the
other until it has an answer (`transforms`: what was done to the right answer; `repair/`: in which line;
`already`: what is right), `told` writes it down at the level that was asked for, `picture` and `panel` show
it, and `seen` has the line that opens it in 3D. What is written is used by the cells below it (`onward`);
questions with numbers that change and the ticks of a notebook's goals stand in `question` and `questions/`.
The grader judges with the same `verdict`.

Everybody has an arm of their own (`own`). A course of one's own is a folder (`your_course`); a corrected
release reaches those who are at work through `update` and `merge`, which know what a student wrote.

What lies here goes to students, but for three rooms of the instructors: `mistakes/`, `author/` and `grader/`.
"""

from .check import CheckFailed, Diagnosis, check, diagnose, example
from .onward import use, yours
from .own import own_arm, own_seed, own_sheet
from .question import ask, goals

__all__ = [
    "CheckFailed",
    "Diagnosis",
    "ask",
    "check",
    "diagnose",
    "example",
    "goals",
    "own_arm",
    "own_seed",
    "own_sheet",
    "use",
    "yours",
]

"""Predict in the picture: a question in words, a point to drag where the answer is, and how near it came.

class _Screws(Explorer):
    def begin(self, number): ...          # puts the controls where question `number` begins
    def question(self, values): ...       # a Question, or in words why there is none
"""

from __future__ import annotations

import numpy as np

from coursekit.kinematics.robot import Robot

from . import text
from .controls import Action, Slider, Toggle
from .questions import TINY, Question
from .scene import Scene
from .target import PoseSliders

ROOT = "/ck/predict"


class Guess(PoseSliders):
    """Where the point is, (3,) in metres: moved by its handles in the picture, while it is `held`."""

    path, letter, in_picture, held = f"{ROOT}/guess", "your guess", True, False

    def __init__(self) -> None:
        super().__init__("prediction", [Slider(f"guess {axis}", 0.0, unit="mm") for axis in "xyz"])

    def fit(self, start: np.ndarray, reach: float) -> None:
        for slider, x in zip(self.sliders, start, strict=True):
            slider.fit(float(x), -reach, reach, "mm")


class Prediction:
    """The controls of a prediction, what is drawn of it and what is said."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.guess = scene, Guess()
        self.number = 0  # of the question
        self.question: Question | None = None  # that is open
        self.told = ""  # once it is answered
        self._begun: tuple | None = None
        self._key: tuple | None = None  # of the question that was asked last
        self._words = ""
        self.buttons = [
            Action("show_answer", "show answer", self.show),
            Action("next_question", "next question", self.next),
        ]
        for button in self.buttons:
            button.offer(False)

    @property
    def is_open(self) -> bool:
        """Whether a question waits for its answer."""
        return self.question is not None and not self.told

    def controls(self) -> list:
        return [Toggle("predict", "predict first"), *self.buttons, self.guess]

    def begins(self, on: bool, robot: Robot) -> bool:
        """Whether another question begins now than at the last call."""
        before, self._begun = self._begun, (self.number, robot) if on else None
        if self._begun == before:
            return False
        self.told, self._key = "", None
        return on

    def ask(self, found: Question | str | None, resting: bool) -> None:
        """Draw the question. found: None where predictions are off; resting: no motion runs."""
        on = found is not None
        if not on:
            self.scene.see(np.empty((0, 3)))
        for button in self.buttons:
            button.offer(on)
        if self.told and (not resting or (isinstance(found, Question) and found.key == self._key)):
            return  # the answer stays in sight
        self.told = ""
        self.question = found if isinstance(found, Question) else None
        self.guess.held = self.question is not None
        self._words = found if isinstance(found, str) else ""
        if self.question is None:
            self.scene.remove(ROOT)
            return
        if self.question.key != self._key:
            self._key = self.question.key
            self.scene.remove(ROOT)
            self.scene.see(self.question.seen)
            self.guess.fit(self.question.start, 2 * self.scene.size)
        self._draw()

    def _draw(self):
        """The point; the tip of an arrow stays as far from its origin as it was at first."""
        guess, origin, T = self.guess, self.question.origin, np.eye(4)
        if origin is not None:
            way, long = guess.get() - origin, np.linalg.norm(self.question.start - origin)
            if np.linalg.norm(way) > TINY:
                guess.put(origin + long / np.linalg.norm(way) * way)
        T[:3, 3] = guess.get()
        if guess.path not in self.scene.parts:
            self.scene.point(guess.path, np.zeros(3), "your guess", "accent", 0.014 * self.scene.size)
        self.scene[guess.path].move(T)
        if origin is not None:
            self.scene.arrow(f"{ROOT}/arrow", origin, guess.get() - origin, "accent")

    def words(self) -> list[str]:
        """The question, or what is told of the guess."""
        if self.question is None:
            return [self._words] if self._words else []
        at, origin = self.guess.get(), self.question.origin
        if origin is None:
            said = text.millimetres(at, 0)
        else:
            said = f"along {text.row((at - origin) / max(np.linalg.norm(at - origin), TINY), 2)}"
        return [f"Predict: {self.question.words}", f"Your guess: {said}. {self.told}".rstrip()]

    def show(self) -> None:
        """Tell and draw the answer to the open question."""
        if self.question is None or self.told:
            return
        guess, origin = self.guess.get(), self.question.origin
        self.told, right = self.question.judge(guess)
        self.guess.held = False
        if origin is None:
            gap = text.millimetres(np.linalg.norm(guess - right), 0)
            self.scene.line(f"{ROOT}/gap", right, guess, "accent", gap, 0.003 * self.scene.size)
        else:
            self.scene.arrow(f"{ROOT}/right", origin, right - origin, "y", "right")
        if self.question.show is not None:
            self.question.show(right)

    def next(self) -> None:
        self.number += 1

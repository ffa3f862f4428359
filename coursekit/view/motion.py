"""A motion of an arm, as a panel plays it."""

from dataclasses import dataclass

import numpy as np

from coursekit.view.drawing import Arm


@dataclass
class Motion:
    """Joint values (N, n) that a robot of the scene goes through, and the one that is shown now."""

    arm: Arm
    thetas: np.ndarray
    frame: int = 0

    @property
    def theta(self) -> np.ndarray:
        """The configuration that is shown, (n,)."""
        return self.thetas[self.frame]

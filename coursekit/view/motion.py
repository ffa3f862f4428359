"""A motion of an arm, as a panel plays it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coursekit.view.drawing import Arm
from coursekit.view.scene import Scene


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

    def poses(self, scene: Scene, follow: Callable[[np.ndarray], None] | None = None) -> np.ndarray:
        """Of all that moves in its scene, (N, k, 4, 4). follow(theta) moves what goes with the arm."""
        found = []
        for theta in self.thetas:
            self.arm.theta = theta
            if follow is not None:
                follow(theta)
            found.append(scene.pose())
        return np.array(found)

"""The typical mistakes of 01_first_arm, made on purpose. Students do not get this file."""

import numpy as np


def tip(theta, lengths):
    """What the solved notebook does."""
    elbow = lengths[0] * np.array([np.cos(theta[0]), np.sin(theta[0])])
    return elbow + lengths[1] * np.array([np.cos(theta[0] + theta[1]), np.sin(theta[0] + theta[1])])


WRONG = {
    "tip": {
        "degrees": lambda theta, lengths: tip(np.radians(theta), lengths),
        "not_added": lambda theta, lengths: tip([theta[0], theta[1] - theta[0]], lengths),
        "swapped": lambda theta, lengths: tip(theta, lengths)[::-1],
    },
}

"""What the student's functions draw in the explorers of notebooks 03 to 06, and what the text says of them.

Each class is a part of one explorer, which it tells how to draw a function (see `Explorer`); `_more` are the
buttons that a function brings along, `_is_ready` says when they have something to do.
"""

from .inverse import Inverse
from .jacobians import Jacobians
from .path import Path
from .singularities import Singularities

__all__ = ["Inverse", "Jacobians", "Path", "Singularities"]

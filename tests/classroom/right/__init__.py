"""Right versions of every exercise in other styles: each must pass."""

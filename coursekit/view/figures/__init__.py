"""Pictures of the notebooks, one file each: what needs more lines than a cell should have."""

from coursekit.view.paint import PALETTE

INK = "#2B3038"  # links, notes and thin lines


def palette(name):
    """A colour of the house as matplotlib writes it, so that a figure looks like its explorer."""
    return f"#{PALETTE[name]:06X}"

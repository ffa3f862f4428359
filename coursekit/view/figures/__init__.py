"""Pictures of the notebooks, one file each: what needs more lines than a cell should have."""

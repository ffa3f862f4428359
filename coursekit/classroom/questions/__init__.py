"""Questions and goals of each notebook, one file each."""

"""What the students' notebooks show when they are run before an exercise is solved.

The pages are made from that and from nothing else, so they cannot show what a student has yet to find.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode

# What a cell may fail with while a function above it is not written, or a cell that it needs has failed.
WAITING = ("NotImplementedError", "NameError")


def run(path: Path, course: Path, timeout: float = 300) -> NotebookNode:
    """Run a student's notebook to its end, in the released course.

    Parameters
    ----------
    path : Path
        A notebook of `course`.
    course : Path
        A folder that `coursekit release` has written.
    timeout : float
        Seconds for one cell.

    Returns
    -------
    NotebookNode
        With outputs. A cell that waits for what a student writes has none, and `waits` among its tags.

    Raises
    ------
    ValueError
        If a cell fails for another reason.
    """
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(
        notebook,
        kernel_name="python3",
        timeout=timeout,
        allow_errors=True,
        store_widget_state=False,
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": str(path.parent)}},
    )
    environment = {
        name: value for name, value in os.environ.items() if name != "CI"
    }  # a check tells, not fails
    client.execute(env={**environment, "PYTHONPATH": str(course)}, stderr=subprocess.DEVNULL)
    for cell in notebook.cells:
        failed = [output for output in cell.get("outputs", []) if output.output_type == "error"]
        for error in failed:
            if error.ename not in WAITING:
                raise ValueError(
                    f"{path.name}, cell {cell.id}: {error.ename}: {error.evalue}; before the exercises "
                    f"are solved a cell may fail with {' or '.join(WAITING)} only"
                )
        if failed:
            cell.outputs = []
            cell.metadata.tags = [*cell.metadata.get("tags", []), "waits"]
    return notebook

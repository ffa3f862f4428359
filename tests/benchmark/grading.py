"""What grading costs in CPU time: worker and box together, whatever else the machine does meanwhile.

    python tests/benchmark/grading.py [--class 600]      (bubblewrap; for the class: pip install distributed)

First table: the six solved notebooks and twelve honest odd ones of the tests' small course, each graded three
times by a worker that is warm, medians. Then a class of so many submissions, the six notebooks in turn, some
right, some with a wrong answer, through dask.distributed on two worker processes, extrapolated to a thousand
students with six notebooks each. Nothing in the test command reads this file.
"""

import argparse
import json
import os
import resource
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from coursekit.classroom.author import notebook  # noqa: E402 (after the path)
from coursekit.classroom.course import Course, the_course  # noqa: E402
from coursekit.classroom.grader import grade, pool  # noqa: E402
from coursekit.classroom.grader.box import Limits, bubblewrap  # noqa: E402
from tests.classroom.hostile import KINDS  # noqa: E402
from tests.classroom.small import COURSE  # noqa: E402

ODD = (
    "cells_in_reverse_order",
    "windows_line_ends",
    "sources_as_lists_of_lines",
    "five_megabytes_of_outputs",
    "definitions_below_a_call_of_the_library",
    "a_list_for_an_array",
    "letters_of_all_the_world",
    "magics_in_the_cell",
    "a_figure",
    "a_display_and_a_widget",
    "a_million_lines",
    "a_cell_that_fails",
)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--class", dest="count", type=int, default=600, help="submissions (0: none)")
    options = parser.parse_args()
    if bubblewrap() is None:
        raise SystemExit("bubblewrap does not work here: what grading costs cannot be measured")
    course = the_course()
    solved = {unit: notebook.read(course.notebook(unit)) for unit in course.units}
    seconds = [(course.notebook(unit).name, cost(course, unit, solved[unit])) for unit in course.units]
    small = notebook.read(COURSE.notebook("nb01"))
    odd = [(name, cost(COURSE, "nb01", KINDS[name].make(small))) for name in ODD]
    pool.close()
    for title, rows in (("solved", seconds), ("honest and odd", odd)):
        for name, cpu in rows:
            print(f"{cpu:6.2f} s  {name}")
        print(f"{median(cpu for _, cpu in rows):6.2f} s  median of {len(rows)} {title}\n")
    print(f"{median(cpu for _, cpu in seconds + odd):6.2f} s  median of all\n")
    if options.count:
        a_class(course, solved, options.count)


def cost(course: Course, unit: str, document: dict | bytes) -> float:
    """CPU seconds of one submission, the median of three after one that warms up."""
    make = grade.Jobs(course, [unit], seed=1, box=True, limits=Limits())
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    records = [grade.grade_one(make.from_bytes("somebody", unit, data)) for _ in range(4)]
    if any(record.get("failed") for record in records):
        raise SystemExit(f"{unit} could not be graded: {records[0]['notes']}")
    return median(record["cpu"] for record in records[1:])


def a_class(course: Course, solved: dict[str, dict], count: int) -> None:
    """A class through dask; what it costs, and what a thousand students with all notebooks would."""
    from distributed import Client, LocalCluster

    with tempfile.TemporaryDirectory(prefix="class") as folder:
        submissions, out = Path(folder) / "in", Path(folder) / "out"
        units = course.units
        for number in range(count):
            unit = units[number % len(units)]
            document = solved[unit] if number % 3 else spoiled(solved[unit], number)
            student = submissions / f"s{number // len(units):04}"
            student.mkdir(parents=True, exist_ok=True)
            notebook.write(student / course.notebook(unit).name, document)
        options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
        before, begun = children(), time.monotonic()
        with LocalCluster(**options, local_directory=f"{folder}/dask") as cluster, Client(cluster) as client:
            executor = client.get_executor(pure=False)
            print(grade.grade_class(submissions, out, executor=executor, jobs=2, lines=False))
        took = time.monotonic() - begun
        lines = map(json.loads, (out / "journal.jsonl").read_text("utf-8").splitlines())
        cpu = [record["cpu"] for record in lines if "cpu" in record]
        mean = sum(cpu) / len(cpu)
        print(f"{len(cpu)} submissions in {took:.0f} s on {os.cpu_count()} cores, whatever else they did")
        print(f"{sum(cpu):.0f} CPU s of workers and boxes, {mean:.2f} s each")
        print(f"{children() - before:.0f} CPU s of all processes that ended, dask's among them")
        print(f"1,000 students with 6 notebooks: {6000 * mean / 3600:.2f} CPU hours")


def spoiled(document: dict, number: int) -> dict:
    """With one solution less."""
    document = json.loads(json.dumps(document))
    cells = [cell for cell in document["cells"] if notebook.is_solution(cell)]
    cell = cells[number % len(cells)]
    cell["source"] = notebook.without_solution(cell["source"])
    return document


def children() -> float:
    """CPU seconds of processes that ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()

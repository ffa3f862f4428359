"""What gives an answer away, looked for in any text that students get."""

import html
import json
import re

from coursekit.classroom.author import notebook

MARKER = re.compile(r"(BEGIN|END) SOLUTION")


def solution_lines(course):
    """Every line of a solution that is long enough to be nobody else's."""
    for unit in course.units:
        for cell in notebook.read(course.notebook(unit))["cells"]:
            if notebook.is_solution(cell):
                inside = re.findall(r"### BEGIN SOLUTION\n(.*?)### END SOLUTION", cell["source"], re.S)
                assert inside, f"{unit}: a solution cell without markers: {cell['source'][:60]}"
                lines = (line.strip() for line in "".join(inside).splitlines())
                yield from (line for line in lines if len(line) > 30)


def instructors_cells(course):
    """The source of every cell that students do not get."""
    for unit in course.units:
        for cell in notebook.read(course.notebook(unit))["cells"]:
            if "instructor" in notebook.tags(cell):
                yield cell["source"]


def found(course, texts):
    """{name of a text: what gives an answer away in it}; texts may be code, JSON or HTML."""
    secrets = [*solution_lines(course), *instructors_cells(course)]
    leaks = {}
    for name, text in texts.items():
        bare = html.unescape(re.sub(r"<[^>]*>", "", text)) if name.endswith(".html") else text
        here = [secret for secret in secrets if secret in bare or json.dumps(secret)[1:-1] in bare]
        here += [match[0] for match in MARKER.finditer(bare)]
        if here:
            leaks[name] = here
    return leaks

"""Submissions to the small course: right, odd, broken and hostile ones, and the points each deserves.

A kind makes of the solved notebook what is handed in: a notebook (dict) or bytes. Its points are those of fk,
jacobian, ik and ik_all. Most kinds spoil `fk` alone, so that all else must survive.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import dataclass

from coursekit.classroom.author.notebook import student_version
from coursekit.classroom.grader.box import bubblewrap, no_boxes_inside
from coursekit.classroom.grader.syscalls import refused

FULL = (2, 3, 3, 4)
NO_FK = (0, 3, 3, 4)
NOTHING = (0, 0, 0, 0)


@dataclass(frozen=True)
class Kind:
    make: Callable[[dict], dict | bytes]
    points: tuple[int, int, int, int]
    feedback: str = ""  # something the student reads of fk
    note: str = ""


KINDS: dict[str, Kind] = {}


def kind(points, feedback="", note=""):
    def add(make):
        KINDS[make.__name__] = Kind(make, points, feedback, note)
        return make

    return add


def fk_kind(name, points, body, feedback="", before="", note=""):
    """A kind that replaces the body of fk; `right` is the right function, `before` stands above."""
    lines = "\n".join("    " + line for line in body.strip("\n").split("\n"))
    source = f"{before}\ndef fk(theta, l1, l2):\n{lines}"
    KINDS[name] = Kind(lambda notebook: with_fk(notebook, source), points, feedback, note)


def cell_kind(name, source, note="", at=None):
    """A kind that adds a cell to a right notebook."""
    KINDS[name] = Kind(lambda notebook: with_cell(notebook, source, at), FULL, note=note)


def with_fk(notebook: dict, source: str) -> dict:
    notebook = copy.deepcopy(notebook)
    cell = notebook["cells"][position(notebook, "def fk")]
    cell["source"] = cell["source"].replace("def fk", "def right") + "\n\n\n" + source
    notebook["cells"] = [c for c in notebook["cells"] if not c["source"].startswith("print(")]
    return notebook


def with_cell(notebook: dict, source: str, at: int | None = None) -> dict:
    notebook = copy.deepcopy(notebook)
    notebook["cells"].insert(len(notebook["cells"]) if at is None else at, code(source))
    return notebook


def code(source: str) -> dict:
    cell = {"cell_type": "code", "id": "extra", "metadata": {}, "source": source}
    return {**cell, "outputs": [], "execution_count": 1}


def position(notebook: dict, start: str) -> int:
    return next(i for i, c in enumerate(notebook["cells"]) if c["source"].startswith(start))


# ---- honest, some of them odd


@kind(FULL)
def solved(notebook):
    return notebook


@kind(FULL)
def a_name_in_wide_letters(notebook):
    """As a keyboard for Chinese may write it: for Python it is the same name."""
    return with_fk(notebook, "def \uff46\uff4b(*inputs):\n    return right(*inputs)")


@kind(FULL)
def cells_in_reverse_order(notebook):
    setup = notebook["cells"][position(notebook, "import numpy")]
    return {**notebook, "cells": [setup, *reversed(notebook["cells"])]}


@kind(FULL)
def windows_line_ends(notebook):
    return json.dumps(notebook, indent=1).replace("\\n", "\\r\\n").replace("\n", "\r\n").encode()


@kind(FULL)
def byte_order_mark(notebook):
    return b"\xef\xbb\xbf" + json.dumps(notebook).encode()


@kind(FULL)
def sources_as_lists_of_lines(notebook):
    cells = [{**c, "source": c["source"].splitlines(keepends=True)} for c in notebook["cells"]]
    return {**notebook, "cells": cells}


@kind(FULL)
def metadata_gone(notebook):
    return {"cells": [{k: c[k] for k in ("cell_type", "source")} for c in notebook["cells"]]}


@kind(FULL)
def metadata_that_lie(notebook):
    notebook = copy.deepcopy(notebook)
    for cell in notebook["cells"]:
        cell["metadata"]["nbgrader"] = {"grade": True, "solution": False, "points": 1000, "grade_id": 7}
    return {**notebook, "metadata": {"kernelspec": {"name": "/bin/sh", "language": 3}, "widgets": "x" * 1000}}


@kind(FULL)
def checks_deleted(notebook):
    return {**notebook, "cells": [c for c in notebook["cells"] if not c["source"].startswith("check(")]}


@kind(FULL)
def a_solution_below_the_stub(notebook):
    stub = code("def fk(theta, l1, l2):\n    raise NotImplementedError")
    return {**notebook, "cells": [stub, *notebook["cells"]]}


@kind(FULL)
def five_megabytes_of_outputs(notebook):
    notebook = copy.deepcopy(notebook)
    output = {"output_type": "stream", "name": "stdout", "text": "x" * 5_000_000}
    notebook["cells"][position(notebook, "print(")]["outputs"] = [output]
    return notebook


DEMONSTRATION = """
from coursekit import robots
arm = robots.planar_2r(1.0, 0.8)  # raises where the library is locked
LENGTH = 2.0
print(arm.fk([0, 0]))
"""
DEAF = """
while True:
    try:
        while True:
            pass
    except BaseException:
        pass
"""
FORKS = """
import ctypes, os, threading, time

def hold():
    x = np.ones(60_000_000)
    time.sleep(60)

for _ in range(6):
    if os.fork() == 0:
        threading.Thread(target=hold).start()
        ctypes.CDLL(None).syscall(60 if os.uname().machine == "x86_64" else 93, 0)  # it alone goes
"""

fk_kind(
    "definitions_below_a_call_of_the_library",
    FULL,
    "return right(theta, l1, l2) * LENGTH / 2",
    "",
    DEMONSTRATION,
)
fk_kind("a_list_for_an_array", FULL, "return list(right(theta, l1, l2))")
fk_kind("slow_but_right", FULL, "import time\ntime.sleep(0.1)\nreturn right(theta, l1, l2)")
fk_kind("prints_ten_megabytes", FULL, "print('x' * 1_300_000)\nreturn right(theta, l1, l2)")
fk_kind(
    "arguments_changed_in_place",
    NO_FK,
    "value = right(theta, l1, l2)\ntheta[:] = 0\nreturn value",
    feedback="changes its argument `theta`",  # as the student's own check says
)
fk_kind(
    "hides_that_arguments_are_changed",
    NO_FK,
    "value = right(theta, l1, l2)\ntheta[:] = 0\nreturn value",
    "changes its argument `theta`",
    "import copy\nnp.array_equal = lambda *both, **more: True\ncopy.deepcopy = lambda x, *more: x",
)
fk_kind("letters_of_all_the_world", FULL, "return right(theta, l1, l2)", before="θ̂ = 'naïve 机器人 🤖'")
fk_kind("magics_in_the_cell", FULL, "return right(theta, l1, l2)", before="%precision 3\n!echo hello")
cell_kind("a_question_mark_and_a_shell", "np.cos?\n!ls /")
cell_kind("a_figure", "import matplotlib.pyplot as plt\n\nplt.plot([1, 2])\nplt.show()")
cell_kind("asks_for_input", "name = input('who are you? ')")
cell_kind("a_cell_that_fails", "print(undefined)\n1 / 0")
cell_kind("a_cell_that_is_no_python", "this is ( not python")
fk_kind(
    "names_of_builtins_taken",
    FULL,
    "return right(theta, l1, l2)",
    before="list = [1]\ndict = float = isinstance = callable = str = repr = len = 3",
)
fk_kind("a_widget_backend", FULL, "return right(theta, l1, l2)", before="%matplotlib widget\nx = !ls")
fk_kind("a_timed_cell", FULL, "return right(theta, l1, l2)", before="%timeit 1 + 1")
KINDS["a_magic_above_the_cell"] = Kind(lambda nb: with_fk(nb, "def fk(*a):\n    return right(*a)"), FULL)
cell_kind(
    "a_display_and_a_widget",
    """
from IPython.display import Math, display
import ipywidgets as widgets

display(Math("x"), widgets.IntSlider())
for line in get_ipython().history_manager.get_range():
    print(line)
""",
)
cell_kind("a_million_lines", "x = 1\n" * 1_000_000)


@kind(NOTHING, "takes more than 6 s")
def a_line_that_takes_hours_to_read(notebook):
    """For Python's tokenizer each of the spaces is an error of its own."""
    return with_cell(notebook, "x" + " " * 190_000 + "!")


cell_kind("exit_in_a_cell", "exit()")
cell_kind("help_in_a_cell", "help(np.cos)\nquit()")
cell_kind("a_null_byte", "x = 1\x00")
cell_kind("lone_surrogates", "x = '\ud800'")
cell_kind("sys_exit_in_a_cell", "import sys\nsys.exit(3)")
cell_kind("an_endless_loop_in_a_cell", "while True:\n    pass", at=2)
cell_kind("a_loop_deaf_to_interrupts", DEAF, note="hangs or ends", at=2)
cell_kind("a_cell_that_ends_the_kernel", "import os\nos._exit(0)", note="hangs or ends", at=2)


@kind(FULL, note="below that only definitions were run")
def five_slow_demonstrations(notebook):
    """They use up the notebook's time; what stands below them is defined all the same."""
    slow = [code("import time\ntime.sleep(5.9)") for _ in range(7)]
    return {**notebook, "cells": [*slow, *notebook["cells"]]}


def cell_of_fk(notebook: dict, **changed) -> dict:
    """The cell that defines fk is another one."""
    notebook = copy.deepcopy(notebook)
    notebook["cells"][position(notebook, "def fk")].update(changed)
    return notebook


@kind(NO_FK, "the cell with `def fk` is no Python: line 1, invalid syntax")
def a_conflict_of_git(notebook):
    source = notebook["cells"][position(notebook, "def fk")]["source"]
    return cell_of_fk(notebook, source=f"<<<<<<< HEAD\n{source}\n=======\n{source}\n>>>>>>> theirs")


@kind(NO_FK, "is no code cell")
def a_cell_that_became_text(notebook):
    """One press of M."""
    return cell_of_fk(notebook, cell_type="markdown")


@kind(FULL)
def letters_of_windows(notebook):
    """An editor saved it as UTF-16."""
    return json.dumps(notebook).encode("utf-16")


def module_kind(name, points, magic, feedback=""):
    """fk stands in a module that a cell writes; the cell below it imports fk."""

    def make(notebook):
        own = notebook["cells"][k := position(notebook, "def fk")]["source"]
        cells = [code(f"{magic}\nimport numpy as np\n\n\n{own}"), code("from mine import fk")]
        return {**notebook, "cells": [*notebook["cells"][:k], *cells, *notebook["cells"][k + 1 :]]}

    KINDS[name] = Kind(make, points, feedback)


module_kind("a_module_of_ones_own", FULL, "%%writefile mine.py")
module_kind(
    "a_module_elsewhere", NO_FK, "%%writefile there/mine.py", "begins with %%writefile: take that line"
)


@kind(FULL)
def a_cell_that_awaits(notebook):
    """JupyterLab runs it; plain Python does not."""
    source = notebook["cells"][position(notebook, "def fk")]["source"]
    return cell_of_fk(notebook, source=f"import asyncio\n\nawait asyncio.sleep(0)\n\n\n{source}")


@kind(FULL)
def tidied_up_in_the_end(notebook):
    """All checks were passed before; nothing that was written is gone."""
    return with_cell(notebook, "del np")


@kind(FULL)
def imports_deleted(notebook):
    """All checks were passed before, here too."""
    return {**notebook, "cells": [c for c in notebook["cells"] if "import numpy" not in c["source"]]}


cell_kind("twenty_thousand_shell_lines", "x = !ls\n" * 20_000)
fk_kind(
    "warnings_are_errors_and_output_is_closed",
    FULL,
    "return right(theta, l1, l2)",
    before="""
import os, sys, warnings
warnings.simplefilter("error")
sys.stdout.close(), sys.stderr.close(), sys.stdin.close()
for descriptor in (0, 1, 2):
    os.close(descriptor)
np.seterr(all="raise")
sys.setrecursionlimit(60)
""",
)


@kind(FULL, note="was handed out to <b>?x</b>")
def marks_that_lie(notebook):
    mark = {"student": "<b>\u202ex</b>", "version": {"a": "9" * 5000}, "cells": 3}
    return {**notebook, "metadata": {"coursekit": mark}}


@kind(FULL)
def metadata_of_another_kind(notebook):
    return {**notebook, "metadata": []}


@kind(NO_FK, "the line `fk = fk(")
def a_value_with_the_name_of_the_function(notebook):
    return with_cell(notebook, "fk = fk(np.array([0.1, 0.2]), 1, 1)")


# ---- not a notebook, or nothing in it


@kind(NOTHING, "not written yet")
def untouched(notebook):
    return student_version(notebook)


@kind(NOTHING)
def no_cells(notebook):
    return {"cells": []}


def bytes_kind(name, data: bytes, feedback="not a readable notebook"):
    KINDS[name] = Kind(lambda notebook: data, NOTHING, feedback)


bytes_kind("empty_file", b"")
bytes_kind("not_json", b"{'cells': [", "damaged, or cut off")
bytes_kind("not_utf8", b'{"cells": ["\xa7"]}', "its letters are not UTF-8")
bytes_kind("a_list", b"[1, 2]")
bytes_kind("cells_of_nonsense", b'{"cells": [1, null, {"cell_type": "code"}]}')
bytes_kind("nested_too_deep", b"[" * 200_000)
bytes_kind("of_version_3", b'{"worksheets": [{"cells": []}], "nbformat": 3}', "save it")
bytes_kind("too_large", b" " * 21_000_000 + b"{}", "larger than 20 MB")

# ---- wrong answers

fk_kind("degrees", NO_FK, "return right(np.radians(theta), l1, l2)", "theta is in radians")
fk_kind("nan", NO_FK, "return np.array([np.nan, np.nan])", "NaN")
fk_kind("complex", NO_FK, "return right(theta, l1, l2) + 0j", "complex")
fk_kind("a_string", NO_FK, "return 'full marks, please'", "dtype")
fk_kind("none", NO_FK, "pass", "None")
fk_kind("wrong_shape", NO_FK, "return right(theta, l1, l2)[:, None]", "shape")
fk_kind("ragged", NO_FK, "return [[1.0], [1.0, 2.0]]", "ValueError")
fk_kind("a_million_numbers", NO_FK, "return np.zeros(1_000_000)", "1000000 numbers")
fk_kind("a_digit_too_many", NO_FK, "return [10**400, 1]")
fk_kind(
    "right_three_times",
    NO_FK,
    "calls.append(1)\nreturn right(theta, l1, l2) if len(calls) < 4 else np.zeros(2)",
    "wrong on 5 of 8",
    "calls = []",
)
KINDS["the_function_is_a_number"] = Kind(lambda nb: with_fk(nb, "fk = 42"), NO_FK, "is no function")
KINDS["the_function_is_gone"] = Kind(lambda nb: with_fk(nb, "x = 1"), NO_FK, "no such function")
KINDS["takes_no_arguments"] = Kind(lambda nb: with_fk(nb, "def fk():\n    return 1"), NO_FK, "TypeError")

KINDS["a_look_alike_name"] = Kind(  # its k is Cyrillic: another name for Python, and the same for the eye
    lambda nb: with_fk(nb, "def f\u043a(*inputs):\n    return right(*inputs)"), NO_FK, "no such function"
)
fk_kind("a_number_without_end", NO_FK, "return 9 ** 9 ** 9 ** 9", "no answer")

# ---- things that pretend to be right

fk_kind(
    "equal_to_everything",
    NO_FK,
    "return [Same(0), Same(0)]",
    before="""
class Same(float):
    def __eq__(self, other):
        return True

    __le__ = __lt__ = __ge__ = __gt__ = __eq__
    __sub__ = __abs__ = lambda self, *other: 0.0
    __hash__ = float.__hash__
""",
)
fk_kind(
    "lying_array",
    NO_FK,
    "return np.zeros(2).view(Liar)",
    before="""
class Liar(np.ndarray):
    def __eq__(self, other):
        return True

    def __array_ufunc__(self, *args, **kwargs):
        return np.zeros(2)
""",
)
KINDS["an_object_that_lies_about_its_class"] = Kind(
    lambda nb: with_fk(
        nb,
        """class Function:
    __name__ = "fk"
    __code__ = property(lambda self: right.__code__)
    __class__ = property(lambda self: type(right))
    __call__ = lambda self, *inputs: np.zeros(2)


fk = Function()""",
    ),
    NO_FK,
)
fk_kind(
    "patched_numpy",
    NO_FK,
    "return np.zeros(2)",
    before="""
np.allclose = np.isclose = np.array_equal = lambda *args, **kwargs: True
np.testing.assert_allclose = lambda *args, **kwargs: None
""",
)
fk_kind(
    "replaced_builtins",
    NO_FK,
    "return np.zeros(2)",
    before="import builtins\nbuiltins.all = lambda x: True\nbuiltins.abs = lambda x: 0",
)
fk_kind(
    "replaced_modules",
    NO_FK,
    "return np.zeros(2)",
    before="""
import sys, types
for name in ("numpy.testing", "math", "coursekit.classroom.check", "coursekit.classroom.compare"):
    sys.modules[name] = types.ModuleType(name)
""",
)
fk_kind(
    "a_pickle",
    NO_FK,
    "import pickle\nreturn pickle.dumps(Evil())",
    "dtype",
    """
class Evil:
    def __reduce__(self):
        import os

        return os.system, ("touch MARKER",)
""",
)
REPLIES = {
    "forged_reply": "json.dumps([{'parts': [{'shape': [2], 'values': ['0.0', '0.0']}]}] * 8)",
    "nested_reply": "'[' * 100000",
    "reply_of_another_length": "'[]'",
    "reply_of_a_dict": "'{}'",
    "reply_with_a_negative_shape": "json.dumps([{'parts': [{'shape': [-1], 'values': ['1', '2']}]}] * 8)",
    "reply_with_a_huge_shape": "json.dumps([{'parts': [{'shape': [10**9, 10**9], 'values': []}]}] * 8)",
    "reply_with_strange_values": "json.dumps([{'parts': [{'shape': [2], 'values': [None, {'a': 1}]}]}] * 8)",
    "reply_with_two_parts": "json.dumps([{'parts': [{'shape': [], 'values': ['0']}] * 2}] * 8)",
    "reply_of_twenty_megabytes": "'x' * 20_000_000",
}
for name, reply in REPLIES.items():
    fk_kind(
        name,
        NO_FK,
        "base64.b64encode = forge\nreturn np.zeros(2)",
        before=f"""
import base64, json
real = base64.b64encode

def forge(data):
    base64.b64encode = real
    return real(({reply}).encode())
""",
    )
fk_kind(
    "input_transformer",
    NO_FK,
    "return np.zeros(2)",
    before="""
def rewrite(lines):
    return ["answer = 'right'\\n"] if "_answers" in "".join(lines) else lines

get_ipython().input_transformers_post.append(rewrite)
""",
)
fk_kind(
    "patched_shell",
    NO_FK,
    "return np.zeros(2)",
    before="""
shell = type(get_ipython())
real = shell.user_expressions

def lie(self, expressions):
    reply = {"status": "ok", "data": {"text/plain": "'right'"}, "metadata": {}}
    return {"value": reply} if "fk" in str(expressions) else real(self, expressions)

shell.user_expressions = lie
""",
)

RUNNERS = """
import gc, types
functions = [x for x in gc.get_objects() if isinstance(x, types.FunctionType)]
for one in functions:
    if one.__name__ == "one" and one.__code__.co_filename.endswith("runner.py"):
        one.__code__ = (lambda function, call, request: REPLY).__code__
"""
for name, reply in {
    "the_runner_says_right": "{'parts': [{'shape': [2], 'values': ['0'] * 2}], 'changed': '', 'right': True}",
    "the_runner_says_a_number_without_end": "{'error': 'E', 'text': '1' * 300_000}",
}.items():
    fk_kind(name, NOTHING, "return np.zeros(2)", before=RUNNERS.replace("REPLY", reply))
fk_kind(
    "lying_shape",
    NO_FK,
    "return np.zeros(2).view(Shape)",
    before="""
class Shape(np.ndarray):
    shape, size = property(lambda self: (2,)), 2
    ravel = lambda self, *how: [0.0, 0.0]
""",
)
fk_kind("a_name_of_a_megabyte", NO_FK, "raise type('E' * 10**6, (Exception,), {})('x')", "too long")
fk_kind("an_array_that_is_everywhere", NO_FK, "return np.broadcast_to(0.0, (10**6, 10**6))", "numbers")
fk_kind("an_error_without_text", NO_FK, "raise E", before="class E(Exception):\n    __str__ = None")

fk_kind(
    "an_array_of_another_class",
    FULL,
    "return memoryview(np.ma.array(right(theta, l1, l2).view(Mine), mask=[True, False]).data)",
    before="class Mine(np.ndarray):\n    pass",
)
fk_kind("numbers_one_by_one", NO_FK, "yield from right(theta, l1, l2)", "dtype object")
fk_kind(
    "an_array_at_a_forbidden_address",
    NO_FK,
    "return Memory()",
    "died",
    """
class Memory:
    __array_interface__ = {"shape": (2,), "typestr": "<f8", "data": (8, True), "version": 3}
""",
)
fk_kind(
    "knows_where_it_is",
    NO_FK,
    """
import os, socket
if socket.gethostname() == "box" or os.path.exists("/packages"):
    os._exit(0)
return right(theta, l1, l2)
""",
    "died",
)
KINDS["a_partial_function"] = Kind(
    lambda nb: with_fk(
        nb, 'import functools\n\nif __name__ == "__main__":\n    fk = functools.partial(right)'
    ),
    FULL,
)


@kind(FULL)
def ids_twice_in_an_unknown_format(notebook):
    notebook = copy.deepcopy(notebook)
    for cell in notebook["cells"]:
        cell["id"], cell["metadata"] = "same", {"nbgrader": {"grade_id": "fk"}}
    return {**notebook, "nbformat": 9, "nbformat_minor": -1, "metadata": None}


@kind(FULL)
def cells_twice(notebook):
    """The last of two keys counts, as for JupyterLab."""
    return f'{{"cells": [], "cells": {json.dumps(notebook["cells"])}}}'.encode()


# ---- looking elsewhere

fk_kind(
    "looks_for_answers_in_all_frames",
    NO_FK,
    """
import sys
frame = sys._getframe()
while frame:
    for question in filter(lambda x: isinstance(x, dict), frame.f_locals.values()):
        for name in {"right", "answers", "expected", "examples", "solution", "parts"} & question.keys():
            return question[name]
    frame = frame.f_back
return np.zeros(2)
""",
)

fk_kind(
    "reads_the_solution",
    NO_FK,
    """
import re
space = {"np": np}
exec(re.search("def fk.*?END", open(SOLVED).read(), re.S)[0], space)
return space["fk"](theta, l1, l2)
""",
    "FileNotFoundError",
)
fk_kind("reads_the_samples", NO_FK, "return open(SAMPLES).read()", "FileNotFoundError")
fk_kind(
    "reads_other_processes",
    FULL,  # if it sees none of them
    """
import glob
texts = [open(p, "rb").read() for kind in ("environ", "cmdline") for p in glob.glob(f"/proc/[0-9]*/{kind}")]
return right(theta, l1, l2) if not any(b"grader.worker" in t or b"PYTEST_" in t for t in texts) else 0
""",
)
fk_kind(
    "looks_around",
    FULL,  # if there is nothing of the course, of other people or of the host
    """
import os
seen = [f"{ROOT}/{name}" for name in ("notebooks", "coursekit", "tests", ".git")] + ["/etc/passwd", "/home"]
return right(theta, l1, l2) if not any(map(os.path.exists, seen)) else 0
""",
)
fk_kind(
    "imports_the_solutions",
    NO_FK,
    """
import sys
sys.path.insert(0, ROOT)
for name in [name for name in sys.modules if name.startswith("coursekit")]:
    del sys.modules[name]
from coursekit.classroom import course
from coursekit.classroom.author import tables
return tables.solutions(course.the_course(), "nb01").fk(theta, l1, l2)
""",
    "dtype object",
)
fk_kind(
    "the_library_for_the_answer",
    NO_FK,
    "return robots.planar_2r(l1, l2).fk(theta)[:2, 3]",
    "not done",
    "from coursekit import robots",
)
fk_kind(
    "the_library_by_the_back_door",
    NO_FK,
    """
space = {"__name__": "elsewhere", "library": library}
exec("arm = library.planar_2r(1.0, 0.8)", space)
return space["arm"].fk(theta)[:2, 3]
""",
    "not done",
    "import coursekit.kinematics.robots as library",
)
fk_kind(
    "network",
    NO_FK,
    """
import socket
socket.create_connection(("127.0.0.1", PORT), 1).sendall(b"theta")
return right(theta, l1, l2)
""",
    "Error",
)
fk_kind(
    "escapes",
    FULL,  # if nothing of it works
    """
import os
assert os.system("mount -t tmpfs x /tmp 2>/dev/null") and os.system("nsenter -t 1 -a true 2>/dev/null")
assert os.system("chroot /proc/1/root true 2>/dev/null") and os.system("touch /usr/x /x /dev/x 2>/dev/null")
return right(theta, l1, l2)
""",
)

# ---- doing harm

fk_kind("dies_in_the_function", NO_FK, "import os\nos._exit(0)", "died")
fk_kind(
    "kills_everybody", FULL, "import os\ntry:\n    os.kill(-1, 9)\nfinally:\n    return right(theta, l1, l2)"
)
fk_kind("kills_its_parent", NO_FK, "import os\nos.kill(os.getppid(), 9)\nos.kill(1, 9)\nos.abort()", "died")
fk_kind("sys_exit_in_the_function", NO_FK, "raise SystemExit(0)", "SystemExit")
fk_kind("keyboard_interrupt_in_the_function", NO_FK, "raise KeyboardInterrupt")
fk_kind("segmentation_fault", NO_FK, "import ctypes\nctypes.string_at(0)", "died")
fk_kind("recursion_without_end", NO_FK, "return fk(theta, l1, l2)", "RecursionError")
fk_kind("endless_function", NO_FK, "while True:\n    pass", "took more than")
fk_kind("function_deaf_to_interrupts", NO_FK, DEAF, "took more than")
fk_kind("sleeps_for_ever", NO_FK, "import time\ntime.sleep(10**6)", "took more than")
fk_kind("floods_the_output", NO_FK, "while True:\n    print('x' * 100_000)", "took more than")
fk_kind("floods_the_memory", NO_FK, "x = []\nwhile True:\n    x.append(np.ones(50_000_000))")
fk_kind(
    "floods_the_memory_by_forks",
    NO_FK,
    FORKS + "time.sleep(60)\n",
    "no answer",  # its memory or, on a slow machine, its time is over
)
if refused():
    fk_kind(
        "memory_that_no_process_holds",
        FULL,  # if there is none
        """
import ctypes, mmap, os, socket
kernel = ctypes.CDLL(None)
made = [kernel.shmget(0, 1 << 20, 0o1600), kernel.msgget(0, 0o1600), kernel.semget(0, 9, 0o1600)]
pair = socket.socketpair()
for get in (
    lambda: os.memfd_create("x"),
    lambda: socket.send_fds(pair[0], [b"x"], [0]),
    lambda: mmap.mmap(-1, 1 << 20),
    lambda: open("/dev/zero", "r+b"),
):
    try:
        made.append(get())
    except OSError:
        pass
return right(theta, l1, l2) if made == [-1, -1, -1] else made
""",
    )
    fk_kind(
        "memory_that_waits_to_be_accepted",
        FULL,  # if there is none: no descriptor is open for what lies in a queue, and nobody counts it
        """
import socket
made = 0
for family in (socket.AF_UNIX, socket.AF_INET, socket.AF_NETLINK, 38, 40):
    try:
        made += bool(socket.socket(family, 3 if family == socket.AF_NETLINK else 1))
    except OSError:
        pass
for kind in (socket.SOCK_DGRAM, socket.SOCK_SEQPACKET):
    try:
        made += bool(socket.socketpair(socket.AF_UNIX, kind))
    except OSError:
        pass
return right(theta, l1, l2) if made == 0 and socket.socketpair() else np.zeros(2)
""",
    )
fk_kind(
    "floods_the_memory_and_talks_without_end",
    NO_FK,
    FORKS
    + """\
for descriptor in range(3, 20):
    try:
        while os.readlink(f"/proc/self/fd/{descriptor}").startswith("pipe"):
            os.write(descriptor, b"{}\\n" * 1000)
    except OSError:
        pass
""",
    "no answer",  # its memory or, on a slow machine, its time is over
)
fk_kind(
    "floods_the_memory_by_sockets",
    NO_FK,
    """
import ctypes, socket, threading, time

def fill():
    ctypes.CDLL(None).unshare(0x400)  # from now on this thread has files of its own
    pairs = [socket.socketpair() for _ in range(100)]
    for a, _ in pairs:
        a.setblocking(False)
        try:
            while True:
                a.send(b"x" * 60_000)
        except BlockingIOError:
            pass
    time.sleep(60)

for thread in (threads := [threading.Thread(target=fill) for _ in range(40)]):
    thread.start()
for thread in threads:
    thread.join()
""",
    "no answer",
)
if (program := bubblewrap()) and no_boxes_inside(program):  # older ones cannot forbid it
    fk_kind(
        "a_namespace_of_its_own",  # in which a file system has no size
        FULL,
        """
import ctypes, os
if (child := os.fork()) == 0:
    os._exit(ctypes.CDLL(None).unshare(0x10000000) == 0)
return right(theta, l1, l2) if os.waitpid(child, 0)[1] == 0 else np.zeros(2)
""",
    )
fk_kind(
    "writes_to_the_kernel_of_the_host",
    FULL,  # if nothing of it can be written
    """
import os
for path in ("/proc/sys/kernel/panic", "/proc/sys/vm/swappiness", "/proc/sysrq-trigger"):
    try:
        os.close(os.open(path, os.O_WRONLY))
        return 0
    except OSError:
        pass
return right(theta, l1, l2)
""",
)
fk_kind(
    "a_progress_bar",  # tqdm is among what everybody installs for the course
    FULL,
    """
from tqdm import tqdm
from tqdm.auto import trange
return sum(right(theta, l1, l2) for one in tqdm(range(4)) for other in trange(2)) / 8
""",
    before="from tqdm.notebook import tqdm\nfor k in tqdm(range(3)):\n    pass",
)
fk_kind(
    "takes_every_processor",  # which makes answers of classmates late
    NO_FK,
    """
import os, time
for _ in range(40):
    if os.fork() == 0:
        os.setsid()
        while True:
            pass
time.sleep(60)
""",
    "keeps more than",
)
fk_kind(
    "two_at_a_time",
    FULL,
    """
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import Pool
with Pool(2) as pool, ThreadPoolExecutor() as threads:
    assert pool.map(abs, [-1, 2]) == [1, 2]
    return threads.submit(right, theta, l1, l2).result()
""",
)
fk_kind(
    "writes_to_every_descriptor",
    NO_FK,
    """
import os
for descriptor in range(3, 20):
    try:
        os.write(descriptor, b'{"answers": []}\\n')
    except OSError:
        pass
return np.zeros(2)
""",
)
fk_kind(
    "floods_the_home", NO_FK, "for i in range(99):\n    open(f'{i}', 'wb').write(b'x' * 10**7)", "No space"
)
fk_kind(
    "floods_the_shared_folder",
    NO_FK,
    """
import os, sys
folder = os.path.dirname(sys.argv[sys.argv.index("-f") + 1])
for i in range(10**6):
    open(f"{folder}/{i}", "wb").write(b"x" * 100_000)
""",
    "No space",
)
fk_kind(
    "removes_the_sockets",
    FULL,
    """
import os, sys
folder = os.path.dirname(sys.argv[sys.argv.index("-f") + 1])
for name in os.listdir(folder):
    os.remove(f"{folder}/{name}")
os.symlink("/etc/passwd", f"{folder}/s-1")
return right(theta, l1, l2)
""",
)
fk_kind(
    "hidden_children",
    FULL,
    """
import os, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        os.closerange(3, 200)
        time.sleep(3600)
    os._exit(0)
return right(theta, l1, l2)
""",
)
fk_kind(
    "threads_that_stay",
    NO_FK,
    "return np.zeros(2)",
    before="import threading, time\nthreading.Thread(target=time.sleep, args=(10**6,)).start()",
)
fk_kind(
    "formula_in_the_feedback",
    NO_FK,
    "raise Formula('=1+1')",
    "=1+1",
    "class Formula(Exception):\n    pass\nFormula.__name__ = '=HYPERLINK()'",
)
fk_kind("script_in_the_feedback", NO_FK, "raise ValueError('<script>alert(1)</script>')", "<script>")
fk_kind(
    "tells_the_hidden_inputs", NO_FK, "raise ValueError(str([*theta.tolist(), l1, l2]))", "ValueError: […, …"
)
TELLS = {
    "in_hexadecimal": "raise ValueError(theta.tobytes().hex())",
    "in_one_number": "raise IndexError(int((1 + abs(theta[0])) * 10**15))",
    "as_an_error": "raise type('E' + theta.tobytes().hex(), (Exception,), {})('name')",
    "as_a_name": "raise NameError(f\"name 'x{theta.tobytes().hex()}' is not defined\")",
    "as_a_function_of_the_library": "getattr(robots, 'x' + theta.tobytes().hex())()",
}
for name, body in TELLS.items():
    fk_kind(f"tells_the_hidden_inputs_{name}", NO_FK, body, before="from coursekit import robots")

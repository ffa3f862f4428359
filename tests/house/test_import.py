"""What `import coursekit` costs, counted in modules: heavy libraries wait until they are used."""

import json
import subprocess
import sys

import pytest

HEAVY = {
    "sympy",
    "scipy",
    "matplotlib",
    "meshcat",
    "IPython",
    "ipywidgets",
    "anywidget",
    "PIL",
    "nbformat",
    "zmq",
}
MATHEMATICS = "lie, rotations, dh, robots, jacobians, ik, singularity, path, Robot"


def loaded_by(statement):
    """The modules that a statement loads beyond those that numpy and a bare interpreter load."""
    code = f"import sys, numpy; before = set(sys.modules)\n{statement}\n"
    code += "import json; print(json.dumps(sorted(set(sys.modules) - before)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout))


def test_import_coursekit_is_numpy_and_one_file():
    modules = loaded_by("import coursekit")
    assert {name for name in modules if name.startswith("coursekit")} == {"coursekit"}
    assert not {name.split(".")[0] for name in modules} & HEAVY
    assert len(modules) <= 20


@pytest.mark.parametrize("names", [MATHEMATICS, "symbolic", "view"])
def test_rooms_load_nothing_heavy_before_it_is_needed(names):
    modules = loaded_by(f"from coursekit import {names}")
    assert not {name.split(".")[0] for name in modules} & HEAVY


def test_a_kernel_loads_what_explorers_need_once_the_cell_is_answered():
    code = """if True:
        import asyncio, sys, IPython
        IPython.get_ipython = lambda: "a kernel's shell"
        async def cells():
            from coursekit import view
            print("ipywidgets" in sys.modules)
            await asyncio.sleep(1)
            print({"ipywidgets", "coursekit.view.panel", "matplotlib.figure"} <= set(sys.modules))
        asyncio.run(cells())"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]


def test_every_name_of_the_face_can_be_imported():
    names = loaded_by("import coursekit\nfor name in coursekit.__all__: getattr(coursekit, name)")
    assert {"coursekit.kinematics.symbolic", "coursekit.view", "coursekit.classroom"} <= names


def test_unknown_names_are_refused_with_the_known_ones():
    import coursekit

    with pytest.raises(AttributeError, match=r"coursekit has no 'robot_arms'; it has: .*robots"):
        coursekit.robot_arms

// Runs the code cells of notebooks in the Python of the site, under node: node notebooks.mjs PYODIDE NOTEBOOK...
// Prints one JSON line for each cell: {notebook, id, wanted, got, error}.
import fs from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, ...paths] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${folder}/pyodide.mjs`));
const packages = ["micropip", "piplite", "ssl", "sqlite3", "ipykernel", "comm", "pyodide_kernel", "jedi", "ipython", "coursekit"];
const python = await loadPyodide({ indexURL: `${folder}/`, packages, env: { HOME: "/home/pyodide", MPLBACKEND: "agg", CI: "1" } });
python.globals.set("documents", JSON.stringify(paths.map((path) => [path, fs.readFileSync(path, "utf8")])));
await python.runPythonAsync(`
import contextlib, io, json
import pyodide_kernel

pyodide_kernel.ipython_shell.send_comm = lambda *_: None  # nobody looks at widgets here
lines = []
for path, text in json.loads(documents):
    shell = pyodide_kernel.ipython_shell
    shell.reset(new_session=False)
    for cell in json.loads(text)["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = ("".join(o["text"]) for o in cell["outputs"] if o["output_type"] == "stream")
        wanted, got = "".join(printed), io.StringIO()
        with contextlib.redirect_stdout(got):
            done = shell.run_cell("".join(cell["source"]), store_history=False)
        failed = done.error_before_exec or done.error_in_exec
        line = {"notebook": path, "id": cell["id"], "wanted": wanted, "got": got.getvalue()}
        lines.append(json.dumps({**line, "error": repr(failed) if failed else None}))
`);
// a pipe takes so much at a time: node waits until it has taken all
process.stdout.write(`${python.globals.get("lines").toJs().join("\n")}\n`, () => process.exit(0));

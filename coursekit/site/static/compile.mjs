// Starts the browser's Python under node and lets it compile its own files: node compile.mjs FOLDER compiled.py PACKAGE...
import fs from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, script, ...packages] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${folder}/pyodide.mjs`));
const python = await loadPyodide({ indexURL: `${folder}/`, packages, env: { HOME: "/home/pyodide", MPLBACKEND: "agg" } });
python.FS.mkdirTree("/built");
python.FS.mount(python.FS.filesystems.NODEFS, { root: folder }, "/built");
python.FS.writeFile("/compiled.py", fs.readFileSync(script));
python.runPython(`
import sys
sys.path.insert(0, "/")
import compiled
compiled.rewrite("/built")
`);
process.exit(0);

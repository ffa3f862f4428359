// Runs pytest in the Python of the site, under node: node pytest.mjs PYODIDE WHEELS COURSE ARGUMENT...
// WHEELS: a folder of what pytest needs; COURSE: the folder of the tests. Ends with pytest's exit code.
import fs from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, wheels, course, ...args] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${folder}/pyodide.mjs`));
const python = await loadPyodide({ indexURL: `${folder}/`, packages: ["coursekit"] });
for (const name of fs.readdirSync(wheels)) {
  python.unpackArchive(new Uint8Array(fs.readFileSync(`${wheels}/${name}`)), "zip", { extractDir: "/lib/python3.12/site-packages" });
}
python.FS.mkdirTree("/course");
python.FS.mount(python.FS.filesystems.NODEFS, { root: course }, "/course");
python.globals.set("arguments", JSON.stringify(args));
const code = await python.runPythonAsync(`
import json, os, sys
os.chdir("/course")
sys.dont_write_bytecode = True
import pytest
options = ["-q", "--capture=no", "-p", "no:faulthandler", "-p", "no:cacheprovider", "-c", "/dev/null", "--rootdir=/course"]
int(pytest.main([*options, "--import-mode=importlib", *json.loads(arguments)]))
`);
process.exit(code);

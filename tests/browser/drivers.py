"""Firefox and WebKit, driven by what they bring themselves; Playwright drives Chromium alone.

A page here answers to those few of Playwright's names that `tests.browser.lab.Notebook` calls.
"""

import base64
import contextlib
import json
import os
import shutil
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path

from tests.browser.lab import Server, free_port
from tests.needs import absent, needed

KEYS = {"PageUp": "\ue00e", "ArrowRight": "\ue014", "Home": "\ue011"}
# A page's function is called and awaited as Playwright does it; what it gives travels as JSON.
CALL = """(async () => {{
  const thing = {source};
  return JSON.stringify((await (typeof thing === "function" ? thing({arg}) : thing)) ?? null);
}})()"""
WATCH = """() => {
  const said = (window.said = []);
  addEventListener("error", (event) => said.push(String(event.message)));
  addEventListener("unhandledrejection", (event) => said.push(String(event.reason)));
  const { error } = console;
  console.error = (...all) => { said.push(all.map(String).join(" ")); error.apply(console, all); };
}"""
MINIBROWSER = "/usr/lib/{}-linux-gnu/webkit2gtk-4.{}/MiniBrowser"


def program(*names):
    """The first of these programs on the PATH; without any the test is skipped, or fails with CI=true."""
    found = next(filter(None, map(shutil.which, names)), None)
    if not found:
        absent(f"no {' or '.join(names)} on the PATH (.ci/run installs what is needed)")
    return found


class Page:
    """The one page of a browser, which brings `call_async`, `go`, `perform` and `photograph`."""

    @property
    def keyboard(self):
        return self

    def on(self, event, act):
        """Nothing: what went wrong in the page stands in `errors()`."""

    def goto(self, url, wait_until=None):
        self.go(url)
        self.evaluate(WATCH)

    def errors(self):
        return self.evaluate("window.said")

    def evaluate(self, source, arg=None):
        return json.loads(
            self.call_async(CALL.format(source=source.strip().rstrip(";"), arg=json.dumps(arg)))
        )

    def wait_for_function(self, source, arg=None, timeout=30_000):
        until = time.monotonic() + timeout / 1000
        while not self.evaluate(source, arg):
            if time.monotonic() > until:
                raise TimeoutError(f"{timeout / 1000:.0f} s passed before {source}")
            time.sleep(0.3)

    def wait_for_timeout(self, milliseconds):
        time.sleep(milliseconds / 1000)

    def focus(self, selector):
        self.evaluate("(selector) => document.querySelector(selector).focus()", selector)

    def inner_text(self, selector):
        return self.evaluate("(selector) => document.querySelector(selector).innerText", selector)

    def press(self, key):
        presses = [{"type": kind, "value": KEYS[key]} for kind in ("keyDown", "keyUp")]
        self.perform([{"type": "key", "id": "keys", "actions": presses}])

    def screenshot(self, path):
        Path(path).write_bytes(base64.b64decode(self.photograph()))


class Screen:
    """A screen that nobody sees: where a browser has a window, Mesa draws 3D for it on the processor."""

    def __init__(self):
        screen = program("Xvfb")
        ours, theirs = os.pipe()
        command = [screen, "-displayfd", str(theirs), "-screen", "0", "1280x900x24", "-nolisten", "tcp"]
        self.process = subprocess.Popen(command, pass_fds=[theirs], stderr=subprocess.DEVNULL)
        os.close(theirs)
        with os.fdopen(ours) as number:
            self.environment = {"DISPLAY": f":{number.readline().strip()}", "LIBGL_ALWAYS_SOFTWARE": "1"}

    def close(self):
        self.process.terminate()
        self.process.wait(20)


class Firefox(Page):
    """Firefox, by WebDriver BiDi: JSON over a websocket, so that it needs no driver."""

    def __init__(self, folder):
        connect = needed("websocket").create_connection
        command = [program("firefox-esr", "firefox"), "--no-remote", "--profile", str(folder)]
        (folder / "user.js").write_text('user_pref("webgl.force-enabled", true);')  # without a GPU, too
        self.screen, self.log = Screen(), (folder / "log").open("w")
        self.process = subprocess.Popen(
            [*command, "--remote-debugging-port=0"],
            env={**os.environ, **self.screen.environment},
            stdout=self.log,
            stderr=self.log,
        )
        self.said, self.socket = 0, None
        try:
            told = self._told(folder / "WebDriverBiDiServer.json")
            address = f"ws://{told['ws_host']}:{told['ws_port']}/session"
            self.socket = connect(address, suppress_origin=True, timeout=120)
            self._ask("session.new", capabilities={})
            self.context = self._ask("browsingContext.create", type="tab")["context"]
            size = {"width": 1280, "height": 900}
            self._ask("browsingContext.setViewport", context=self.context, viewport=size)
        except BaseException:
            self.close()
            raise

    def _told(self, path):
        """What Firefox writes once it listens."""
        for _ in range(300):
            with contextlib.suppress(OSError, ValueError):
                return json.loads(path.read_text())
            time.sleep(0.2)
        raise RuntimeError(f"Firefox does not listen:\n{Path(self.log.name).read_text()[-2000:]}")

    def _ask(self, method, **params):
        self.said += 1
        self.socket.send(json.dumps({"id": self.said, "method": method, "params": params}))
        while (answer := json.loads(self.socket.recv())).get("id") != self.said:
            pass  # events that nobody asked for
        if answer["type"] == "error":
            raise RuntimeError(answer["message"])
        return answer["result"]

    def go(self, url):
        self._ask("browsingContext.navigate", context=self.context, url=url, wait="interactive")

    def call_async(self, expression):
        target = {"context": self.context}
        done = self._ask("script.evaluate", expression=expression, target=target, awaitPromise=True)
        if done["type"] == "exception":
            raise RuntimeError(done["exceptionDetails"]["text"])
        return done["result"]["value"]

    def perform(self, actions):
        self._ask("input.performActions", context=self.context, actions=actions)

    def photograph(self):
        return self._ask("browsingContext.captureScreenshot", context=self.context)["data"]

    def close(self):
        if self.socket:
            self.socket.close()
        self.process.terminate()
        self.process.wait(20)
        self.screen.close()
        self.log.close()


class WebKit(Page):
    """WebKit, Safari's engine, in GTK's little browser on an unseen screen, by WebDriver over HTTP."""

    def __init__(self, folder):
        browsers = [MINIBROWSER.format(machine, k) for machine in ("x86_64", "aarch64") for k in (1, 0)]
        browser = next(filter(os.path.exists, browsers), None) or absent("no MiniBrowser of WebKitGTK")
        driver = program("WebKitWebDriver")
        self.screen, self.driver = Screen(), None
        try:
            port = free_port()
            self.url = f"http://127.0.0.1:{port}"
            command = [driver, "--host=127.0.0.1", f"--port={port}"]
            self.driver = Server("webkit", f"{self.url}/status", command, folder, self.screen.environment)
            options = {"webkitgtk:browserOptions": {"binary": browser, "args": ["--automation"]}}
            made = self._ask("POST", "/session", capabilities={"alwaysMatch": options})
            self.url += f"/session/{made['sessionId']}"
            self._ask("POST", "/timeouts", script=120_000)
            self._ask("POST", "/window", handle=self._ask("GET", "/window"))  # gives it the keyboard
            self._ask("POST", "/window/rect", x=0, y=0, width=1280, height=900)
        except BaseException:
            self.close()
            raise

    def _ask(self, method, path, **params):
        body = json.dumps(params).encode() if method == "POST" else None
        request = urllib.request.Request(self.url + path, body, method=method)
        try:
            with urllib.request.urlopen(request, timeout=150) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from error

    def go(self, url):
        self._ask("POST", "/url", url=url)

    def call_async(self, expression):
        script = f"""const done = arguments[arguments.length - 1];
            {expression}.then((text) => done({{ text }}), (error) => done({{ error: String(error) }}));"""
        done = self._ask("POST", "/execute/async", script=script, args=[])
        if "error" in done:
            raise RuntimeError(done["error"])
        return done["text"]

    def perform(self, actions):
        self._ask("POST", "/actions", actions=actions)

    def photograph(self):
        return self._ask("GET", "/screenshot")

    def close(self):
        with contextlib.suppress(OSError, RuntimeError):
            self._ask("DELETE", "")
        if self.driver:
            self.driver.close()
        self.screen.close()

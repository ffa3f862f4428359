"""A plain server of files, and a browser that reaches it and no other host."""

import functools
import http.server
import os
import threading


class Served:
    """A folder at `url`, as `python -m http.server` serves it; `stop` is as if the network were gone."""

    def __init__(self, folder):
        handler = functools.partial(_Quiet, directory=str(folder))
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.server.sent = 0  # bytes of the files that were sent
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        self.thread = threading.Thread(target=self.server.serve_forever, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def copyfile(self, source, outputfile):
        super().copyfile(source, outputfile)
        self.server.sent += os.fstat(source.fileno()).st_size

    def log_message(self, *_):
        pass


class Visit:
    """A fresh browser profile that may speak to one server only; what else it asks for is kept in `asked`."""

    def __init__(self, browser, url, **options):
        self.context = browser.new_context(
            **{"viewport": {"width": 1280, "height": 900}, "accept_downloads": True, **options}
        )
        self.url, self.asked, self.errors = url, [], []
        self.context.route(lambda address: not address.startswith((url, "blob:", "data:")), self._refuse)
        self.page = self.context.new_page()
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))

    def _refuse(self, route):
        if route.request.url != "about:blank":  # how MathJax finds out whether fonts may be loaded
            self.asked.append(route.request.url)
        route.abort()

    def open(self, name, **options):
        self.page.goto(f"{self.url}/{name}", wait_until="domcontentloaded", **options)
        return self.page

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.context.close()

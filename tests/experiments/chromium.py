"""A browser without a window, led through its own protocol over two pipes: no port, no network."""

from __future__ import annotations

import base64
import json
import os
import select
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from experiments.report.pdf import FLAGS, require_browser

PATIENCE = 120.0
"""Seconds until an answer that does not come is given up."""


class Browser:
    """One page of a browser. ``errors``: what its console was told of what went wrong."""

    def __init__(self, to: int, back: int) -> None:
        self._to, self._back, self._rest = to, back, b""
        self._last, self._session = 0, None
        self.errors: list[str] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Ask for something -> what it gave."""
        self._last += 1
        message = {"id": self._last, "method": method, "params": params}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while (answer := self._receive()).get("id") != self._last:
            self._note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def size(self, width: int, height: int = 900, scale: float = 1) -> None:
        """Show pages in a window of this size; below 600 pixels as on a phone."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=scale,
            mobile=width < 600,
        )

    def open(self, url: str) -> None:
        """Go to a page and wait until it is there, pictures and all."""
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=url)
        until = time.monotonic() + PATIENCE
        while self._state() != [url.partition("#")[0], "complete"]:
            if time.monotonic() > until:
                raise TimeoutError(f"{url} does not open")
            time.sleep(0.02)

    def _state(self) -> Any:
        with suppress(RuntimeError):  # the page went away under the question
            return self.run("[location.href.split('#')[0], document.readyState]")

    def run(self, script: str) -> Any:
        """The value of an expression in the page, awaited. What it throws is raised."""
        done = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in done:
            raise RuntimeError(str(done["exceptionDetails"]))
        return done["result"].get("value")

    def picture(self, path: Path, whole: bool = True) -> None:
        """Save what the page looks like, also what is below the window."""
        shot = self.call("Page.captureScreenshot", captureBeyondViewport=whole)
        path.write_bytes(base64.b64decode(shot["data"]))

    def _note(self, event: dict[str, Any]) -> None:
        told = event.get("params", {})
        wrong = (
            event.get("method") == "Runtime.exceptionThrown"
            or (event.get("method") == "Log.entryAdded" and told["entry"]["level"] == "error")
            or (event.get("method") == "Runtime.consoleAPICalled" and told["type"] == "error")
        )
        if wrong:
            self.errors.append(json.dumps(told)[:400])

    def _receive(self) -> dict[str, Any]:
        until = time.monotonic() + PATIENCE
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._back], [], [], max(until - time.monotonic(), 0))
            more = os.read(self._back, 1 << 20) if ready else b""
            if not more:
                raise TimeoutError("the browser does not answer")
            self._rest += more
        message, _, self._rest = self._rest.partition(b"\0")
        return json.loads(message)


@contextmanager
def started() -> Iterator[Browser]:
    """A browser with a fresh profile; it ends with the block."""
    there, to = os.pipe()
    back, here = os.pipe()
    with tempfile.TemporaryDirectory(prefix="hem-browser-", ignore_cleanup_errors=True) as profile:
        flags = [*FLAGS, f"--user-data-dir={profile}", "--remote-debugging-pipe"]
        # The browser reads from 3 and writes to 4; whatever numbers our pipes have, go there.
        script = f'exec "$@" 3<&{there} 4>&{here}'
        process = subprocess.Popen(
            ["bash", "-c", script, "browser", require_browser(), *flags, "about:blank"],
            pass_fds=(there, here),
            stderr=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        for end in (there, here):
            os.close(end)
        try:
            yield Browser(to, back)
        finally:
            process.terminate()
            process.wait(PATIENCE)
            for end in (to, back):
                os.close(end)

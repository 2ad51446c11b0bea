"""A real browser without a window, for tests that look at what people see."""

from __future__ import annotations

import base64
import io
import json
import shutil
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import websocket
from PIL import Image

_NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",  # WebGL on the CPU
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
    "--window-size=1000,700",
)


def find_browser() -> str | None:
    """Returns the path of a Chromium, if there is one."""
    return next((path for name in _NAMES if (path := shutil.which(name))), None)


class PageGoneError(RuntimeError):
    """The page changed to another while it was asked."""


class HeadlessBrowser:
    """One page of a Chromium, driven through its debugging port.

    Attributes:
        errors: Complaints of the page: console errors and exceptions.
    """

    def __init__(self, executable: str, timeout_s: float = 180.0):
        self.errors: list[str] = []
        self._timeout_s = timeout_s
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._process = subprocess.Popen(
            [
                executable,
                *_FLAGS,
                f"--user-data-dir={self._folder.name}",
                "about:blank",
            ],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._id = 0
        self._socket = self._connect()
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> HeadlessBrowser:
        """Nothing more to start."""
        return self

    def __exit__(self, *args: object) -> None:
        """Ends the browser."""
        self._socket.close()
        self._process.terminate()
        self._process.wait(timeout=self._timeout_s)
        self._folder.cleanup()

    def open(self, address: str) -> None:
        """Opens a page and waits until it has loaded."""
        answer = self.call("Page.navigate", url=address)
        assert "errorText" not in answer, f"{address}: {answer['errorText']}"
        self.wait_for("document.readyState == 'complete'")

    def resize(self, width: int, height: int = 800, *, is_phone: bool = False) -> None:
        """Shows the page in a window of this size, px."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=is_phone,
        )

    def wait_for(self, expression: str) -> None:
        """Waits until a JavaScript expression is true, also over a change of page.

        Raises:
            TimeoutError: It never became so.
        """
        deadline = time.monotonic() + self._timeout_s
        while not self._is_true(expression):
            if time.monotonic() > deadline:
                raise TimeoutError(f"{expression}; the page says {self.errors}")
            time.sleep(0.1)

    def _is_true(self, expression: str) -> bool:
        """Tells whether it is true of the page that is there after asking."""
        try:
            return bool(self.evaluate(expression))
        except PageGoneError:
            return False

    def evaluate(self, expression: str) -> Any:
        """Returns the value of a JavaScript expression."""
        answer = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def screenshot(self, *box: int) -> np.ndarray:
        """Returns the page as pixels (height, width, 3) in 0..255.

        Args:
            box: Part of it, as x, y, width, height, px; all of it where not given.
        """
        clip = {}
        if box:
            x, y, width, height = box
            clip = {"clip": dict(x=x, y=y, width=width, height=height, scale=1)}
        data = base64.b64decode(self.call("Page.captureScreenshot", **clip)["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Calls a method of the protocol and notes complaints on the way.

        Raises:
            PageGoneError: The page went to another before it answered.
            RuntimeError: The browser refuses.
        """
        self._id += 1
        message = {"id": self._id, "method": method, "params": parameters}
        self._socket.send(json.dumps(message))
        while True:
            answer = json.loads(self._socket.recv())
            self._note(answer)
            if answer.get("id") == self._id:
                if "error" in answer:
                    gone = "navigated" in answer["error"]["message"]
                    kind = PageGoneError if gone else RuntimeError
                    raise kind(f"{method}: {answer['error']}")
                return dict(answer["result"])

    def _note(self, message: dict[str, Any]) -> None:
        """Keeps a message that is a complaint of the page."""
        parameters = message.get("params", {})
        if message.get("method") == "Runtime.exceptionThrown":
            self.errors.append(str(parameters["exceptionDetails"]))
        elif message.get("method") == "Runtime.consoleAPICalled":
            if parameters["type"] in ("error", "assert"):
                self.errors.append(str(parameters["args"]))
        elif message.get("method") == "Log.entryAdded":
            if parameters["entry"]["level"] == "error":
                self.errors.append(str(parameters["entry"]))

    def _connect(self) -> websocket.WebSocket:
        """Finds the port that the browser chose and connects to its page."""
        deadline = time.monotonic() + self._timeout_s
        port_file = Path(self._folder.name) / "DevToolsActivePort"
        while time.monotonic() < deadline:
            lines = port_file.read_text().split() if port_file.exists() else []
            # It is written in two steps, and the port may be reset until all is up.
            if len(lines) == 2:
                with suppress(ConnectionError):
                    if page := self._find_page(*lines):
                        return page
            time.sleep(0.05)
        raise TimeoutError("the browser did not start")

    def _find_page(self, port: str, path: str) -> websocket.WebSocket | None:
        """Connects to the browser's page, if it has one yet."""
        address, options = f"ws://127.0.0.1:{port}", {"timeout": self._timeout_s}
        browser = websocket.create_connection(address + path, **options)
        browser.send(json.dumps({"id": 0, "method": "Target.getTargets"}))
        targets = json.loads(browser.recv())["result"]["targetInfos"]
        browser.close()
        pages = [t["targetId"] for t in targets if t["type"] == "page"]
        if not pages:
            return None
        return websocket.create_connection(
            f"{address}/devtools/page/{pages[0]}", **options
        )

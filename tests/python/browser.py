"""A small client of headless Chromium for tests of pages, through its debugging pipe: it needs no other package."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest

CODES = {"Tab": 9, "Enter": 13}  # of keys that Chromium knows by their number only


class Browser:
    """One page of Chromium. `messages` has what it said since the last open()."""

    def __init__(self):
        program = shutil.which("chromium")
        if not program:
            raise AssertionError("Chromium is missing: please install the package chromium")
        if not os.path.exists("/proc/cpuinfo"):  # in a folder that chroot has made the root
            raise unittest.SkipTest("Chromium does not start without /proc")
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        its_input, our_output = os.pipe()
        our_input, its_output = os.pipe()
        words = [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-extensions",
                 "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}", "about:blank"]
        # Chromium reads commands from its file 3 and writes answers to its file 4.
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{its_input} 4>&{its_output}', "bash", *words],
                                        pass_fds=(its_input, its_output), stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(its_input)
        os.close(its_output)
        self.output, self.input = os.fdopen(our_output, "wb", 0), os.fdopen(our_input, "rb")
        self.count, self.rest, self.messages, self.session = 0, b"", [], None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def receive(self):
        while b"\0" not in self.rest:
            part = self.input.read1(1 << 16)
            if not part:
                raise AssertionError("Chromium has ended")
            self.rest += part
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        """Sends a command of the DevTools protocol; returns its result."""
        self.count += 1
        command = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        self.output.write(json.dumps(command).encode() + b"\0")
        while True:
            message = self.receive()
            if message.get("id") == self.count:
                if "error" in message:
                    raise AssertionError(f"{method}: {message['error']}")
                return message["result"]
            self.messages.append(message)

    def evaluate(self, words):
        """The value of an expression in the page; an exception there is a failure here."""
        answer = self.call("Runtime.evaluate", expression=words, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise AssertionError(f"{words}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def resize(self, width):
        """Gives the page the width of a desktop or of a phone."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                  mobile=width < 600)

    def open(self, path, width=1280):
        """Opens a file and waits until it is loaded and drawn."""
        self.visit(path.resolve().as_uri(), width)

    def visit(self, address, width=1280):
        """Opens an address and waits until it is loaded and drawn."""
        self.messages = []
        self.resize(width)
        self.call("Page.navigate", url=address)
        while not any(message.get("method") == "Page.loadEventFired" for message in self.messages):
            self.messages.append(self.receive())
        self.frames()

    def scheme(self, name):
        """Sets the wish for light or dark colours."""
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def frames(self, count=2):
        """Waits until the page was drawn so many times."""
        for _ in range(count):
            self.evaluate("new Promise((done) => requestAnimationFrame(() => done(true)))")

    def mouse(self, kind, x, y):
        """kind: mouseMoved, mousePressed, mouseReleased."""
        pressed = 1 if kind == "mousePressed" else 0
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, buttons=pressed,
                  **({"button": "left", "clickCount": 1} if kind != "mouseMoved" else {}))

    def click(self, x, y):
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.mouse(kind, x, y)

    def key(self, key):
        text = {"text": key} if len(key) == 1 else {"text": "\r"} if key == "Enter" else {}
        code = {"windowsVirtualKeyCode": CODES[key]} if key in CODES else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text, **code)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, **code)

    def type(self, text):
        """Types a text into the element with the focus; it replaces what is selected there."""
        self.call("Input.insertText", text=text)

    def complaints(self):
        """Exceptions and messages of the console, and addresses that the page asked for besides itself."""
        bad = [message["params"] for message in self.messages if message.get("method") in
               ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")]
        asked = [message["params"]["request"]["url"] for message in self.messages
                 if message.get("method") == "Network.requestWillBeSent"]
        return bad + asked[1:]

    def close(self):
        self.session = None
        self.call("Browser.close")
        self.output.close()
        self.process.wait(20)
        self.input.close()
        self.profile.cleanup()

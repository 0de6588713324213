# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A running window of glidar view with actions for tests: keys, mouse, saving, screenshots."""

import os
import subprocess
import threading

from cli_support import CliTest
from display import WINDOW_WAIT_S, Display
from PIL import ImageChops, ImageStat
from waiting import wait_until

# Positions in the window of 1280 x 720.
SENSOR = (540, 330)  # the centre of the left view
CLOUD = (1030, 330)
SENSOR_BOX = (300, 30, 770, 600)
CLOUD_BOX = (780, 30, 1270, 600)


def difference(a, b):
    """Mean absolute difference of two images, of 255."""
    return sum(ImageStat.Stat(ImageChops.difference(a, b)).mean) / 3.0


class Window:
    """A context manager for a running glidar view, whose state is read from the lines of --print-state."""

    def __init__(self, test, *arguments, is_on_x11=True):
        self._test = test
        self._is_on_x11 = is_on_x11
        self._display = test.display
        self.program = subprocess.Popen(
            ["glidar", "view", "--print-state", *arguments], cwd=test.folder, env=test.environment,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._out, self._err, self._keys = [], [], 0
        self._readers = [threading.Thread(target=self._read, args=pair)
                         for pair in ((self.program.stdout, self._out), (self.program.stderr, self._err))]
        for reader in self._readers:
            reader.start()

    @staticmethod
    def _read(stream, lines):
        for line in stream:
            lines.append(line)

    def __enter__(self):
        try:
            if self._is_on_x11:
                search = ("search", "--onlyvisible", "--name", "GLIDAR")
                self.number = self._wait(lambda: self._display.xdotool(*search), "a window")[0]
            self.wait_for("its first picture")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *error):
        if self.program.poll() is None:
            self.program.kill()
        self.program.wait()
        for reader in self._readers:
            reader.join()
        for stream in (self.program.stdout, self.program.stderr):
            stream.close()

    def _wait(self, condition, what):
        """wait_until() with what the window reported."""
        try:
            return wait_until(condition, what, self.program, max_s=WINDOW_WAIT_S)
        except AssertionError as error:
            raise AssertionError(f"{error}; the last state: {self.state()}; its errors: {''.join(self._err)}") from None

    def state(self):
        """The last printed state, as numbers and text by name; empty without one."""
        lines = [line for line in self._out if line.startswith("state: ")]
        pairs = (word.split("=") for word in lines[-1].split()[1:]) if lines else ()
        return {name: int(value) if value.lstrip("-").isdigit() else value for name, value in pairs}

    def wait_for(self, what, **wanted):
        """The first state with these values; a function is a condition of the value."""
        def is_there():
            state = self.state()
            fits = all(value(state[name]) if callable(value) else state[name] == value
                       for name, value in wanted.items()) if state else False
            return state if fits else None
        return self._wait(is_there, what)

    def key(self, *keys):
        """Types characters and waits for their effect in the window."""
        for key in keys:
            self._display.xdotool("key", key)
        self._keys += len(keys)
        self.wait_for("the keys", keys=self._keys)

    def point(self, x, y):
        self._display.xdotool("mousemove", x, y)
        self.wait_for("the pointer", x=x, y=y)

    def wheel_up(self):
        before = self.state()["wheel"]
        self._display.xdotool("click", 4)
        self.wait_for("the wheel", wheel=before + 1)

    def drag(self, start, way):
        """Drags in steps, and waits for the effect of each."""
        self.point(*start)
        self._display.xdotool("mousedown", 1)
        self.wait_for("the button", buttons=1)
        for step in range(1, 6):
            self.point(start[0] + way[0] * step // 5, start[1] + way[1] * step // 5)
        self._display.xdotool("mouseup", 1)
        self.wait_for("the button's release", buttons=0)

    def minimise(self):
        """The number of frames until then."""
        self._display.set_minimised(self.number, True)
        return self.wait_for("it to be hidden", hidden=1)["picture"]

    def restore(self):
        """The number of frames until it is visible again."""
        self._display.set_minimised(self.number, False)
        return self.wait_for("it to be shown", hidden=0)["picture"]

    def shows(self, condition, what):
        """Waits until a screenshot fulfils the condition."""
        self._wait(lambda: condition(self._display.grab()), what)

    def quit(self):
        """Closes it by Esc, repeated if the window was not ready for it; returns its output."""
        for _ in range(WINDOW_WAIT_S // 5):
            self._display.xdotool("key", "Escape")
            try:
                self.program.wait(timeout=5)
                break
            except subprocess.TimeoutExpired:
                pass
        else:
            self._test.fail(f"waited {WINDOW_WAIT_S} s in vain for the end after Esc; the last state: {self.state()}")
        for reader in self._readers:
            reader.join()
        self._test.assertEqual(self.program.returncode, 0, self._err)
        return "".join(self._out + self._err)

    def save(self, name):
        """Presses s; returns the 4x4 transform that is written."""
        self._display.xdotool("key", "s")
        self._keys += 1
        path = os.path.join(self._test.folder, name + ".transform")
        self._wait(lambda: os.path.exists(path), path)
        with open(path, encoding="utf-8") as text:
            return [[float(x) for x in line.split()] for line in text]


def is_red(picture):
    """Whether the panel of errors is visible."""
    red = picture.getpixel((900, 40))
    return red[0] > 2 * red[1]


class DisplayTest(CliTest):
    """A test with its own display."""

    @classmethod
    def setUpClass(cls):
        cls.display = Display().__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.display.__exit__()

    def setUp(self):
        super().setUp()
        for name in ("WAYLAND_DISPLAY", "WAYLAND_SOCKET", "XDG_RUNTIME_DIR"):  # those of a desktop
            self.environment.pop(name, None)
        self.environment["DISPLAY"] = self.display.name

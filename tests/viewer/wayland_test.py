# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar view on a Wayland display, and without one."""

import os
import socket
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "apps"))
from cli_support import CliTest
from skipping import IN_DEV, importing, skip
from waiting import let_time_pass, wait_until

with importing():
    from display import WINDOW_WAIT_S, Display, WaylandDisplay, missing_programs
    from PIL import Image
    from window_support import Window, difference


class WaylandTest(CliTest):
    """GLFW 3.4 supports X11 and Wayland, earlier versions one of them, in Debian X11."""

    def setUp(self):
        super().setUp()
        for name in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "XDG_RUNTIME_DIR"):
            self.environment.pop(name, None)
        self.has_wayland = "has no support for Wayland" not in self.error_on("wayland-absent", self.folder)

    def error_on(self, display, folder=None):
        self.environment["WAYLAND_DISPLAY"] = display
        if folder:
            self.environment["XDG_RUNTIME_DIR"] = folder
        return self.refused("view", "builtin:box", "--frames", "1")

    def test_a_window_opens(self):
        with Display() as x11, WaylandDisplay(os.path.join(self.folder, "run"), x11) as display:
            self.environment |= display.environment
            shoot = ("view", "builtin:asteroid", "--model-r", "1,0,0,1", "--frames", "3", "--screenshot", "shot.png")
            if not self.has_wayland:
                self.assertIn("libglfw3-wayland", self.refused(*shoot))
                return
            self.succeed(*shoot)
            self.assertIn("missing.obj", self.refused("view", "missing.obj", "--screenshot", "none.png"))
        with Image.open(os.path.join(self.folder, "shot.png")) as image:
            self.assertEqual(image.size, (1280, 720))
            views = image.convert("RGB").crop((290, 20, 1280, 600)).resize((330, 193), Image.Resampling.BOX)
        with Image.open(os.path.join(HERE, "asteroid_views.png")) as expected:
            self.assertLess(difference(views, expected.convert("RGB")), 2.0)

    def test_mouse_and_keys_have_an_effect_and_nothing_is_drawn_otherwise(self):
        if not self.has_wayland:
            self.skipTest("GLFW without Wayland; use GLFW 3.4")
        with Display() as self.display, WaylandDisplay(os.path.join(self.folder, "run"), self.display) as display:
            self.environment |= display.environment
            with Window(self, "builtin:asteroid", is_on_x11=False) as window:
                def is_inside():  # weston places the window at random
                    self.display.xdotool("mousemove", 700, 450 + len(tried) % 2)
                    tried.append(window.state()["x"])
                    return window.state()["x"] > 0
                tried = []
                wait_until(is_inside, "the pointer", window.program, max_s=WINDOW_WAIT_S)
                self.display.xdotool("click", 1)
                window.key("plus")
                before = window.state()["picture"]
                let_time_pass(2.0)
                self.assertLess(window.state()["picture"] - before, 10, "two seconds at 20 a second would be 40")
                window.quit()

    def test_a_display_without_keyboard_and_mouse_is_an_error(self):
        """GLFW 3.4 crashes there."""
        with WaylandDisplay(os.path.join(self.folder, "run")) as display:
            self.environment |= display.environment
            self.assertIn("has no seat" if self.has_wayland else "libglfw3-wayland",
                          self.refused("view", "builtin:box", "--frames", "1"))

    def test_without_a_driver_the_error_lists_what_to_install(self):
        with Display() as x11, WaylandDisplay(os.path.join(self.folder, "run"), x11) as display:
            self.environment |= display.environment | {"__EGL_VENDOR_LIBRARY_DIRS": self.folder}
            self.assertIn("libgl1-mesa-dri" if self.has_wayland else "libglfw3-wayland",
                          self.refused("view", "builtin:box", "--frames", "1"))

    def test_a_missing_socket_or_runtime_folder_is_named(self):
        self.assertIn("DISPLAY is not set; ", self.error_on("wayland-absent", self.folder))
        cases = [("wayland-absent", self.folder, f"there is no socket '{self.folder}/wayland-absent'"),
                 (os.path.join(self.folder, "absent"), self.folder, f"there is no socket '{self.folder}/absent'"),
                 ("wayland-absent", "run", "XDG_RUNTIME_DIR is 'run'"), ("wayland-absent", "", "XDG_RUNTIME_DIR is not set")]
        for display, folder, words in cases if self.has_wayland else ():
            with self.subTest(words):
                self.environment["XDG_RUNTIME_DIR"] = folder
                self.assertIn(words, self.error_on(display))

    def test_a_socket_without_a_compositor_is_an_error(self):
        with socket.socket(socket.AF_UNIX) as stale:
            stale.bind(os.path.join(self.folder, "wayland-stale"))
        words = "but nothing serves the socket" if self.has_wayland else "libglfw3-wayland"
        self.assertIn(words, self.error_on("wayland-stale", self.folder))


if __name__ == "__main__":
    if missing_programs():
        skip(f"no {', '.join(missing_programs())}", IN_DEV)
    unittest.main(failfast=True)  # so that one hang is reported before CTest ends the program

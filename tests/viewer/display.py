# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A virtual display, with its keyboard and mouse."""

import os
import re
import select
import shutil
import subprocess
from urllib.parse import quote

from PIL import ImageGrab
import Xlib.display
from Xlib import X, Xutil
from Xlib.protocol import event
from waiting import MAX_WAIT_S, wait_until

NEEDED = ("Xvfb", "xdotool", "weston")
WINDOW_WAIT_S = 60  # for the effect of a key, or a window


def missing_programs():
    return [program for program in NEEDED if shutil.which(program) is None]


def end(server):
    """Ends a display server, which takes its clients with it."""
    server.terminate()
    try:
        server.wait(timeout=WINDOW_WAIT_S)
    except subprocess.TimeoutExpired:
        server.kill()
        server.wait()


class WaylandDisplay:
    """A context manager for weston, in a runtime folder of its own: in a window on an X11 display, else without a screen,
    and then also without a keyboard and a mouse."""

    def __init__(self, folder, x11=None):
        self.environment = {"XDG_RUNTIME_DIR": str(folder), "WAYLAND_DISPLAY": "wayland-test"}
        self._x11 = x11

    def __enter__(self):
        folder = self.environment["XDG_RUNTIME_DIR"]
        os.makedirs(folder, mode=0o700)
        environment = os.environ | {"XDG_RUNTIME_DIR": folder, "DISPLAY": self._x11.name if self._x11 else ""}
        environment.pop("WAYLAND_DISPLAY", None)
        backend = ("x11" if self._x11 else "headless") + ("-backend.so" if weston_version() < 12 else "")
        self._server = subprocess.Popen(
            ["weston", f"--backend={backend}", "--use-pixman", "--socket=wayland-test", "--idle-time=0", "--no-config",
             "--width=1400", "--height=900", f"--log={folder}/weston.log"],
            env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            wait_until(lambda: os.path.exists(f"{folder}/wayland-test"), "the socket of weston", self._server,
                       max_s=WINDOW_WAIT_S)
        except AssertionError:
            end(self._server)
            raise
        return self

    def __exit__(self, *error):
        end(self._server)


def weston_version():
    done = subprocess.run(["weston", "--version"], capture_output=True, text=True, timeout=WINDOW_WAIT_S, check=True)
    return int(re.search(r"weston (\d+)", done.stdout)[1])


class Display:
    """A context manager for Xvfb; further options are its own."""

    def __init__(self, *options):
        self._options = options

    def __enter__(self):
        read, write = os.pipe()
        self._server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1400x900x24", "-nolisten", "tcp",
             "-noreset", *self._options],  # no reset when its last window is closed
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        if not select.select([read], [], [], MAX_WAIT_S)[0]:
            raise AssertionError(f"Xvfb did not start in {MAX_WAIT_S} s")
        with os.fdopen(read) as number:
            self.name = ":" + number.readline().strip()
        if self.name == ":":
            raise AssertionError("Xvfb ended before its display was ready")
        self.environment = dict(os.environ, DISPLAY=self.name, HOME="/nonexistent")
        return self

    def __exit__(self, *error):
        end(self._server)

    def xdotool(self, *arguments):
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment,
                              capture_output=True, text=True, timeout=WINDOW_WAIT_S, check=False)
        return done.stdout.split()

    def grab(self):
        return ImageGrab.grab(xdisplay=self.name).convert("RGB")

    def set_minimised(self, window, is_minimised):
        """Acts as a window manager (ICCCM 4.1.3.1): sets WM_STATE, hides or shows."""
        display = Xlib.display.Display(self.name)
        it = display.create_resource_object("window", int(window))
        state = display.intern_atom("WM_STATE")
        it.change_property(state, state, 32, [Xutil.IconicState if is_minimised else Xutil.NormalState, 0])
        (it.unmap if is_minimised else it.map)()
        display.sync()
        display.close()

    def drop(self, window, path):
        """Drops a file by the protocol XDND, version 5, as a file manager does."""
        display = Xlib.display.Display(self.name)
        atom = display.intern_atom
        target = display.create_resource_object("window", int(window))
        source = display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)

        def send(kind, numbers):
            target.send_event(event.ClientMessage(
                window=target, client_type=atom(kind), data=(32, [source.id, *numbers])))
            display.flush()

        uri_list = atom("text/uri-list")
        send("XdndEnter", [5 << 24, uri_list, 0, 0])
        send("XdndPosition", [0, (300 << 16) | 300, X.CurrentTime, atom("XdndActionCopy")])
        is_finished = False
        while not is_finished:
            wait_until(display.pending_events, "the window to take what was dropped", max_s=WINDOW_WAIT_S)
            got = display.next_event()
            if got.type == X.ClientMessage and got.client_type == atom("XdndStatus"):
                send("XdndDrop", [0, X.CurrentTime, 0, 0])
            elif got.type == X.SelectionRequest:
                self._hand_over(got, uri_list, path, display)
            is_finished = got.type == X.ClientMessage and got.client_type == atom("XdndFinished")
        display.close()

    @staticmethod
    def _hand_over(request, uri_list, path, display):
        uris = ("file://" + quote(path) + "\r\n").encode()
        request.requestor.change_property(request.property, uri_list, 8, uris)
        request.requestor.send_event(event.SelectionNotify(
            time=request.time, requestor=request.requestor, selection=request.selection,
            target=request.target, property=request.property))
        display.flush()

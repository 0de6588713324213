# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What frames were measured with, also across pickles."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakValueDictionary

from . import _core
from ._errors import Error
from ._sensor import Sensor
from ._state import part, restoring

if TYPE_CHECKING:
    from ._scene import Scene

#: Scenes of unpickled frames by their digests, so that frames of one scene share it.
_RESTORED: WeakValueDictionary[str, Scene] = WeakValueDictionary()
#: The last of them, kept for the next frame where frames are unpickled, used and dropped one by one.
_LATEST: deque[Scene] = deque(maxlen=1)


class SceneSource:
    """A scene that nobody changes. From a pickle it is made when it is needed first."""

    def __init__(self, scene: Scene) -> None:
        self._scene: Scene | None = scene
        self._state: dict[str, Any] | None = None

    def get(self) -> Scene:
        """The scene.

        Raises:
            Error: a file that it was read from is not there or has changed.
        """
        if self._scene is None:
            self._scene = _restored(self._state)
        return self._scene

    def __getstate__(self) -> dict[str, Any]:
        if self._state is None and self._scene is not None:
            self._state = self._scene.__getstate__()  # kept, for frames that are pickled one by one
        return {"kind": "SceneSource", "state": self._state}

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("SceneSource", state):
            self._scene = None
            self._state = part(state, "state", dict)


def _restored(state: dict[str, Any] | None) -> Scene:
    from ._scene import Scene

    digest = state.get("digest") if state else None
    found = _RESTORED.get(digest) if isinstance(digest, str) else None
    if found is None:
        found = Scene.__new__(Scene)
        found.__setstate__(state or {})
        _RESTORED[str(digest)] = found
    _LATEST.append(found)
    return found


@dataclass(frozen=True)
class Origin:
    """What frames were measured with."""

    scene: SceneSource
    sensor: Sensor
    renderer: str
    threads: int

    def attach_scene(self, frame: _core.Frame) -> None:
        """Gives a frame from a pickle its scene. Needs no renderer, which this machine may not have.

        Raises:
            Error: the scene cannot be made, or it is not the one of the frame.
        """
        _core.attach_scene(frame, self._restored_scene()._core, self.renderer)

    def attach_renderer(self, frame: _core.Frame) -> None:
        """Gives a frame from a pickle its scene and what measures it again.

        Raises:
            Error: the scene cannot be made, it is not the one of the frame, or the renderer cannot be built.
        """
        core = self._restored_scene()._core
        _core.make_simulator(core, self.sensor._core, self.renderer, self.threads).attach(frame)

    def _restored_scene(self) -> Scene:
        if not isinstance(self.scene, SceneSource) or not isinstance(self.sensor, Sensor):
            raise Error("pickled Frame", "a malformed state (its scene or its sensor is something else)")
        return self.scene.get()

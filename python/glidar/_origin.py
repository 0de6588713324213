# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The scene, sensor and renderer that frames were measured with. Pickled frames keep them."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any
from weakref import WeakValueDictionary

from . import _core
from ._errors import Error
from ._recipe import Recipe
from ._sensor import Sensor
from ._state import part, restoring

#: Scenes of unpickled frames by their digests, so that frames of one scene share it.
_RESTORED: WeakValueDictionary[str, Recipe] = WeakValueDictionary()
#: The last of them, kept for the next frame when frames are unpickled, used and dropped one at a time.
_LATEST: deque[Recipe] = deque(maxlen=1)


class SceneSource:
    """A scene that nothing changes. After unpickling it is restored on first use."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe: Recipe | None = recipe
        self._state: dict[str, Any] | None = None

    def get(self) -> _core.Scene:
        """The scene.

        Raises:
            Error: a file that it was read from is missing or has changed.
        """
        if self._recipe is None:
            self._recipe = _restored(self._state)
        return self._recipe.core

    def __getstate__(self) -> dict[str, Any]:
        if self._state is None and self._recipe is not None:
            self._state = self._recipe.state()  # kept, because frames may be pickled one at a time
        return {"kind": "SceneSource", "state": self._state}

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("SceneSource", state):
            self._recipe = None
            self._state = part(state, "state", dict)


def _restored(state: dict[str, Any] | None) -> Recipe:
    digest = state.get("digest") if state else None
    found = _RESTORED.get(digest) if isinstance(digest, str) else None
    if found is None:
        found = Recipe.restored(state or {})
        _RESTORED[str(digest)] = found
    _LATEST.append(found)
    return found


@dataclass(frozen=True)
class Origin:
    """The scene, sensor and renderer that frames were measured with."""

    scene: SceneSource
    sensor: Sensor
    renderer: str
    threads: int

    def attach_scene(self, frame: _core.Frame) -> None:
        """Attaches the scene to an unpickled frame. Needs no renderer, which may be unavailable on this machine.

        Raises:
            Error: the scene cannot be restored, or it is not the frame's.
        """
        _core.attach_scene(frame, self._restored_scene(), self.renderer)

    def attach_renderer(self, frame: _core.Frame) -> None:
        """Attaches the scene and a simulator to an unpickled frame, so that it can be measured again.

        Raises:
            Error: the scene cannot be restored, it is not the frame's, or the renderer cannot be created.
        """
        scene = self._restored_scene()
        _core.make_simulator(scene, self.sensor._core, self.renderer, self.threads).attach(frame)

    def _restored_scene(self) -> _core.Scene:
        if not isinstance(self.scene, SceneSource) or not isinstance(self.sensor, Sensor):
            raise Error("pickled Frame", "a malformed state (its scene or its sensor has another type)")
        return self.scene.get()

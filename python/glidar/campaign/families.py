# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Where the values of a sensor file with variants and modes are written."""

from glidar.campaign import yaml_file as yf


def _normalised(name):
    return name.lower().translate(str.maketrans("", "", "-_ "))


def _named(maps, key, name):
    """The maps of overrides with this name under a key of the maps."""
    layers = []
    for one in maps:
        found = yf.entries(one).get(key)
        if found is None or not yf.is_map(found):
            continue
        entries = yf.entries(found)
        same = [word for word in entries if word == name] or [
            word for word in entries if _normalised(word) == _normalised(name)]
        layers += [entries[word] for word in same[:1] if yf.is_map(entries[word])]
    return layers


def layers_of(field, variant, mode):
    """The overrides that apply to a sensor, the last applied first: those of the mode, then those of the variant.
    An empty mode is the default one. Unknown names have no overrides: the sensor's reader rejects them."""
    own = _named([field], "variants", variant) if variant else []
    maps = [*own, field]
    if not mode:
        defaults = [yf.entries(one)["default_mode"] for one in maps if "default_mode" in yf.entries(one)]
        mode = defaults[0].value if defaults else ""
    return [*(_named(maps, "modes", mode) if mode else []), *own]

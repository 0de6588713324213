# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Status and source of returns."""

import enum


class Status(enum.IntEnum):
    """Why a beam has a return or none."""

    hit = 0
    miss = 1
    too_near = 2
    too_far = 3
    invalid_pixel = 4
    below_threshold = 5
    dropped = 6
    occluded = 7
    phase_ambiguous = 8
    saturated = 9
    weather = 10
    no_return_of_rank = 11
    image_border = 12
    no_texture = 13
    outside_search = 14
    ambiguous_match = 15
    left_right_mismatch = 16
    projector_shadow = 17
    transparent = 18
    filtered_edge = 19
    low_modulation = 20
    weak_code = 21
    inconsistent_code = 22
    outside_projector = 23


class ReturnSource(enum.IntEnum):
    """The origin of a return."""

    none = 0
    surface = 1
    mixed_pixel = 2
    ghost = 3
    false_alarm = 4
    fog = 5
    rain = 6
    snow = 7
    crosstalk = 8

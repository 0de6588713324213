# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns with variants and modes of sensors."""

import json

import numpy as np
import pytest

from glidar import Error
from glidar.campaign import families, inputs, loading, plan, sensor_files, spec, variants, yaml_file as yf

FAMILY = """optics: {width: 8, height: 6, fov_deg: 40}
rate_hz: 10
noise: [{type: range_gaussian, sigma_m: 0.01}]
default_mode: slow
modes: {slow: {limits: {far_m: 9}}, fast: {rate_hz: 20}}
variants:
  A: {}
  B-1:
    optics: {width: 12}
    noise: [{type: range_gaussian, sigma_m: 0.02}]
    modes: {fast: {rate_hz: 40}}
"""


@pytest.fixture
def family(campaign):
    campaign.write("cams.yaml", FAMILY)
    return campaign


def sensor_of(campaign, name, mode=""):
    path, variant = sensor_files.find(name, campaign.folder)
    return inputs.read(name, path, {}, variant, mode)


def use(campaign, name, extra=""):
    text = (campaign.folder / "campaign.yaml").read_text().replace("sensor: camera.yaml", f"sensor: {name}")
    campaign.write("campaign.yaml", text + extra)


def test_a_campaign_measures_with_the_variant_and_mode_that_it_names(family):
    use(family, "{grid: [cams.yaml#A, cams.yaml#b1]}", "mode: fast\n")
    family.run("out")
    record = json.loads((family.folder / "out/campaign.json").read_text())["plan"]["sensors"]
    assert [(one["name"], one["variant"], one["mode"]) for one in record] == [
        ("cams.yaml#A", "A", "fast"), ("cams.yaml#b1", "b1", "fast")]
    shards = sorted((family.folder / "out").rglob("*.npz"))
    with np.load(shards[0]) as arrays:
        assert {"6x8/range", "6x12/range"} <= set(arrays.files)


def test_another_mode_is_another_campaign(family):
    use(family, "cams.yaml#A", "mode: fast\n")
    family.run("out")
    use(family, "cams.yaml#A")
    family.write("campaign.yaml", (family.folder / "campaign.yaml").read_text().replace("mode: fast\n", "mode: slow\n"))
    assert "out" in family.run("out", code=2)


def test_presets_have_modes(campaign):
    source = sensor_of(campaign, "os1-32", "512x20")
    sensor = sensor_files.load(source)
    assert (sensor.name, sensor.cols, sensor.mode) == ("Ouster OS1-32", 512, "512x20")


@pytest.mark.parametrize(
    ("name", "mode", "path", "place"),
    [
        ("cams.yaml#A", "", "sensor.rate_hz", "rate_hz"),
        ("cams.yaml#A", "fast", "sensor.rate_hz", "modes.fast.rate_hz"),
        ("cams.yaml#b1", "FAST", "sensor.rate_hz", "variants.B-1.modes.fast.rate_hz"),
        ("cams.yaml#A", "", "sensor.limits.far_m", "modes.slow.limits.far_m"),
        ("cams.yaml#B-1", "", "sensor.optics.width", "variants.B-1.optics.width"),
        ("cams.yaml#B-1", "", "sensor.optics.height", "optics.height"),
        ("cams.yaml#B-1", "", "sensor.noise[0].sigma_m", "variants.B-1.noise[0].sigma_m"),
        ("cams.yaml#A", "", "sensor.noise[0].sigma_m", "noise[0].sigma_m"),
    ],
)
def test_a_value_is_varied_where_it_has_an_effect(family, name, mode, path, place):
    source = sensor_of(family, name, mode)
    field = yf.parse(source.text, source.path)
    target = variants.read_target(field, path)
    assert variants.find(field, target, layers=families.layers_of(field, source.variant, mode)).path == place
    value = 3 if place.endswith(("width", "height")) else 0.5
    changed = loading.load_sensor(source.text, source.path, [(target, str(value))], source.variant, mode)
    found = changed.describe()
    for step in target.steps:
        found = found[int(step[1:-1])] if step.startswith("[") else found[step]
    assert found == value


def test_a_sensor_without_the_mode_is_an_error_of_the_campaign(campaign):
    campaign.add("mode: fast\n")
    planned = plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml"))
    with pytest.raises(Error, match="mode: 'fast', but .* has no modes"):
        inputs.load(planned.sensors[0], loading.load_sensor, ())

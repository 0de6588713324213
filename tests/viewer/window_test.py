# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar view in a window on a virtual display: keys, mouse, files, errors."""

import os
import re
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "apps"))
from cli_support import BOX
from skipping import IN_DEV, importing, skip
from waiting import let_time_pass, wait_until

with importing():
    from display import WINDOW_WAIT_S, Display, missing_programs
    from PIL import Image, ImageStat
    from window_support import CLOUD, CLOUD_BOX, SENSOR, SENSOR_BOX, DisplayTest, Window, difference, is_red

# Positions in the window of 1280 x 720.
RIGHT_BOX = (638, 330)  # of TWO_BOXES in the left view
SECOND_SENSOR = (100, 91)  # in the list
POSITION_X = (40, 437)  # of the selected object of TWO_BOXES

TWO_BOXES = """models:
  - {model: builtin:box, name: left, scale: 0.5, pose: {position: [0, 1.5, 0]}}
  - {model: builtin:box, name: right, scale: 0.5, pose: {position: [0, -1.5, 0]}}
"""
CAMERA = """
sensor: {optics: {type: pinhole, width: 64, height: 64, fov_deg: 40}}
sensor_pose: {position: [-10, 0, 0], euler_deg: {roll: -90, yaw: -90}}
"""
RIG = """
sensors:
  - {name: lidar, sensor: VLP-16}
  - name: camera
    sensor: {optics: {type: pinhole, width: 64, height: 64, fov_deg: 40}}
    pose: {position: [0, 0, 0], euler_deg: {roll: -90, yaw: -90}}
rig_pose: {position: [-10, 0, 0]}
"""


class ViewerWindowTest(DisplayTest):
    def read(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def test_s_saves_the_same_bytes_as_render_does(self):
        with Window(self, "builtin:asteroid") as window:
            window.save("buffer")
            window.quit()
        self.succeed("render", "builtin:asteroid", "--legacy-output", "expected")
        self.assertEqual(self.read("buffer.pcd"), self.read("expected.pcd"))
        self.assertEqual(self.read("buffer.transform"), self.read("expected.transform"))

    def test_plus_and_minus_move_the_sensor_and_r_resets(self):
        with Window(self, "builtin:asteroid") as window:
            start = window.save("buffer")
            window.key("plus")
            near = window.save("buffer_000001")
            window.key("minus", "minus")
            far = window.save("buffer_000002")
            window.key("r")
            again = window.save("buffer_000003")
        self.assertLess(near[2][3], 0.96 * start[2][3])
        self.assertGreater(far[2][3], 1.04 * start[2][3])
        self.assertEqual(again, start)

    def test_a_drag_rotates_the_object_and_not_the_cloud_view(self):
        with Window(self, "builtin:asteroid") as window:
            start = window.save("buffer")
            window.drag(SENSOR, (100, 0))
            turned = window.save("buffer_000001")
            before = self.display.grab().crop(CLOUD_BOX)
            window.drag(CLOUD, (100, 50))
            window.shows(lambda picture: difference(before, picture.crop(CLOUD_BOX)) > 1.0, "the cloud from elsewhere")
            seen = window.save("buffer_000002")
        self.assertNotEqual([row[:3] for row in turned], [row[:3] for row in start])
        self.assertAlmostEqual(turned[2][3], start[2][3], delta=0.2)
        self.assertEqual(seen, turned, "going round the cloud moves no object")

    def test_the_wheel_moves_the_sensor_on_the_left_and_zooms_on_the_right(self):
        with Window(self, "builtin:asteroid") as window:
            start = window.save("buffer")
            window.point(*SENSOR)
            window.wheel_up()
            near = window.save("buffer_000001")
            window.point(*CLOUD)
            window.wheel_up()
            zoomed = window.save("buffer_000002")
        self.assertLess(near[2][3], start[2][3])
        self.assertEqual(zoomed, near)

    def test_space_pauses_a_rotating_model(self):
        with Window(self, "builtin:asteroid", "--object-rate", "0,0,1") as window:
            first = window.save("buffer")
            frame = window.state()["frame"]
            window.wait_for("the next frame", frame=lambda now: now > frame + 1)
            second = window.save("buffer_000001")
            window.key("space")
            third = window.save("buffer_000002")
            let_time_pass(0.5)
            fourth = window.save("buffer_000003")
            window.quit()
        self.assertNotEqual(first, second)
        self.assertEqual(third, fourth)

    def test_a_click_traces_a_point(self):
        with Window(self, "builtin:asteroid") as window:
            before = self.display.grab()
            window.point(*SENSOR)
            self.display.xdotool("click", 1)
            window.shows(lambda picture: difference(before.crop((300, 470, 1270, 650)),
                                                    picture.crop((300, 470, 1270, 650))) > 2.0,
                         "the trace below the views")
            window.quit()

    def test_a_click_on_a_point_selects_its_object_and_f_frames_it(self):
        self.write("scene.yaml", TWO_BOXES + CAMERA)
        with Window(self, "scene.yaml") as window:
            self.assertEqual(window.state()["object"], 0)
            window.point(*RIGHT_BOX)
            self.display.xdotool("click", 1)
            window.wait_for("the selection", object=1)
            upper = (*CLOUD_BOX[:3], 350)  # above the trace
            before = self.display.grab().crop(upper)
            window.key("f")
            window.shows(lambda picture: difference(before, picture.crop(upper)) > 1.0, "the object from near")
            window.quit()

    def test_a_typed_position_moves_the_object(self):
        self.write("scene.yaml", TWO_BOXES + CAMERA)
        with Window(self, "scene.yaml") as window:
            before = self.display.grab().crop(SENSOR_BOX)
            window.drag(POSITION_X, (0, 0))  # a slow click: the cursor is behind the 0
            self.display.xdotool("key", "5")  # 05
            window.point(*CLOUD)
            self.display.xdotool("click", 1)  # leaves the field, which applies it
            window.shows(lambda picture: difference(before, picture.crop(SENSOR_BOX)) > 0.5, "the object farther away")
            window.save("buffer")
            window.quit()
        self.write("scene.yaml", TWO_BOXES.replace("[0, 1.5, 0]", "[5, 1.5, 0]") + CAMERA)
        self.succeed("render", "scene.yaml", "--legacy-output", "expected")
        self.assertEqual(self.read("buffer.pcd"), self.read("expected.pcd"))

    def test_the_list_of_sensors_selects_a_sensor_of_a_rig(self):
        self.write("rig.yaml", TWO_BOXES + RIG)
        with Window(self, "rig.yaml") as window:
            self.assertEqual(window.state()["sensor"], 0)
            before = self.display.grab().crop(SENSOR_BOX)
            window.point(*SECOND_SENSOR)
            self.display.xdotool("click", 1)
            window.wait_for("the camera", sensor=1)
            window.shows(lambda picture: difference(before, picture.crop(SENSOR_BOX)) > 2.0, "its picture")
            window.save("buffer")
            window.quit()
        self.succeed("render", "rig.yaml", "--sensor-name", "camera", "--legacy-output", "expected")
        self.assertEqual(self.read("buffer.pcd"), self.read("expected.pcd"))

    def test_nothing_is_drawn_while_nothing_changes(self):
        with Window(self, "builtin:asteroid") as window:
            before = window.state()["picture"]
            let_time_pass(3.0)
            drawn = int(re.search(r"drew (\d+) frames", window.quit())[1])
        self.assertLess(drawn - before, 15, "three seconds at 20 a second would be 60")

    def test_the_window_can_be_resized(self):
        with Window(self, "builtin:asteroid") as window:
            self.display.xdotool("windowsize", "--sync", window.number, 900, 600)
            window.wait_for("its size", size="900x600")
            window.shows(lambda small: max(ImageStat.Stat(small.crop((905, 0, 1400, 900))).stddev) < 1.0,
                         "nothing beside the smaller window")
            window.shows(lambda small: max(ImageStat.Stat(small.crop((300, 100, 890, 500))).stddev) > 10.0,
                         "the views in the smaller window")
            window.quit()

    def test_a_minimised_window_draws_nothing_and_can_be_restored(self):
        with Window(self, "builtin:asteroid") as window:
            before = self.display.grab()
            hidden = window.minimise()
            self.display.xdotool("key", "plus")  # without effect: it has no focus
            let_time_pass(2.0)
            self.assertLess(window.restore() - hidden, 15, "two seconds at 20 a second would be 40")
            window.shows(lambda picture: difference(before, picture) < 1.0, "the same as before")
            window.quit()

    def test_a_minimised_window_of_a_moving_scene_draws_nothing(self):
        with Window(self, "builtin:asteroid", "--object-rate", "0,0,1") as window:
            window.wait_for("the next frame", frame=lambda now: now > 3)
            hidden = window.minimise()
            let_time_pass(2.0)
            self.assertLess(window.restore() - hidden, 15, "two seconds at 30 Hz would be 60")
            window.quit()

    def test_a_dropped_file_opens(self):
        path = os.path.join(self.folder, "a box.obj")
        with open(path, "w", encoding="utf-8") as file:
            file.write(BOX)
        with Window(self, "builtin:asteroid") as window:
            before = self.display.grab()
            self.display.drop(window.number, path)
            window.shows(lambda picture: difference(before.crop(SENSOR_BOX), picture.crop(SENSOR_BOX)) > 5.0,
                         "another picture")
            window.save("buffer")
            window.quit()
        self.succeed("render", path, "--legacy-output", "expected")
        self.assertEqual(self.read("buffer.pcd"), self.read("expected.pcd"))

    def test_errors_are_shown_in_window_and_terminal_and_it_continues(self):
        with Window(self, "builtin:asteroid", "-o", "no_folder/x.pcd") as window:
            self.assertFalse(is_red(self.display.grab()))
            window.key("s")
            window.shows(is_red, "a red panel")
            self.assertIn("no_folder", window.quit())

    def test_a_lost_context_is_created_again(self):
        library = self.build_shim()
        self.environment["LD_PRELOAD"] = library
        with Window(self, "builtin:asteroid") as window:
            def is_told_after_another_key():  # which may be lost with the window
                self.display.xdotool("key", "plus")
                return is_red(self.display.grab())
            wait_until(is_told_after_another_key, "the error", window.program, max_s=WINDOW_WAIT_S)
            window.shows(lambda picture: max(ImageStat.Stat(picture.crop(SENSOR_BOX)).stddev) > 20.0, "the object")
            window.quit()

    def build_shim(self):
        """A library that makes OpenGL report a reset once, at the tenth query."""
        source = os.path.join(self.folder, "reset.c")
        with open(source, "w", encoding="utf-8") as file:
            file.write("""
#include <epoxy/gl.h>
static GLenum report(void) {
  static int asked = 0;
  return ++asked == 10 ? GL_GUILTY_CONTEXT_RESET : GL_NO_ERROR;
}
__attribute__((constructor)) static void replace(void) {
  epoxy_glGetGraphicsResetStatus = report;
}
""")
        library = os.path.join(self.folder, "reset.so")
        subprocess.run(["cc", "-shared", "-fPIC", source, "-o", library, "-lepoxy"], check=True)
        return library


class ScreenshotTest(DisplayTest):
    """Screenshots without user input."""

    def shoot(self, *arguments):
        path = os.path.join(self.folder, "shot.png")
        done = self.succeed("view", *arguments, "--screenshot", "shot.png")
        with Image.open(path) as image:
            return image.convert("RGB"), done.stdout

    def test_looks_like_the_reference(self):
        """Only the views: fonts and milliseconds may differ."""
        image, _ = self.shoot("builtin:asteroid", "--model-r", "1,0,0,1", "--frames", "3")
        self.assertEqual(image.size, (1280, 720))
        views = image.crop((290, 20, 1280, 600)).resize((330, 193), Image.Resampling.BOX)
        with Image.open(os.path.join(HERE, "asteroid_views.png")) as expected:
            self.assertLess(difference(views, expected.convert("RGB")), 2.0)

    def test_the_gpu_renderer_shows_the_same(self):
        cast, _ = self.shoot("builtin:torus")
        gpu, _ = self.shoot("builtin:torus", "--renderer", "gpu")
        self.assertLess(difference(cast.crop(SENSOR_BOX), gpu.crop(SENSOR_BOX)), 0.5)

    def test_frames_are_the_sensors_frames_and_repeatable(self):
        arguments = ("builtin:asteroid", "--object-rate", "0,2,0", "--frames", "7")
        first, reported = self.shoot(*arguments)
        self.assertIn("7 frames in", reported)
        second, _ = self.shoot(*arguments)
        self.assertEqual(difference(first.crop((290, 20, 1280, 640)),
                                    second.crop((290, 20, 1280, 640))), 0.0)

    def test_a_window_of_another_size(self):
        image, _ = self.shoot("builtin:asteroid", "--window", "640x480")
        self.assertEqual(image.size, (640, 480))

    def test_a_scanner_shows_its_revolution(self):
        image, _ = self.shoot("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0")
        self.assertGreater(max(ImageStat.Stat(image.crop(SENSOR_BOX)).stddev), 30.0)

    def test_bad_input_is_an_error_and_leaves_no_file(self):
        error = self.refused("view", "missing.obj", "--screenshot", "shot.png")
        self.assertIn("missing.obj", error)
        for size in ("100x100", "1280", "1280x720x3", "axb", "1280x99999"):
            self.assertIn("--window", self.refused("view", "builtin:box", "--window", size))
        for path, why in (("no_folder/a.png", "no_folder"), ("a.jpg", ".png")):
            self.assertIn(why, self.refused("view", "builtin:box", "--screenshot", path))

    def test_without_a_display_the_error_has_a_remedy(self):
        del self.environment["DISPLAY"]
        error = self.refused("view", "builtin:box")
        self.assertIn("no display", error)
        self.assertIn("xvfb-run", error)
        self.assertIn("glidar render", error)

    def test_a_missing_display_is_named(self):
        self.environment["DISPLAY"] = ":9999"
        self.assertIn("DISPLAY is ':9999'", self.refused("view", "builtin:box"))

    def test_without_a_driver_the_error_lists_what_to_install(self):
        """The display has no GLX, and EGL no vendor."""
        with Display("-extension", "GLX") as display:
            self.environment |= {"DISPLAY": display.name, "__EGL_VENDOR_LIBRARY_DIRS": self.folder}
            error = self.refused("view", "builtin:box", "--frames", "1")
        self.assertIn("no context of OpenGL 3.3", error)
        self.assertIn("libgl1-mesa-dri", error)

    def test_messages_of_a_driver_do_not_precede_the_error(self):
        """Mesa before 24 prints that it finds no driver there, later versions find theirs."""
        self.environment |= {"LIBGL_DRIVERS_PATH": self.folder, "GBM_BACKENDS_PATH": self.folder}
        self.refused("view", "missing.obj", "--screenshot", "shot.png")
        self.refused("render", "missing.obj", "--renderer", "opengl", "-o", "x.pcd")
        self.environment["__EGL_VENDOR_LIBRARY_DIRS"] = self.folder
        self.assertIn("libgl1-mesa-dri", self.refused("render", "builtin:box", "--renderer", "opengl", "-o", "x.pcd"))


if __name__ == "__main__":
    if missing_programs():
        skip(f"no {', '.join(missing_programs())}", IN_DEV)
    unittest.main(failfast=True)  # so that one hang is reported before CTest ends the program

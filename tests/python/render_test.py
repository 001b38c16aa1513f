"""alpenglow.render(): pictures, outputs, figures, progress, the end by Ctrl-C, threads."""
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy

import alpenglow
from common import BALLS, PROGRAM, WALL, InFolder, png_pixels, read_exr, run


class Pictures(InFolder):
    def test_a_wall_has_its_colour_everywhere(self):
        result = alpenglow.render(WALL)
        self.assertEqual(result.image.shape, (6, 8, 4))
        self.assertEqual(result.image.dtype, numpy.float32)
        numpy.testing.assert_array_equal(result.image, numpy.broadcast_to(numpy.float32([0.25, 0.5, 1, 1]), (6, 8, 4)))
        self.assertEqual(result.picture.channels, ["r", "g", "b", "a"])
        self.assertEqual(result.status, 0)
        self.assertEqual(os.listdir("."), [])  # nothing is written

    def test_outputs_by_name(self):
        result = alpenglow.render(WALL, aovs=["z", "N", "Ci"])
        numpy.testing.assert_array_equal(result["z"], numpy.full((6, 8), 3, numpy.float32))
        numpy.testing.assert_allclose(numpy.abs(result["N"]), numpy.broadcast_to([0, 0, 1], (6, 8, 3)), atol=1e-6)
        numpy.testing.assert_array_equal(result["Ci"][0, 0], numpy.float32([0.25, 0.5, 1]))
        self.assertIn("N", result)
        with self.assertRaisesRegex(KeyError, "no picture has 'Q'"):
            result["Q"]

    def test_displays_of_the_scene_are_the_pictures(self):
        result = alpenglow.render('Display "a.exr" "openexr" "rgb"\nDisplay "+b.exr" "openexr" "z"\n' + WALL)
        self.assertEqual([(p.name, p.variables) for p in result], [("a.exr", ["Ci"]), ("b.exr", ["z"])])
        self.assertEqual(os.listdir("."), [])

    def test_write_writes_them_with_the_same_numbers(self):
        scene = 'Display "a.exr" "openexr" "rgba"\n' + BALLS
        result = alpenglow.render(scene, write=True)
        file = read_exr("a.exr")
        numpy.testing.assert_array_equal(result.image, numpy.stack([file[c] for c in "RGBA"], 2))

    def test_the_program_makes_the_same_bits(self):
        for hider in ("path", "hidden"):
            pathlib.Path("balls.rib").write_text(BALLS)
            status, _, said = run(PROGRAM, "render", "-q", "--hider", hider, "-o", "program.exr", "balls.rib")
            self.assertEqual(status, 0, said)
            file = read_exr("program.exr")
            result = alpenglow.render("balls.rib", hider=hider)
            self.assertGreater(result.image[:, :, :3].max(), 0.1)
            numpy.testing.assert_array_equal(result.image, numpy.stack([file[c] for c in "RGBA"], 2))

    def test_output_writes_one_file(self):
        result = alpenglow.render('Display "a.exr" "openexr" "rgb"\n' + WALL, output="x.png")
        self.assertEqual(os.listdir("."), ["x.png"])
        numpy.testing.assert_array_equal(result.image[2, 2, :3], numpy.float32([0.25, 0.5, 1]))  # light, whatever PNG has

    def test_crop_window(self):
        result = alpenglow.render(WALL, crop=(0.25, 0.75, 0, 0.5))
        self.assertEqual(result.picture.window, (2, 0, 6, 3))
        self.assertEqual(result.picture.size, (8, 6))
        self.assertEqual(result.image.shape, (3, 4, 4))

    def test_frames(self):
        scene = "".join(f"FrameBegin {n}\n{WALL}\nFrameEnd\n" for n in (1, 2, 5))
        result = alpenglow.render(scene)
        self.assertEqual([p.frame for p in result], [1, 2, 5])
        self.assertEqual(len(alpenglow.render(scene, frames=[2, 5])), 2)
        self.assertEqual(result.frame(5)[0].data.shape, (6, 8, 4))

    def test_bytes_and_paths_and_lists(self):
        pathlib.Path("wall.rib").write_text(WALL)
        wall = alpenglow.render(WALL).image
        for scene in (WALL.encode(), "wall.rib", pathlib.Path("wall.rib"), ["wall.rib"]):
            numpy.testing.assert_array_equal(alpenglow.render(scene).image, wall)

    def test_a_notebook_shows_srgb(self):
        result = alpenglow.render(WALL)
        pixels = png_pixels(result._repr_png_())
        self.assertEqual(pixels.shape, (6, 8, 3))
        # IEC 61966-2-1: 255 (1.055 x^(1/2.4) - 0.055) of 0.25, 0.5 and 1
        self.assertEqual(pixels[3, 3].tolist(), [137, 188, 255])
        result.picture.save("wall.png")
        self.assertTrue(os.path.exists("wall.png"))

    def test_options_reach_the_renderer(self):
        result = alpenglow.render(BALLS, format=(20, 10), spp=7, seed=3, max_depth=2, threads=1)
        self.assertEqual(result.image.shape[:2], (10, 20))
        self.assertEqual(result.stats["spp"], 7)
        self.assertEqual(result.stats["threads"], 1)

    def test_statistics(self):
        stats = alpenglow.render(BALLS, spp=4).stats
        for key in ("width", "height", "spp", "renderSec", "cpuSec", "raysPerMS", "noiseRSE", "threads", "rays", "frames"):
            self.assertIn(key, stats)
        self.assertEqual((stats["width"], stats["height"], stats["spp"]), (48, 32, 4))
        self.assertEqual(stats["rays"]["camera"], 48 * 32 * 4)
        self.assertGreater(stats["noiseRSE"], 0)


class Faults(InFolder):
    def test_wrong_options(self):
        with self.assertRaisesRegex(alpenglow.Error, "no option --ssp; did you mean --spp"):
            alpenglow.render(WALL, ssp=3)
        with self.assertRaisesRegex(alpenglow.Error, "--spp"):
            alpenglow.render(WALL, spp="many")
        with self.assertRaisesRegex(alpenglow.Error, "not for use in Python"):
            alpenglow.render(WALL, watch=True)
        with self.assertRaisesRegex(alpenglow.Error, "not for use in Python"):
            alpenglow.render(WALL, frames_at_once=2)
        with self.assertRaises(alpenglow.Error):
            alpenglow.render(17)
        with self.assertRaises(alpenglow.Error):
            alpenglow.render([])

    def test_no_file_and_no_world(self):
        with self.assertRaisesRegex(alpenglow.Error, "nowhere.rib") as caught:
            alpenglow.render("nowhere.rib", quiet=True)
        self.assertEqual(caught.exception.messages[0].code, 3)  # RIE_NOFILE
        with self.assertRaisesRegex(alpenglow.Error, "no world"):
            alpenglow.render("Format 4 4 1\n")

    def test_errors_have_places_and_the_rest_is_rendered(self):
        heard = []
        result = alpenglow.render(WALL.replace("WorldEnd", 'Sphere 1 "x"\nWorldEnd'), quiet=True, message=heard.append)
        self.assertEqual(result.status, 1)
        error = result.errors[0]
        self.assertEqual((error.file, error.line, error.severity), ("RIB", 10, "error"))
        self.assertIn("Sphere", error.message)
        self.assertEqual(heard, result.messages)
        numpy.testing.assert_array_equal(result.image[0, 0], numpy.float32([0.25, 0.5, 1, 1]))
        with self.assertRaisesRegex(alpenglow.Error, "Sphere"):
            alpenglow.render(WALL.replace("WorldEnd", 'Sphere 1 "x"\nWorldEnd'), quiet=True, strict=True)

    def test_what_message_raises_comes_out(self):
        def stop(_):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            alpenglow.render(WALL.replace("WorldEnd", 'Sphere 1 "x"\nWorldEnd'), message=stop, quiet=True)

    def test_foreign_code_is_asked_for(self):
        scene = WALL.replace("WorldEnd", 'Procedural "RunProgram" ["touch x" ""] [-1 1 -1 1 -1 1]\nWorldEnd')
        result = alpenglow.render(scene, quiet=True)
        self.assertIn("--allow-exec", result.errors[0].message + result.errors[0].hint)
        self.assertEqual(os.listdir("."), [])


ENDLESS = dict(hider="path", spp=1000000, format=(64, 64))


class Progress(InFolder):
    def test_it_is_told(self):
        told = []
        result = alpenglow.render(BALLS, hider="path", spp=3000, progress=told.append)
        self.assertEqual(result.status, 0)
        self.assertGreater(len(told), 0)
        fractions = [t["fraction"] for t in told]
        self.assertEqual(fractions, sorted(fractions))
        self.assertTrue(all(0 <= f <= 1 for f in fractions))
        self.assertEqual(told[-1]["total"], 3000)

    def test_false_ends_it_and_keeps_the_passes(self):
        result = alpenglow.render(BALLS, progress=lambda t: t["samples"] < 2, **ENDLESS)
        self.assertTrue(result.interrupted)
        self.assertGreater(result.image[:, :, :3].max(), 0)

    def test_what_it_raises_comes_out(self):
        def bad(told):
            raise ZeroDivisionError("of the test")

        with self.assertRaisesRegex(ZeroDivisionError, "of the test"):
            alpenglow.render(BALLS, progress=bad, **ENDLESS)

    def test_what_grows_can_be_seen(self):
        for hider in ("path", "hidden"):
            seen = []
            result = alpenglow.render(BALLS, hider=hider, spp=2000 if hider == "path" else 400, preview=seen.append, threads=1)
            self.assertGreater(len(seen), 0, hider)
            self.assertTrue(all(p.data.shape == (32, 48, 4) for p in seen))
            self.assertLess(numpy.abs(seen[-1].data - result.image).mean(), 0.5)

    def test_an_interrupted_picture_keeps_whole_tiles(self):
        # How many tiles are whole by then depends on the machine; hidden writes none that is not.
        result = alpenglow.render(BALLS, hider="hidden", spp=900, format=(128, 96), threads=1,
                                  progress=lambda t: t["fraction"] < 0.6)
        self.assertTrue(result.interrupted)
        self.assertEqual(result.image.shape, (96, 128, 4))
        self.assertTrue(numpy.isfinite(result.image).all())

    def test_other_threads_run_meanwhile(self):
        turns, over = [0], threading.Event()

        def count():
            while not over.is_set():
                turns[0] += 1
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        before = turns[0]
        alpenglow.render(BALLS, hider="path", spp=3000)
        after = turns[0]
        over.set()
        counter.join()
        self.assertGreater(after, before)

    def test_control_c(self):
        timer = threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        began = time.time()
        with self.assertRaises(KeyboardInterrupt) as caught:
            alpenglow.render(BALLS, **ENDLESS)
        self.assertLess(time.time() - began, 30)
        self.assertIsInstance(caught.exception, alpenglow.Interrupted)
        self.assertTrue(caught.exception.result.interrupted)
        self.assertGreater(caught.exception.result.image[:, :, :3].max(), 0)
        alpenglow.render(WALL)  # the next one is not stopped

    def test_control_c_ends_a_script(self):
        with open("endless.py", "w") as f:
            f.write(f"import alpenglow\nalpenglow.render({BALLS!r}, **{ENDLESS!r})\n")
        script = subprocess.Popen([sys.executable, "endless.py"], stderr=subprocess.PIPE, text=True)
        time.sleep(2)
        script.send_signal(signal.SIGINT)
        _, said = script.communicate(timeout=60)
        self.assertNotEqual(script.returncode, 0)
        self.assertIn("Interrupted", said)


class Threads(InFolder):
    def test_renders_at_the_same_time_are_as_alone(self):
        scenes = [BALLS, BALLS.replace("[1 0.3 0.1]", "[0 1 0]"), WALL, BALLS.replace("fov\" 40", "fov\" 60")]
        alone = [alpenglow.render(s).image for s in scenes]
        together = [None] * len(scenes)

        def work(i):
            together[i] = alpenglow.render(scenes[i]).image

        threads = [threading.Thread(target=work, args=(i,)) for i in range(len(scenes))]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        for a, b in zip(alone, together):
            numpy.testing.assert_array_equal(a, b)


if __name__ == "__main__":
    unittest.main()

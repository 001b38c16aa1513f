"""alpenglow.prman: the interface of Pixar's module."""
import gzip
import os
import pathlib
import random
import signal
import subprocess
import sys
import threading
import unittest

import numpy

import alpenglow
from alpenglow import prman
from common import BALLS, PROGRAM, InFolder, read_exr, run


def draw_balls(ri):
    """The scene of common.BALLS, request by request."""
    ri.Format(48, 32, 1)
    ri.Hider("path")
    ri.PixelSamples(3, 3)
    ri.Projection(ri.PERSPECTIVE, {ri.FOV: 40})
    ri.Translate(0, 0, 5)
    ri.WorldBegin()
    ri.LightSource("distantlight", {"from": [1, 2, -3], "to": [0, 0, 0], "intensity": 2})
    ri.AttributeBegin()
    ri.Color([1, 0.3, 0.1])
    ri.Surface("plastic", {"Kd": 0.6})
    ri.Translate(-0.7, 0, 0)
    ri.Sphere(1, -1, 1, 360)
    ri.AttributeEnd()
    ri.AttributeBegin()
    ri.Color((0.2, 0.6, 1))
    ri.Translate(1, 0, 0.5)
    ri.Rotate(30, 0, 1, 0)
    ri.Sphere(0.7, -0.7, 0.7, 360)
    ri.AttributeEnd()
    ri.WorldEnd()


def rib_of(draw, **options):
    """What a context writes that `draw` makes requests in."""
    ri = prman.Ri()
    if options:
        ri.Option("rib", options)
    ri.Begin("made.rib")
    draw(ri)
    ri.End()
    return pathlib.Path("made.rib").read_bytes()


def lines_of(draw):
    return [l.strip() for l in rib_of(draw, **{"string asciistyle": "wide"}).decode().splitlines() if l and not l.startswith("##")]


class OptionsOfPrman24(InFolder):
    def test_each_is_an_option_of_its_category(self):
        def draw(ri):
            ri.Options("PRManOptions", "id", {"string searchpath:texture": ["maps:@"], "int limits:bucketsize": [16, 8],
                                              "string searchpath:shader": [""], "int Ri:Frame": [3], "float hider:maxsamples": 4,
                                              "string statistics:filename": "a.xml"})

        self.assertEqual(lines_of(draw), ['Option "searchpath" "string texture" ["maps:@"]', 'Option "limits" "int[2] bucketsize" [16 8]',
                                          'Option "statistics" "string filename" ["a.xml"]'])


class Rendering(InFolder):
    def test_it_makes_the_bits_of_the_same_scene_as_rib(self):
        ri = prman.Ri()
        ri.Begin("__render")
        ri.Display("python.exr", "openexr", "rgba")
        draw_balls(ri)
        ri.End()
        pathlib.Path("scene.rib").write_text('Display "rib.exr" "openexr" "rgba"\n' + BALLS)
        self.assertEqual(run(PROGRAM, "render", "-q", "scene.rib")[0], 0)
        python, rib = read_exr("python.exr"), read_exr("rib.exr")
        for channel in "RGBA":
            numpy.testing.assert_array_equal(python[channel], rib[channel])
        self.assertGreater(rib["R"].max(), 0.1)

    def test_and_of_the_rib_that_it_writes(self):
        direct = prman.Ri(keep_pictures=True)
        direct.Begin(direct.RENDER)
        direct.Display("a", "null", "rgba")
        draw_balls(direct)
        direct.End()
        picture = direct.pictures[0].data
        for options in ({}, {"string format": "binary"}, {"string format": ["binary"], "string compression": ["gzip"]},
                        {"string asciistyle": ["indented"]}):
            written = rib_of(draw_balls, **options)
            numpy.testing.assert_array_equal(alpenglow.render(written).image, picture)

    def test_import_prman(self):
        done = subprocess.run([sys.executable, "-c", "import prman; ri = prman.Ri(); print(ri.FOV, prman.__name__)"],
                              capture_output=True, text=True)
        self.assertEqual(done.stdout, "fov prman\n", done.stderr)

    def test_many_contexts_one_after_the_other(self):
        ri = prman.Ri(keep_pictures=True)
        for k in (1, 2):
            ri.Begin("__render")
            ri.Display("x", "null", "rgb")
            ri.Format(4, 4, 1)
            ri.WorldBegin()
            ri.Color([k, k, k])
            ri.Surface("constant")
            ri.Sphere(10, -10, 10, 360)
            ri.WorldEnd()
            ri.End()
            numpy.testing.assert_array_equal(ri.pictures[0].data[1, 1], [k, k, k])

    def test_statistics(self):
        ri = prman.Ri(flags=["--spp", "2"])
        ri.Begin("__render")
        ri.Display("x", "null", "rgb")
        draw_balls(ri)
        ri.End()
        self.assertEqual(ri.stats["spp"], 2)

    def test_flags_of_prman(self):
        prman.Init(["-t:1", "-progress"])
        try:
            ri = prman.Ri()
            ri.Begin()
            ri.Display("x", "null", "rgb")
            draw_balls(ri)
            ri.End()
            self.assertEqual(ri.stats["threads"], 1)
        finally:
            prman.Cleanup()

    def test_the_command_runs_scripts(self):
        pathlib.Path("script.py").write_text(
            "import prman, sys\nri = prman.Ri()\nri.Begin('__render')\nri.Display(sys.argv[1], 'openexr', 'rgb')\n"
            "ri.WorldBegin()\nri.Sphere(1, -1, 1, 360)\nri.WorldEnd()\nri.End()\n")
        status, _, said = run(sys.executable, "-m", "alpenglow", "--format", "10x5", "script.py", "out.exr")
        self.assertEqual(status, 0, said)
        self.assertEqual(read_exr("out.exr")["R"].shape, (5, 10))
        self.assertEqual(run(sys.executable, "-m", "alpenglow")[0], 2)
        status, _, said = run(sys.executable, "-m", "alpenglow", "--sp", "3", "script.py", "out.exr")
        self.assertEqual(status, 2)
        self.assertIn("no option --sp", said)


class Writing(InFolder):
    def test_requests_stand_as_they_came(self):
        def draw(ri):
            ri.FrameBegin(3)
            ri.Display("a.exr", "it", "rgba", {"string filter": "box"})
            ri.WorldBegin()
            ri.Attribute("identifier", {"name": "ball"})
            ri.MotionBegin([0, 1])
            ri.Translate(1, 2, 3)
            ri.Translate(1.5, 2, 3)
            ri.MotionEnd()
            ri.Basis(ri.CATMULLROMBASIS, ri.CATMULLROMSTEP, ri.BEZIERBASIS, ri.BEZIERSTEP)
            ri.PixelFilter(ri.GAUSSIANFILTER, 2, 2)
            ri.Polygon({ri.P: [0, 0, 0, 1, 0, 0, 1, 1, 0], "varying float[2] st": [0, 0, 1, 0, 1, 1]})
            ri.Sphere(1, -1, 1, 360, {"Cs": [0.25, 0.5, 1]})
            ri.WorldEnd()
            ri.FrameEnd()

        self.assertEqual(lines_of(draw), [
            "FrameBegin 3", 'Display "a.exr" "it" "rgba" "string filter" ["box"]', "WorldBegin",
            'Attribute "identifier" "name" ["ball"]', "MotionBegin [0 1]", "Translate 1 2 3", "Translate 1.5 2 3", "MotionEnd",
            'Basis "catmull-rom" 1 "bezier" 3', 'PixelFilter "gaussian" 2 2',
            'Polygon "P" [0 0 0 1 0 0 1 1 0] "varying float[2] st" [0 0 1 0 1 1]', 'Sphere 1 -1 1 360 "Cs" [0.25 0.5 1]', "WorldEnd",
            "FrameEnd"])

    def test_arrays_of_all_kinds(self):
        p = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
        wanted = ['Polygon "P" [0 0 0 1 0 0 1 1 0]']
        for given in (p, tuple(map(tuple, p)), numpy.float32(p), numpy.array(p), numpy.int8(p), numpy.float64(p).T.copy().T,
                      (x for q in p for x in q), numpy.float32([p, p])[1], map(list, p)):
            self.assertEqual(lines_of(lambda ri: ri.Polygon({"P": given})), wanted)
        self.assertEqual(lines_of(lambda ri: ri.Sphere(numpy.float32(1), numpy.int64(-1), True, 360.0)), ["Sphere 1 -1 1 360"])
        self.assertEqual(lines_of(lambda ri: ri.Transform(numpy.eye(4))),
                         ["Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]"])

    def test_keywords_are_parameters(self):
        self.assertEqual(lines_of(lambda ri: ri.Surface("plastic", Kd=0.5)), ['Surface "plastic" "Kd" [0.5]'])

    def test_records(self):
        def draw(ri):
            ri.ArchiveRecord(ri.COMMENT, "by %s, %d times", "hand", 3)
            ri.ArchiveRecord(ri.STRUCTURE, "Scene one")
            ri.ArchiveRecord(ri.VERBATIM, "Sphere 2 -2 2 360\n")

        text = rib_of(draw).decode()
        self.assertIn("#by hand, 3 times", text)
        self.assertIn("##Scene one", text)
        self.assertIn("\nSphere 2 -2 2 360\n", text)

    def test_handles(self):
        def draw(ri):
            ball = ri.ObjectBegin()
            ri.Sphere(1, -1, 1, 360)
            ri.ObjectEnd()
            self.assertIsInstance(ball, str)
            ri.ObjectInstance(ball)
            ri.ArchiveRecord(ri.VERBATIM, 'ObjectInstance "' + ball + '"')
            key = ri.LightSource("pointlight", {ri.HANDLEID: "key", "intensity": [3]})
            self.assertEqual(key, "key")
            other = ri.AreaLightSource("arealight")
            self.assertNotEqual(other, ri.LightSource("ambientlight", {"intensity": 0.1}))
            ri.Illuminate(key, 0)

        lines = lines_of(draw)
        self.assertIn('LightSource "pointlight" "key" "intensity" [3]', lines)
        self.assertIn('Illuminate "key" 0', lines)

    def test_gzip_by_name(self):
        ri = prman.Ri()
        ri.Begin("a.rib.gz")
        ri.Sphere(1, -1, 1, 360)
        ri.End()
        self.assertIn(b"Sphere 1 -1 1 360", gzip.open("a.rib.gz").read())

    def test_standard_output(self):
        code = "import prman\nri = prman.Ri()\nri.Begin('-')\nri.Sphere(1,-1,1,360)\nri.End()\n"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertIn("Sphere 1 -1 1 360\n", done.stdout)

    def test_every_request_and_its_sample(self):
        """The table has correct arguments for each request: the method takes them, and the reader says nothing."""
        for request in alpenglow.requests():
            name = request["name"]
            if name in ("ArchiveRecord", "ErrorHandler", "Procedural", "Procedural2", "ReadArchive"):
                continue
            arguments, parameters = sample_of(request)

            def draw(ri):
                getattr(ri, name)(*arguments, *([parameters] if parameters else []))

            ri = prman.Ri()
            ri.Begin("made.rib")
            draw(ri)
            ri.End()
            self.assertEqual([str(m) for m in ri.messages], [], name)
            self.assertIn(name, pathlib.Path("made.rib").read_text(), name)

    def test_a_file_that_cannot_be_written(self):
        ri = prman.Ri()
        ri.Begin("no/such/folder/a.rib")
        with self.assertRaisesRegex(alpenglow.Error, "cannot be written"):
            ri.Sphere(1, -1, 1, 360)


def sample_of(request):
    """The sample of a request as arguments and parameters of Python."""
    import re
    values = []
    for token in re.findall(r'"[^"]*"|\[|\]|[^\s\[\]]+', request["sample"]):
        if token == "[":
            values.append([])
        elif token == "]":
            values[-1] = tuple(values[-1])
        else:
            v = token[1:-1] if token[0] == '"' else float(token) if "." in token or "e" in token else int(token)
            (values[-1] if values and isinstance(values[-1], list) else values).append(v)
    if not request["parameters"]:
        return values, {}
    needed = sum(max(1, count) if form in ("number", "int") and not isinstance(values[i] if i < len(values) else 0, tuple) else 1
                 for i, (_, form, count, _) in enumerate(request["arguments"]))
    needed = min(needed, len(values))
    while needed < len(values) and not isinstance(values[needed], str):
        needed += 1
    rest = values[needed:]
    if len(rest) % 2:  # an optional argument
        needed += 1
        rest = values[needed:]
    return values[:needed], dict(zip(rest[::2], rest[1::2]))


class Procedurals(InFolder):
    def scene(self, ri, make):
        ri.Begin("__render")
        ri.Display("p", "null", "rgba")
        ri.Format(16, 16, 1)
        ri.PixelFilter("box", 1, 1)
        ri.Projection("orthographic")
        ri.WorldBegin()
        ri.Surface("constant")
        ri.Translate(0, 0, 3)
        make()
        ri.WorldEnd()
        ri.End()
        return ri.pictures[0].data

    def test_functions_make_content(self):
        freed, details = [], []

        def halves(data, detail):
            ri, side, depth = data
            details.append(detail)
            if depth == 0:
                ri.Color([1, 0, 0])
                ri.Patch("bilinear", {"P": [-side, -side, 0, side, -side, 0, -side, side, 0, side, side, 0]})
            else:
                for x in (-side / 2, side / 2):
                    ri.TransformBegin()
                    ri.Translate(x, 0, 0)
                    ri.Procedural((ri, side / 2, depth - 1), [-side, side, -side, side, -1, 1], halves, freed.append)
                    ri.TransformEnd()

        ri = prman.Ri(keep_pictures=True)
        data = (ri, 1.0, 2)
        image = self.scene(ri, lambda: ri.Procedural(data, [-1, 1, -1, 1, -1, 1], halves, freed.append))
        self.assertEqual(len(freed), 7)
        self.assertEqual(freed[-1], data)
        self.assertAlmostEqual(details[0], 16 * 16, delta=1e-3)  # the bound's area in the picture, pixels
        rows = numpy.flatnonzero(image[:, 8, 0] > 0.5)  # a band of four squares of side 0.5 around the middle
        self.assertEqual((rows.min(), rows.max()), (6, 9))
        self.assertTrue((image[7, :, 0] == 1).all())

    def test_ri_comes_first_for_functions_of_three(self):
        ri = prman.Ri(keep_pictures=True)
        heard = []
        self.scene(ri, lambda: ri.Procedural("data", [-1, 1, -1, 1, -1, 1], lambda r, d, detail: heard.append((r, d))))
        self.assertEqual(heard, [(ri, "data")])

    def test_the_state_comes_back(self):
        ri = prman.Ri(keep_pictures=True)

        def leave(data, detail):
            ri.Color([0, 1, 0])
            ri.Translate(100, 0, 0)
            ri.AttributeBegin()  # not closed: reported, and closed

        def draw():
            ri.Color([0, 0, 1])
            ri.ErrorHandler(ri.ERRORIGNORE)
            ri.Procedural(None, [-1, 1, -1, 1, -1, 1], leave)
            ri.Sphere(1, -1, 1, 360)

        image = self.scene(ri, draw)
        numpy.testing.assert_array_equal(image[8, 8], [0, 0, 1, 1])
        self.assertIn(24, [m.code for m in ri.messages])  # RIE_NESTING

    def test_what_they_raise_is_told_and_comes_out(self):
        ri = prman.Ri()
        ri.ErrorHandler(ri.ERRORIGNORE)
        freed = []

        def bad(data, detail):
            raise ValueError("of the test")

        ri.Begin("__render")
        ri.WorldBegin()
        with self.assertRaisesRegex(ValueError, "of the test"):
            ri.Procedural(1, [-1, 1, -1, 1, -1, 1], bad, freed.append)
        self.assertEqual(freed, [1])
        self.assertTrue(any("ValueError: of the test" in m.message for m in ri.messages))
        ri.Sphere(1, -1, 1, 360)  # it goes on
        ri.Display("x", "null", "rgb")
        ri.WorldEnd()
        ri.End()

    def test_in_a_file_their_content_stands(self):
        def ball(data, detail):
            self.assertGreater(detail, 1e37)
            data.Sphere(1, -1, 1, 360)

        self.assertEqual(lines_of(lambda ri: ri.Procedural(ri, [-1, 1, -1, 1, -1, 1], ball, None)),
                         ["AttributeBegin", "Sphere 1 -1 1 360", "AttributeEnd"])

    def test_those_of_the_renderer(self):
        def draw(ri):
            ri.Procedural2(ri.Proc2DelayedReadArchive, ri.SimpleBound, {"string filename": ["a.rib"],
                                                                         "float[6] __bound": [-1, 1, -1, 1, -1, 1]})
            ri.Procedural(["a.rib"], [-1, 1, -1, 1, -1, 1], ri.ProcDelayedReadArchive, ri.ProcFree)
            ri.Procedural(["prog", "data"], [-1, 1, -1, 1, -1, 1], ri.ProcRunProgram)

        self.assertEqual(lines_of(draw), ['Procedural2 "DelayedReadArchive2" "SimpleBound" "string filename" ["a.rib"] '
                                          '"float[6] bound" [-1 1 -1 1 -1 1]',
                                          'Procedural "DelayedReadArchive" ["a.rib"] [-1 1 -1 1 -1 1]',
                                          'Procedural "RunProgram" ["prog" "data"] [-1 1 -1 1 -1 1]'])


class Archives(InFolder):
    def test_comments_of_an_archive(self):
        pathlib.Path("part.rib").write_text("#one\n##two\nSphere 1 -1 1 360\n#three\n")
        heard = []
        ri = prman.Ri()
        ri.Begin("__render")
        ri.Display("x", "null", "rgb")
        ri.WorldBegin()
        ri.ReadArchive("part.rib", lambda kind, text: heard.append((kind, text)))
        with self.assertRaisesRegex(KeyError, "mine"):
            ri.ReadArchive("part.rib", lambda kind, text: {}["mine"])
        ri.WorldEnd()
        ri.End()
        self.assertEqual(heard, [("comment", "one"), ("structure", "two"), ("comment", "three")])

    def test_verbatim_is_read(self):
        ri = prman.Ri(keep_pictures=True)
        ri.Begin("__render")
        ri.Display("x", "null", "rgb")
        ri.Format(4, 4, 1)
        ri.WorldBegin()
        ri.ArchiveRecord(ri.VERBATIM, 'Surface "constant" Color [0 1 0] Sphere 9 -9 9 360')
        ri.WorldEnd()
        ri.End()
        numpy.testing.assert_array_equal(ri.pictures[0].data[1, 1], [0, 1, 0])


class Order(InFolder):
    """Calls out of order and wrong ones: RIE codes, exceptions, no crash."""

    def test_before_and_after(self):
        ri = prman.Ri()
        codes = []
        ri.ErrorHandler(lambda code, severity, text: codes.append(code))
        ri.Sphere(1, -1, 1, 360)
        ri.End()
        ri.ArchiveRecord(ri.COMMENT, "x")
        ri.Procedural(1, [0, 1, 0, 1, 0, 1], lambda d, x: None)
        self.assertEqual(codes, [23, 23, 23, 23])  # RIE_NOTSTARTED
        ri.Begin("__render")
        ri.Begin("__render")
        self.assertEqual(codes[4:], [24])  # RIE_NESTING
        ri.WorldEnd()
        ri.AttributeEnd()
        ri.Sphere(1, -1, 1, 360)
        self.assertEqual(codes[5:], [24, 24, 27])  # ..., RIE_NOTPRIMS
        ri.End()
        ri.WorldBegin()
        self.assertEqual(codes[-1], 23)

    def test_places_are_lines_of_the_script(self):
        ri = prman.Ri()
        ri.ErrorHandler(ri.ERRORIGNORE)
        ri.Begin("__render")
        ri.Sphere(1)
        ri.End()
        m = ri.messages[0]
        self.assertTrue(m.file.endswith("prman_test.py"), m.file)
        with open(m.file) as f:
            self.assertEqual(f.readlines()[m.line - 1].strip(), "ri.Sphere(1)")

    def test_abort_raises(self):
        ri = prman.Ri()
        ri.ErrorHandler(ri.ERRORABORT)
        ri.Begin("__render")
        with self.assertRaisesRegex(alpenglow.Error, "Sphere"):
            ri.Sphere("x")
        ri.End()

    def test_wrong_arguments_raise(self):
        ri = prman.Ri()
        ri.Begin("made.rib")
        for wrong in (lambda: ri.Sphere(object()), lambda: ri.Polygon({"P": [1, "a"]}), lambda: ri.Polygon({3: [1]}),
                      lambda: ri.Polygon({"P": {}}), lambda: ri.Polygon({"P": None}), lambda: ri.WorldBegin({"a": 1}),
                      lambda: ri.Procedural(1, [1, 2], lambda d, x: None), lambda: ri.Translate([[[]] * 3, 1j], 2)):
            with self.assertRaises((alpenglow.Error, TypeError)):
                wrong()
        with self.assertRaisesRegex(AttributeError, "did you mean Sphere"):
            ri.Spere(1, -1, 1, 360)
        ri.End()

    def test_a_handler_that_raises(self):
        ri = prman.Ri()

        def handler(code, severity, text):
            raise RuntimeError(f"code {code}")

        ri.ErrorHandler(handler)
        ri.Begin("__render")
        with self.assertRaisesRegex(RuntimeError, "code 24"):
            ri.AttributeEnd()
        ri.ErrorHandler(ri.ERRORIGNORE)
        ri.End()

    def test_requests_while_it_renders(self):
        failures = []

        def progress(told):
            try:
                ri.Sphere(1, -1, 1, 360)
            except alpenglow.Error as e:
                failures.append(str(e))
            return False

        ri = prman.Ri(progress=progress, flags=["--spp", "100000"])
        ri.Begin("__render")
        ri.Display("x", "null", "rgb")
        draw_balls(ri)
        ri.End()
        self.assertTrue(failures and "renders" in failures[0], failures)

    def test_each_thread_has_its_own(self):
        images = {}

        def work(k):
            ri = prman.Ri(keep_pictures=True)
            ri.Begin("__render")
            ri.Display("x", "null", "rgb")
            ri.Format(8, 8, 1)
            ri.WorldBegin()
            ri.Surface("constant")
            ri.Color([k, 0, 0])
            for _ in range(200):
                ri.Sphere(9, -9, 9, 360)
            ri.WorldEnd()
            ri.End()
            images[k] = ri.pictures[0].data

        threads = [threading.Thread(target=work, args=(k,)) for k in range(1, 5)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        for k in range(1, 5):
            self.assertTrue((images[k][:, :, 0] == k).all())

    def test_random_calls(self):
        """Anything in any order: exceptions and messages, no crash."""
        dice = random.Random(5)
        names = [r["name"] for r in alpenglow.requests() if r["kind"] != "texture"]
        things = [0, 1, -1, 2.5, 1e38, float("nan"), float("inf"), "", "matte", "P", [], [1], [0, 0, 0], ["a", "b"], [1, 2, 3, 4] * 4,
                  None, True, {"P": [0, 0, 0, 1, 0, 0, 1, 1, 0]}, {"Cs": [1, 1, 1]}, {"": []}, {"uniform float[3] x": [1]}, -2**40]
        for round_ in range(6):
            ri = prman.Ri(flags=["--format", "4x4", "--spp", "1"])
            ri.ErrorHandler(ri.ERRORIGNORE)
            ri.Begin("__render" if round_ % 2 else "made.rib")
            ri.Display("x", "null", "rgb")
            for _ in range(400):
                name = dice.choice(names)
                if name in ("Display", "System", "ReadArchive", "ErrorHandler"):
                    continue
                try:
                    getattr(ri, name)(*[dice.choice(things) for _ in range(dice.randrange(5))])
                except (alpenglow.Error, TypeError, OverflowError, AttributeError):
                    pass
            ri.End()


class Foreign(InFolder):
    def test_a_library_of_procedurals(self):
        library = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "procedurals", "facets.so")
        if not os.path.exists(library):
            self.skipTest("the libraries of the tests are not built")

        def draw(ri):
            ri.ErrorHandler(ri.ERRORIGNORE)
            ri.Begin("__render")
            ri.Display("x", "null", "rgba")
            ri.Format(16, 16, 1)
            ri.Projection("orthographic")
            ri.Translate(0, 0, 3)
            ri.WorldBegin()
            ri.Surface("constant")
            ri.Procedural([library, "halves 0.5"], [-1, 1, -1, 1, -1, 1], ri.ProcDynamicLoad)
            ri.WorldEnd()
            ri.End()

        asked = prman.Ri(keep_pictures=True)
        draw(asked)
        self.assertTrue(any("--allow-exec" in m.message for m in asked.messages))
        self.assertEqual(asked.pictures[0].data.max(), 0)
        allowed = prman.Ri(keep_pictures=True, flags=["--allow-exec"])
        draw(allowed)
        self.assertEqual([str(m) for m in allowed.messages], [])
        self.assertGreater(allowed.pictures[0].data.max(), 0)

    def test_control_c_while_a_world_is_drawn(self):
        timer = threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT))
        ri = prman.Ri(flags=["--spp", "10000000"])
        ri.ErrorHandler(ri.ERRORIGNORE)
        ri.Begin("__render")
        ri.Display("x", "null", "rgb")
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            draw_balls(ri)
        ri.End()
        self.assertEqual(ri.stats["width"], 48)


if __name__ == "__main__":
    unittest.main()

"""The render engine: writes the scene, runs the program, shows what it makes."""
import os
import re
import shlex
import shutil
import tempfile
import time

import bpy
import numpy as np

from . import exr, growing, passes, program, properties, scene
from .report import Report


MESSAGE = re.compile(r"\b(error|warning): ")


class Stopped(Exception):
    pass


def folder_of(settings, frame):
    """(folder, whether it is removed afterwards)."""
    if not settings.folder:
        return tempfile.mkdtemp(prefix="alpenglow-"), True
    path = os.path.join(bpy.path.abspath(settings.folder), "frame%04d" % frame)
    os.makedirs(path, exist_ok=True)
    return path, False


def size_of(render):
    scale = render.resolution_percentage / 100
    return max(1, int(render.resolution_x * scale)), max(1, int(render.resolution_y * scale))


def border_of(render):
    """Left, right, bottom, top of what is rendered, parts of the picture."""
    if not render.use_border:
        return 0.0, 1.0, 0.0, 1.0
    return render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y


def export(
    depsgraph, folder, settings, binary_of_program, listed, frame_set=None, size=None, samples=None, progress=None, view=None
):
    """Writes scene.rib and its shaders into a folder; the report of what was left out. listed: passes. size: of the picture.
    view: as view_camera()
    gives it, in place of the scene's camera."""
    lights = "samplelights" if program.knows(binary_of_program, "trace", "samplelights") else "samplearealights"
    writer = scene.Scene(depsgraph, folder, settings, lights, frame_set, progress, view)
    if lights != "samplelights":
        writer.report.lost("Highlights of lights without a size: this version of the program does not find them in trace()")
    writer.read()
    evaluated = depsgraph.scene_eval
    render = evaluated.render
    width, height = size or size_of(render)

    def head(rib, hider):
        rib.request("Display", "picture.exr", "openexr", "rgba")
        channels, mode = passes.declarations(listed)
        for name, values in channels:
            rib.request("DisplayChannel", name, values)
        if mode:
            rib.request("Display", "+passes.exr", "openexr", ",".join(mode))
        aspect = render.pixel_aspect_x / render.pixel_aspect_y
        rib.request("Format", width, height, aspect)
        # RISpec's gaussian spreads by a quarter of its width, Blender's Blackman-Harris by a seventh
        wide = render.filter_size if settings.filter == "box" else render.filter_size * 0.64
        rib.request("PixelFilter", settings.filter, wide, wide)
        side = max(1, round((samples or settings.samples) ** 0.5))
        rib.request("PixelSamples", side, side)
        if settings.hider == "path":
            hider = dict(hider, **{"int guide": int(settings.guide), "int caustics": int(settings.caustics)})
        rib.request("Hider", settings.hider, hider)
        rib.request("Option", "trace", {"int maxdepth": settings.max_depth})
        for line in filter(None, [settings.requests.strip()]):
            rib.file.write((line + "\n").encode())

    return writer.write(os.path.join(folder, "scene.rib"), head)


def arguments(binary, settings, frame, samples=None, crop=None, port=None):
    """The command line of a render. port: where the growing picture goes."""
    out = [binary, "render", "--progress", "plain", "--allow-read"]
    if settings.use_noise and settings.hider == "path" and samples is None:
        out += ["--noise", "%g" % settings.noise]
    elif settings.time > 0 and settings.hider == "path" and samples is None:
        out += ["--time", "%g" % settings.time]
    else:
        out += ["--spp", str(samples or settings.samples)]
    if settings.threads:
        out += ["--threads", str(settings.threads)]
    out += ["--seed", str(settings.seed + frame if settings.seed_by_frame else settings.seed)]
    if settings.clamp > 0:
        out += ["--sample-clamp", "%g" % settings.clamp]
    if crop:
        left, right, bottom, top = crop
        out += ["--crop", "%.9g,%.9g,%.9g,%.9g" % (left, right, 1 - top, 1 - bottom)]
    if port:
        out += ["--display", "tev:127.0.0.1:%d" % port]
    return out + shlex.split(settings.options) + ["scene.rib"]


def arguments_of(binary, settings, frame, samples, border):
    """arguments() but for the port."""
    return lambda port: arguments(binary, settings, frame, samples, border, port)


def box_of(render):
    """What is rendered of the picture: x, y from above, width, height; rounded as Blender rounds a border."""
    width, height = size_of(render)
    left, right, bottom, top = border_of(render)
    x0, x1, y0, y1 = (int(a * b) for a, b in ((left, width), (right, width), (bottom, height), (top, height)))
    return x0, height - y1, x1 - x0, y1 - y0


def covered(rgba, transparent):
    """The sky covers what nothing else does, unless the film is transparent."""
    if not transparent:
        rgba[:, 3] = 1
    return rgba


def flat(picture, names, window, box):
    """Channels of a picture as Blender wants them: (pixels, channels), rows from below. box: x, y from above, width, height."""
    x, y, width, height = box
    out = np.zeros((height, width, len(names)), np.float32)
    for i, name in enumerate(names):
        if name is None:
            continue
        a = picture[name]
        x0, y0 = window[0] - x, window[1] - y
        rows, columns = min(height - y0, a.shape[0]), min(width - x0, a.shape[1])
        out[max(y0, 0) : y0 + rows, max(x0, 0) : x0 + columns, i] = a[max(-y0, 0) : rows, max(-x0, 0) : columns]
    return out[::-1].reshape(-1, len(names))


def channels_of(picture, output, number, count):
    """Names of the channels that hold an output."""
    base = ("pass%d" % number if output.startswith("lpe:") else output).lower()
    named = {n.lower(): n for n in picture}
    if count == 1:
        return [named.get(base) or next((n for low, n in named.items() if low.split(".")[0] == base), None)]
    return [named.get("%s.%s" % (base, a)) or named.get("%s.%s" % (base, b)) for a, b in zip("rgb", "xyz")]


class AlpenglowEngine(bpy.types.RenderEngine):
    bl_idname = "ALPENGLOW"
    bl_label = "Alpenglow"
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_spherical_stereo = False
    bl_use_eevee_viewport = True

    view = None

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for one in passes.listed(scene, renderlayer):
            self.register_pass(scene, renderlayer, one.name, one.channels, one.letters, one.kind)

    def render(self, depsgraph):
        settings = depsgraph.scene.alpenglow
        try:
            binary = program.find(properties.program())
        except program.Missing as error:
            self.report({"ERROR"}, str(error))
            return
        frame = depsgraph.scene.frame_current
        folder, removed = folder_of(settings, frame)
        try:
            self._render(depsgraph, settings, binary, folder, frame)
        except Stopped:
            pass
        finally:
            if removed:
                shutil.rmtree(folder, ignore_errors=True)

    def _render(self, depsgraph, settings, binary, folder, frame):
        layer, render = depsgraph.view_layer_eval, depsgraph.scene_eval.render
        samples = min(16, settings.samples) if self.is_preview else None

        def progress(part, text):
            self.update_stats("Alpenglow", "writing " + text)
            self.update_progress(0.1 * part)
            if self.test_break():
                raise Stopped

        complaints = Report()
        listed = passes.listed(depsgraph.scene, depsgraph.scene.view_layers[layer.name], complaints)
        if depsgraph.scene_eval.camera is None:
            self.report({"ERROR"}, "The scene has no camera")
            return
        report = export(depsgraph, folder, settings, binary, listed, self.frame_set, size_of(render), samples, progress)
        for line in complaints.texts():
            report.lost(line)
        for name in ("picture.exr", "passes.exr"):  # of an earlier render into a folder that is kept
            if os.path.exists(os.path.join(folder, name)):
                os.remove(os.path.join(folder, name))
        self._tell(report, folder)
        box, border = box_of(render), border_of(render) if render.use_border else None
        result = self.begin_result(0, 0, box[2], box[3], layer=layer.name)  # Blender's picture is the border alone
        if result is None:
            self.report({"ERROR"}, "Blender takes no picture of %d x %d pixels" % box[2:])
            return
        self._follow(folder, arguments_of(binary, settings, frame, samples, border), result, box, render.film_transparent)
        path = os.path.join(folder, "picture.exr")
        if os.path.isfile(path):
            self._show(depsgraph, result, box, folder, path, listed)
        self.end_result(result)

    def _follow(self, folder, command, result, box, transparent):
        """Runs the program until it ends or the user stops it, and shows the picture as it grows."""
        grows = None if bpy.app.background else growing.Growing("picture.exr")
        run = program.Run(command(grows.port if grows else None), folder)
        stopped, shown = False, time.time()
        try:
            while not run.done():
                if self.test_break():
                    stopped = True
                    self.update_stats("Alpenglow", "stopping")
                    run.stop()
                    break
                self.update_progress(0.1 + 0.9 * run.part)
                self.update_stats("Alpenglow", run.status_line)
                if grows is not None and time.time() - shown > 0.5:
                    pixels = grows.take()
                    if pixels is not None:
                        whole = dict(zip("RGBA", np.moveaxis(pixels, 2, 0)))
                        result.layers[0].passes["Combined"].rect = covered(flat(whole, list("RGBA"), (0, 0), box), transparent)
                        self.update_result(result)
                        shown = time.time()
                time.sleep(0.1)
            self._messages(run, run.finish(), stopped)
        finally:
            run.stop()
            if grows is not None:
                grows.close()

    def _tell(self, report, folder):
        """What is not exported, each feature once, in Blender's reports, on the terminal and next to the RIB."""
        with open(os.path.join(folder, "report.txt"), "w", encoding="utf-8") as f:
            for line in report.texts():
                f.write(line + "\n")
                if not self.is_preview:
                    self.report({"WARNING"}, "Not exported: " + line)
                    print("Alpenglow: not exported: " + line, flush=True)

    def _messages(self, run, status, stopped):
        important = [m for m in run.messages if MESSAGE.search(m)]
        for line in important[:20]:
            print("Alpenglow: " + line, flush=True)
        if status not in (0, 1) and not stopped:
            said = next((m for m in run.messages if "error:" in m), run.messages[-1] if run.messages else "")
            self.report({"ERROR"}, "alpenglow ended with status %d: %s" % (status, said))
        elif important:
            self.report(
                {"WARNING"},
                "alpenglow: %s%s"
                % (important[0], " (and %d more, on the terminal)" % (len(important) - 1) if len(important) > 1 else ""),
            )

    def _show(self, depsgraph, result, box, folder, path, listed):
        picture, window, _ = exr.read(path)
        shown = result.layers[0].passes
        rgba = flat(picture, ["R", "G", "B", "A"], window, box)
        shown["Combined"].rect = covered(rgba, depsgraph.scene_eval.render.film_transparent)
        extra = os.path.join(folder, "passes.exr")
        if listed and os.path.isfile(extra):
            others, window, _ = exr.read(extra)
            eye = depsgraph.scene_eval.camera.matrix_world.normalized().to_3x3()
            for number, one in enumerate(listed):
                pixels = flat(others, channels_of(others, one.output, number, one.channels), window, box)
                if one.turn == "world":  # camera space of RIB looks along +z
                    pixels = (pixels * np.array([1, 1, -1], np.float32)) @ np.array(eye, np.float32).T
                elif one.turn is not None:
                    pixels = one.turn(pixels)
                if one.name in shown:
                    shown[one.name].rect = pixels.astype(np.float32)

    # The viewport: a still of few samples, made anew when something has changed.
    def view_update(self, context, depsgraph):
        from .viewport import View

        if self.view is None:
            self.view = View(self)
        self.view.update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        if self.view is not None:
            self.view.draw(context, depsgraph)

    def __del__(self):
        try:
            view = self.view
        except ReferenceError:  # Blender has taken it away already
            return
        if view is not None:
            view.close()


def register():
    bpy.utils.register_class(AlpenglowEngine)


def unregister():
    bpy.utils.unregister_class(AlpenglowEngine)

"""Rendered viewports: a still of few samples that is made anew when the scene or the view has changed and rests."""
import os
import shutil
import tempfile
import time

import bpy
import numpy as np

from . import exr, program, properties

REST = .3  # seconds without a change before a new still begins


def view_camera(context):
    """(matrix of the eye, ScreenWindow, perspective, clipping) of a viewport."""
    v3d = context.region_data
    turned = v3d.view_matrix.inverted()
    window = v3d.window_matrix
    perspective = v3d.is_perspective
    if perspective:
        x, y, sx, sy = 1 / window[0][0], 1 / window[1][1], window[0][2], window[1][2]
        screen = [(sx - 1) * x, (sx + 1) * x, (sy - 1) * y, (sy + 1) * y]
    else:
        x, y, sx, sy = 1 / window[0][0], 1 / window[1][1], window[0][3], window[1][3]
        screen = [(-1 - sx) * x, (1 - sx) * x, (-1 - sy) * y, (1 - sy) * y]
    return turned, screen, perspective, (context.space_data.clip_start, context.space_data.clip_end)


class View:
    """One viewport. The export is done in view_update() and view_draw(), where Blender lets scripts read; the program runs beside."""

    def __init__(self, engine):
        self.engine, self.run, self.folder, self.pixels, self.size = engine, None, None, None, None
        self.texture, self.changed, self.seen, self.message = None, time.time(), None, ""

    def update(self, context, depsgraph):
        self.changed, self.seen = time.time(), None
        self.engine.tag_redraw()

    def _stop(self):
        if self.run is not None:
            self.run.stop()
            self.run = None
        if self.folder is not None:
            shutil.rmtree(self.folder, ignore_errors=True)
            self.folder = None

    close = _stop

    def _start(self, context, depsgraph, size):
        from .engine import arguments, export
        self._stop()
        settings = depsgraph.scene.alpenglow
        try:
            binary = program.find(properties.program(context))
        except program.Missing as error:
            self.message = str(error)
            return
        self.folder = tempfile.mkdtemp(prefix="alpenglow-view-")
        view = view_camera(context)
        export(depsgraph, self.folder, settings, binary, [], None, size, settings.preview_samples, None, view)
        self.run = program.Run(arguments(binary, settings, depsgraph.scene.frame_current, settings.preview_samples), self.folder)

    def draw(self, context, depsgraph):
        region = context.region
        scale = max(1, int(getattr(context.preferences.system, "pixel_size", 1)))
        size = (max(1, region.width // (2 * scale)), max(1, region.height // (2 * scale)))
        key = (size, tuple(map(tuple, context.region_data.perspective_matrix)))
        if key != self.seen:
            if self.seen is None or time.time() - self.changed > REST:
                self.seen, self.changed = key, time.time()
                self._start(context, depsgraph, size)
            else:
                self.changed = time.time()
        if self.run is not None and self.run.done():
            self.run.finish()
            self._read()
            self.run = None
        self._paint(context, region)
        if self.run is not None:
            self.engine.update_stats("Alpenglow", self.run.status_line or "rendering")
            self.engine.tag_redraw()
        else:
            self.engine.update_stats("Alpenglow", self.message)

    def _read(self):
        path = os.path.join(self.folder, "picture.exr")
        if not os.path.isfile(path):
            self.message = next((m for m in self.run.messages if "error:" in m), "no picture")
            return
        found, _, size = exr.read(path)
        rgba = np.stack([found[k] for k in "RGBA"], -1)[::-1]
        rgba[..., 3] = 1
        self.pixels, self.size, self.texture, self.message = np.ascontiguousarray(rgba, np.float32), size, None, ""

    def _paint(self, context, region):
        if self.pixels is None:
            return
        import gpu
        from gpu_extras.presets import draw_texture_2d
        if self.texture is None:
            data = gpu.types.Buffer("FLOAT", self.pixels.size, self.pixels.ravel())
            self.texture = gpu.types.GPUTexture(self.size, format="RGBA16F", data=data)
        self.engine.bind_display_space_shader(bpy.context.scene if context is None else context.scene)
        draw_texture_2d(self.texture, (0, 0), region.width, region.height)
        self.engine.unbind_display_space_shader()

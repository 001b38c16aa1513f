"""blender -b --factory-startup --python blender_render.py -- SCENE OUT [SAMPLES]: a scene of blender_scenes.py by Alpenglow's add-on and by Cycles,
as OUT/SCENE.ours.exr and OUT/SCENE.cycles.exr, and how they compare, as a line of JSON after "COMPARED". ALPENGLOW_PROGRAM names the program,
ALPENGLOW_ADDON the folder that holds the add-on."""
import json
import os
import sys
import time

import bpy

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.environ.get("ALPENGLOW_ADDON", os.path.join(HERE, "..", "..", "editors", "blender"))]
import alpenglow  # noqa: E402
import blender_scenes  # noqa: E402
import pictures  # noqa: E402


def settings(s, samples, out, name):
    """The same picture of both: box filter of a pixel, no denoiser, no clamping, the same bounces."""
    r = s.render
    r.resolution_x, r.resolution_y, r.resolution_percentage, r.filter_size = 256, 144, 100, 1.0
    r.image_settings.file_format, r.image_settings.color_depth = "OPEN_EXR", "32"
    c = s.cycles
    c.samples, c.use_adaptive_sampling, c.use_denoising, c.device = samples, False, False, "CPU"
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = c.transparent_max_bounces = c.volume_bounces = 32
    c.blur_glossy = c.sample_clamp_indirect = c.sample_clamp_direct = c.light_sampling_threshold = 0.0
    c.pixel_filter_type = "BOX"
    own = s.alpenglow
    own.samples, own.filter, own.folder, own.max_depth = samples, "box", os.path.join(out, name), 32


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    name, out, samples = arguments[0], arguments[1], int(arguments[2]) if len(arguments) > 2 else 64
    alpenglow.register()
    s = bpy.context.scene
    blender_scenes.SCENES[name]()
    settings(s, samples, out, name)
    for engine, label in (("ALPENGLOW", "ours"), ("CYCLES", "cycles")):
        if os.environ.get("ONLY", label) != label:
            continue
        s.render.engine, s.render.filepath = engine, os.path.join(out, "%s.%s.exr" % (name, label))
        started = time.time()
        bpy.ops.render.render(write_still=True)
        print("RENDERED %s %s %.1f s" % (name, label, time.time() - started), flush=True)
    both = [pictures.read(os.path.join(out, "%s.%s.exr" % (name, label))) for label in ("ours", "cycles")]
    pictures.png(os.path.join(out, name + ".png"), both)
    print("COMPARED " + json.dumps(pictures.compared(*both)), flush=True)


main()

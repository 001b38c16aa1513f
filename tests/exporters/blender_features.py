"""blender -b --factory-startup --python blender_features.py -- OUT: what the add-on does besides pictures, each held to Cycles, to Blender's own
numbers or to a closed form: passes, a border, a transparent film, an RSL shader as a material, the report, instances that share a shape."""
import os
import re
import sys

import bpy
import numpy as np

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.environ.get("ALPENGLOW_ADDON", os.path.join(HERE, "..", "..", "editors", "blender"))]
import alpenglow  # noqa: E402
import blender_scenes as scenes  # noqa: E402
import pictures  # noqa: E402

OUT = sys.argv[sys.argv.index("--") + 1]
S = bpy.context.scene


def check(what, truth, detail=""):
    print("%s %s %s" % ("ok" if truth else "WRONG", what, detail), flush=True)
    if not truth:
        sys.exit(1)


def render(engine, name, samples=16, multilayer=False):
    """A picture's channels."""
    S.render.engine, S.render.filepath = engine, os.path.join(OUT, name + ".exr")
    S.render.image_settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
    S.render.image_settings.color_depth, S.render.image_settings.exr_codec = "32", "ZIP"
    S.cycles.samples = S.alpenglow.samples = samples
    bpy.ops.render.render(write_still=True)
    return pictures.channels(S.render.filepath)


def rib():
    with open(os.path.join(OUT, "features", "frame%04d" % S.frame_current, "scene.rib"), "rb") as f:
        return f.read().decode("latin-1")


def layer(found, name, letter):
    return next(v for k, v in found.items() if k.endswith("%s.%s" % (name, letter)))


def passes():
    view = S.view_layers[0]
    view.use_pass_z = view.use_pass_normal = True
    view.alpenglow.use_direct = view.alpenglow.use_indirect = view.alpenglow.use_albedo = view.alpenglow.lights = True
    ours, cycles = render("ALPENGLOW", "passes.ours", 64, True), render("CYCLES", "passes.cycles", 64, True)
    z = layer(ours, "Depth", "Z"), layer(cycles, "Depth", "Z")
    inside = (z[0] < 50) & (z[1] < 50)
    check("the cube is where Cycles sees it", abs(inside.mean() - (z[1] < 50).mean()) < .005)
    d = np.abs(z[0] - z[1])[inside]  # ours is the nearest of a pixel's samples, Cycles' that of one
    check("depths agree within what a pixel spans", np.median(d) < .05, np.median(d))
    for letter in "XYZ":
        n = layer(ours, "Normal", letter), layer(cycles, "Normal", letter)
        check("normals agree in " + letter, np.abs(n[0] - n[1])[inside].mean() < .02, np.abs(n[0] - n[1])[inside].mean())
    parts = sum(layer(ours, p, "R") for p in ("Direct", "Indirect"))
    check("direct and indirect light add up to the picture", np.abs(parts - layer(ours, "Combined", "R")).max() < 1e-4)
    own, sky = layer(ours, "Light Light", "R"), layer(ours, "Combined", "R")
    check("the light's own pass is part of it", own[inside].mean() > .1 and (own <= sky + 1e-4).all() and own[z[0] > 50].max() == 0,
          (own[inside].mean(), (own - sky).max(), own[z[0] > 50].max()))
    check("albedo is between Principled's base and what it reflects besides", .75 < layer(ours, "Albedo", "R")[inside].mean() < .95,
          layer(ours, "Albedo", "R")[inside].mean())
    view.use_pass_z = view.use_pass_normal = view.alpenglow.use_direct = view.alpenglow.use_indirect = False
    view.alpenglow.use_albedo = view.alpenglow.lights = False


def border():
    whole = pictures.three(render("ALPENGLOW", "whole"))
    r = S.render
    r.use_border, r.border_min_x, r.border_max_x, r.border_min_y, r.border_max_y = True, .25, .75, .5, 1.0
    part = pictures.three(render("ALPENGLOW", "border"))
    check("a border is that part of the picture, to the bit", np.array_equal(part[:72, 64:192], whole[:72, 64:192]) and part[72:].max() == 0)
    r.use_crop_to_border = True
    part = pictures.three(render("ALPENGLOW", "cropped"))
    check("cropped to it, too", np.array_equal(part, whole[:72, 64:192]), part.shape)
    r.use_border = r.use_crop_to_border = False
    r.film_transparent = True
    found = render("ALPENGLOW", "transparent")
    a, b = (found[k] for k in ("A", "B"))
    check("a transparent film has no sky", a.min() == 0 and a.max() == 1 and b[a == 0].max() == 0)
    r.film_transparent = False


def shader():
    cube = bpy.data.objects["Cube"]
    path = os.path.join(OUT, "stripes.sl")
    with open(path, "w", encoding="utf-8") as f:
        f.write("surface stripes(color first = 1; float number = 3; string unused = \"\"; varying color tint = 1;)\n"
                "{\n    Oi = 1;\n    Ci = first * tint * number / 10;\n}\n")
    material = cube.data.materials[0]
    own = material.alpenglow
    own.use_shader, own.shader = True, path
    with bpy.context.temp_override(material=material):
        bpy.ops.alpenglow.read_parameters()
    names = [(p.name, p.kind) for p in own.parameters]
    check("parameters are read", names == [("first", "color"), ("number", "float"), ("unused", "string"), ("tint", "color")], names)
    number, first, tint = own.parameters["number"], own.parameters["first"], own.parameters["tint"]
    check("with their defaults", number.number == 3 and tuple(first.color) == (1, 1, 1))
    number.use, number.number, first.use, first.color = True, 5.0, True, (.2, .4, .6)
    found = pictures.three(render("ALPENGLOW", "shader"))
    check("values that are set arrive: a half of .2 .4 .6", np.allclose(found[90, 128], (.1, .2, .3), atol=1e-5), found[90, 128])
    data = cube.data.attributes.new("paint", "FLOAT_COLOR", "POINT")
    data.data.foreach_set("color", [.5, .5, .5, 1] * 8)
    tint.attribute = "paint"
    found = pictures.three(render("ALPENGLOW", "painted"))
    check("a parameter from an attribute of the mesh", np.allclose(found[90, 128], (.05, .1, .15), atol=1e-5), found[90, 128])
    own.use_shader = False


def report():
    world = S.world
    sky = world.node_tree.nodes.new("ShaderNodeTexSky")
    world.node_tree.links.new(sky.outputs[0], world.node_tree.nodes["Background"].inputs[0])
    S.view_layers[0].use_pass_mist = True
    render("ALPENGLOW", "report", 1)
    with open(os.path.join(OUT, "features", "frame%04d" % S.frame_current, "report.txt"), encoding="utf-8") as f:
        lines = f.read().splitlines()
    for word in ("Sky Texture", "Pass Mist"):
        check("%s is reported once" % word, sum(word in line for line in lines) == 1, lines)
    world.node_tree.nodes.remove(sky)
    S.view_layers[0].use_pass_mist = False


def instances():
    scenes.SCENES["crowd"]()
    S.render.resolution_percentage = 25
    render("ALPENGLOW", "instances", 1)
    text = rib()
    made, shown = len(re.findall(r"\nObjectBegin", text)), len(re.findall(r"\nObjectInstance", text))
    check("12 trees of two shapes and 35 balls are instances of three", (made, shown) == (3, 24 + 35), (made, shown))
    check("the monkey is a smooth surface", text.count("SubdivisionMesh") == 1)
    check("hair is curves", text.count("\nCurves ") == 1)


def main():
    alpenglow.register()
    r = S.render
    r.resolution_x, r.resolution_y, r.resolution_percentage, r.filter_size = 256, 144, 100, 1.0
    S.cycles.use_denoising = S.cycles.use_adaptive_sampling = False
    S.cycles.pixel_filter_type = "BOX"
    S.alpenglow.filter, S.alpenglow.folder = "box", os.path.join(OUT, "features")
    for part in (passes, border, shader, report, instances):
        part()


main()

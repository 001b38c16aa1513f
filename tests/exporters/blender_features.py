"""blender -b --factory-startup --python blender_features.py -- OUT: what the add-on does besides pictures, each held to
Cycles, to Blender's own
numbers or to a closed form: passes, a border, a transparent film, an RSL shader as a material, the report, instances that
share a shape."""
import os
import re
import shutil
import subprocess
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
    check("the cube is where Cycles sees it", abs(inside.mean() - (z[1] < 50).mean()) < 0.005)
    d = np.abs(z[0] - z[1])[inside]  # ours is the nearest of a pixel's samples, Cycles' that of one
    check("depths agree within what a pixel spans", np.median(d) < 0.05, np.median(d))
    for letter in "XYZ":
        n = layer(ours, "Normal", letter), layer(cycles, "Normal", letter)
        check("normals agree in " + letter, np.abs(n[0] - n[1])[inside].mean() < 0.02, np.abs(n[0] - n[1])[inside].mean())
    parts = sum(layer(ours, p, "R") for p in ("Direct", "Indirect"))
    check("direct and indirect light add up to the picture", np.abs(parts - layer(ours, "Combined", "R")).max() < 1e-4)
    own, sky = layer(ours, "Light Light", "R"), layer(ours, "Combined", "R")
    check(
        "the light's own pass is part of it",
        own[inside].mean() > 0.1 and (own <= sky + 1e-4).all() and own[z[0] > 50].max() == 0,
        (own[inside].mean(), (own - sky).max(), own[z[0] > 50].max()),
    )
    check(
        "albedo is between Principled's base and what it reflects besides",
        0.75 < layer(ours, "Albedo", "R")[inside].mean() < 0.95,
        layer(ours, "Albedo", "R")[inside].mean(),
    )
    view.use_pass_z = view.use_pass_normal = view.alpenglow.use_direct = view.alpenglow.use_indirect = False
    view.alpenglow.use_albedo = view.alpenglow.lights = False


def border():
    whole = pictures.three(render("ALPENGLOW", "whole"))
    r = S.render
    r.use_border, r.border_min_x, r.border_max_x, r.border_min_y, r.border_max_y = True, 0.25, 0.75, 0.5, 1.0
    part = pictures.three(render("ALPENGLOW", "border"))
    check(
        "a border is that part of the picture, to the bit",
        np.array_equal(part[:72, 64:192], whole[:72, 64:192]) and part[72:].max() == 0,
    )
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
        f.write(
            'surface stripes(color first = 1; float number = 3; string unused = ""; varying color tint = 1;)\n'
            "{\n    Oi = 1;\n    Ci = first * tint * number / 10;\n}\n"
        )
    material = cube.data.materials[0]
    own = material.alpenglow
    own.use_shader, own.shader = True, path
    with bpy.context.temp_override(material=material):
        bpy.ops.alpenglow.read_parameters()
    names = [(p.name, p.kind) for p in own.parameters]
    check(
        "parameters are read",
        names == [("first", "color"), ("number", "float"), ("unused", "string"), ("tint", "color")],
        names,
    )
    number, first, tint = own.parameters["number"], own.parameters["first"], own.parameters["tint"]
    check("with their defaults", number.number == 3 and tuple(first.color) == (1, 1, 1))
    number.use, number.number, first.use, first.color = True, 5.0, True, (0.2, 0.4, 0.6)
    found = pictures.three(render("ALPENGLOW", "shader"))
    check(
        "values that are set arrive: a half of .2 .4 .6",
        np.allclose(found[90, 128], (0.1, 0.2, 0.3), atol=1e-5),
        found[90, 128],
    )
    data = cube.data.attributes.new("paint", "FLOAT_COLOR", "POINT")
    data.data.foreach_set("color", [0.5, 0.5, 0.5, 1] * 8)
    tint.attribute = "paint"
    found = pictures.three(render("ALPENGLOW", "painted"))
    check(
        "a parameter from an attribute of the mesh", np.allclose(found[90, 128], (0.05, 0.1, 0.15), atol=1e-5), found[90, 128]
    )
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
    boxes = 24 if bpy.app.version < (4, 0, 0) else 0
    check(
        "12 trees of two shapes, 35 balls and the boxes are instances",
        (made, shown) == (3 + (boxes > 0), 24 + 35 + boxes),
        (made, shown),
    )
    check("the monkey is a smooth surface", text.count("SubdivisionMesh") == 1)
    check("text is drawn once", text.count('"string name" "text"') == 1)
    check("hair is curves", text.count("\nCurves ") == 1)


def variants(n):
    """Settings of a node that its translation looks at: each value of its enumerations in turn."""
    yield None
    for prop in n.bl_rna.properties:
        if prop.type == "ENUM" and not prop.is_readonly and prop.identifier not in n.bl_rna.base.bl_rna.properties:
            for item in prop.enum_items:
                yield prop.identifier, item.identifier


def nodes():
    """Every shader node of this Blender, with each of its settings and outputs: the shader compiles, whatever is linked to it."""
    from alpenglow.compiler import Compiler, NODES
    from alpenglow.materials import HEAD, Images
    from alpenglow.report import Report

    folder = os.path.join(OUT, "nodes")
    os.makedirs(folder, exist_ok=True)
    shutil.copytree(os.path.join(os.path.dirname(alpenglow.__file__), "shaders"), folder, dirs_exist_ok=True)
    text, count, report = HEAD % "samplearealights", 0, Report()
    for kind in sorted(NODES):
        m = scenes.Nodes("all")
        n = m.tree.nodes.new(kind) if hasattr(bpy.types, kind) else None
        if n is None:  # of another version of Blender
            continue
        for setting in variants(n):
            if setting:
                try:
                    setattr(n, *setting)
                except TypeError:
                    continue
            for out in n.outputs:
                if not out.enabled:
                    continue
                m.tree.links.clear()
                for s in n.inputs:  # something that varies, so that nothing is folded
                    if s.enabled and s.type in ("VALUE", "RGBA", "VECTOR"):
                        m.tree.links.new(m.add("TexCoord").outputs["Object"], s)
                m.tree.links.new(out, m.end.inputs["Surface"])
                if not m.end.inputs["Surface"].links:
                    continue
                text += Compiler("n%d" % count, kind, "surface", report, Images(folder, report)).surface(m.tree)
                count += 1
        bpy.data.materials.remove(m.material)
    path = os.path.join(folder, "all.sl")
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    done = subprocess.run([os.environ["ALPENGLOW_PROGRAM"], "compile", path], capture_output=True, text=True, check=False)
    check(
        "%d shaders of %d kinds of nodes compile" % (count, len(NODES)),
        done.returncode == 0 and count > 200,
        done.stderr[:3000],
    )


def main():
    alpenglow.register()
    r = S.render
    r.resolution_x, r.resolution_y, r.resolution_percentage, r.filter_size = 256, 144, 100, 1.0
    S.cycles.use_denoising = S.cycles.use_adaptive_sampling = False
    S.cycles.pixel_filter_type = "BOX"
    S.alpenglow.filter, S.alpenglow.folder = "box", os.path.join(OUT, "features")
    for part in (nodes, passes, border, shader, report, instances):
        part()


main()

"""Scenes for Blender, by script: default, materials, lights, crowd (instances and hair), camera (lens and motion). Each
function fills an
empty scene; the picture is small. They use what exporters lose easily, and nothing that is noise of its own (Blender's noise
textures have
other values here, so they appear with little contrast)."""
import math
import os
import tempfile

import bpy
from mathutils import Matrix, Vector


def clear():
    for o in list(bpy.data.objects):
        bpy.data.objects.remove(o)


def shown(name, data, place=(0, 0, 0), turn=(0, 0, 0)):
    o = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(o)
    o.location, o.rotation_euler = place, turn
    return o


def aimed(o, at):
    """Turns a camera or a light, which look along -z, at a place."""
    o.rotation_euler = (Vector(at) - o.location).to_track_quat("-Z", "Y").to_euler()
    return o


def camera(place, at, lens=50.0):
    data = bpy.data.cameras.new("camera")
    data.lens = lens
    o = aimed(shown("camera", data, place), at)
    bpy.context.scene.camera = o
    return o


def sky(colour, strength=1.0):
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    back = world.node_tree.nodes["Background"]
    back.inputs[0].default_value, back.inputs[1].default_value = (*colour, 1), strength
    bpy.context.scene.world = world
    return world


def lamp(name, kind, energy, place, at=(0, 0, 0), **values):
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    for k, v in values.items():
        setattr(data, k, v)
    return aimed(shown(name, data, place), at)


def sphere(name, place, radius, material, segments=48):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2, radius=radius, location=place)
    o = bpy.context.object
    o.name = name
    for p in o.data.polygons:
        p.use_smooth = True
    if material is not None:
        o.data.materials.append(material)
    return o


def plane(name, size, material, place=(0, 0, 0), turn=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=place, rotation=turn)
    o = bpy.context.object
    o.name = name
    o.data.materials.append(material)
    return o


class Nodes:
    """A material's tree; add() makes a node, with values of inputs and properties, and links."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.end = self.tree.nodes.new("ShaderNodeOutputMaterial")

    def add(self, kind, links=(), **values):
        n = self.tree.nodes.new("ShaderNode" + kind)
        for k, v in values.items():
            k = k.replace("_", " ")
            if k.startswith("set "):
                setattr(n, k[4:].replace(" ", "_"), v)
            else:
                s = n.inputs[k]
                s.default_value = (*v, 1) if s.type == "RGBA" else v
        for name, socket in dict(links).items():
            self.tree.links.new(socket, n.inputs[name])
        return n

    def close(self, n, displacement=None):
        self.tree.links.new(n.outputs[0], self.end.inputs["Surface"])
        if displacement is not None:
            self.tree.links.new(displacement.outputs[0], self.end.inputs["Displacement"])
        return self.material


def principled(name, **values):
    m = Nodes(name)
    return m.close(m.add("BsdfPrincipled", **values))


def name_of(*names):
    """The name of an input of Principled BSDF in this version of Blender: of two, the old one and the new one."""
    return names[0] if bpy.app.version < (4, 0, 0) else names[1]


def picture():
    """A PNG of four colours with a soft bump of slopes, as files: (colour, normals)."""
    import numpy as np

    folder = tempfile.mkdtemp(prefix="alpenglow-maps-")
    n = 64
    y, x = np.mgrid[0:n, 0:n] / n
    colour = np.stack([x > 0.5, y > 0.5, (x > 0.5) ^ (y > 0.5), np.ones_like(x)], -1).astype(np.float32) * 0.7 + 0.15
    slope = np.stack(
        [0.5 + 0.3 * np.sin(8 * np.pi * x), 0.5 + 0.3 * np.sin(8 * np.pi * y), np.ones_like(x), np.ones_like(x)], -1
    )
    out = []
    for name, pixels in (("colour", colour), ("normals", slope)):
        image = bpy.data.images.new(name, n, n)
        image.pixels.foreach_set(pixels.astype(np.float32).ravel())
        image.filepath_raw = os.path.join(folder, name + ".png")
        image.file_format = "PNG"
        image.save()
        loaded = bpy.data.images.load(image.filepath_raw)
        if name == "normals":
            loaded.colorspace_settings.name = "Non-Color"
        out.append(loaded)
    return out


def default():
    """What Blender starts with: a cube, a point light, a camera."""


def materials():
    clear()
    sky((0.3, 0.4, 0.55), 0.6)
    camera((0, -9, 5), (0, 0, 0.4), 42)
    lamp("key", "AREA", 350, (-3, -3, 5), (0, 0, 0), shape="RECTANGLE", size=2, size_y=1)
    m = Nodes("floor")
    checks = m.add(
        "TexChecker", {"Vector": m.add("TexCoord").outputs["UV"]}, Scale=12.0, Color1=(0.7, 0.65, 0.6), Color2=(0.25, 0.3, 0.35)
    )
    plane("floor", 14, m.close(m.add("BsdfDiffuse", {"Color": checks.outputs["Color"]})))
    colour, normals = picture()
    rows = [
        principled("plain", Base_Color=(0.7, 0.15, 0.1), Roughness=0.4),
        principled("metal", Base_Color=(0.9, 0.65, 0.3), Metallic=1.0, Roughness=0.25),
        principled("lacquer", Base_Color=(0.1, 0.3, 0.6), Roughness=0.6, **{name_of("Clearcoat", "Coat_Weight"): 1.0}),
    ]
    m = Nodes("glass")
    rows.append(m.close(m.add("BsdfGlass", Color=(0.95, 1, 0.97), Roughness=0.0, IOR=1.45)))
    m = Nodes("mapped")
    uv = m.add("Mapping", {"Vector": m.add("TexCoord").outputs["UV"]}, Scale=(4, 2, 1), Location=(0.1, 0.2, 0))
    image = m.add("TexImage", {"Vector": uv.outputs[0]}, set_image=colour)
    rows.append(m.close(m.add("BsdfPrincipled", {"Base Color": image.outputs["Color"]}, Roughness=0.5)))
    m = Nodes("dented")
    image = m.add("TexImage", {"Vector": m.add("TexCoord").outputs["UV"]}, set_image=normals)
    slopes = m.add("NormalMap", {"Color": image.outputs["Color"]}, Strength=0.7)
    rows.append(m.close(m.add("BsdfPrincipled", {"Normal": slopes.outputs[0]}, Base_Color=(0.6, 0.6, 0.6), Roughness=0.35)))
    m = Nodes("ramp")
    place = m.add("SeparateXYZ", {0: m.add("TexCoord").outputs["Generated"]})
    ramp = m.add("ValToRGB", {"Fac": place.outputs["Z"]})
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.9, 0.8, 0.1, 1), (0.1, 0.05, 0.5, 1)
    ramp.color_ramp.elements.new(0.5).color = (0.1, 0.6, 0.2, 1)
    rows.append(m.close(m.add("BsdfDiffuse", {"Color": ramp.outputs["Color"]})))
    m = Nodes("mixed")
    weight = m.add("LayerWeight", Blend=0.4)
    rows.append(
        m.close(
            m.add(
                "MixShader",
                {
                    0: weight.outputs["Facing"],
                    1: m.add("BsdfDiffuse", Color=(0.1, 0.5, 0.3)).outputs[0],
                    2: m.add("BsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.3).outputs[0],
                },
            )
        )
    )
    m = Nodes("waves")
    wave = m.add("TexWave", {"Vector": m.add("TexCoord").outputs["Object"]}, Scale=1.5)
    bump = m.add("Bump", {"Height": wave.outputs["Fac"]}, Strength=0.5, Distance=0.2)
    rows.append(m.close(m.add("BsdfPrincipled", {"Normal": bump.outputs[0]}, Base_Color=(0.7, 0.7, 0.3), Roughness=0.5)))
    m = Nodes("veil")
    rows.append(
        m.close(
            m.add(
                "MixShader",
                {1: m.add("BsdfTransparent").outputs[0], 2: m.add("BsdfDiffuse", Color=(0.8, 0.3, 0.5)).outputs[0]},
                Fac=0.5,
            )
        )
    )
    m = Nodes("glow")
    rows.append(m.close(m.add("Emission", Color=(1, 0.6, 0.3), Strength=2.0)))
    m = Nodes("rough glass")
    rows.append(m.close(m.add("BsdfGlass", Color=(1, 0.8, 0.7), Roughness=0.4, IOR=1.5)))
    for i, material in enumerate(rows):
        sphere(material.name, (-3.3 + 2.2 * (i % 4), 2.2 - 2.2 * (i // 4), 0.8), 0.8, material)


def lights():
    clear()
    sky((0.05, 0.06, 0.1))
    camera((0, -8.5, 4.5), (0, 0, 0.7), 38)
    plane("floor", 16, principled("grey", Base_Color=(0.6, 0.6, 0.6), Roughness=0.9))
    plane("wall", 16, principled("wall", Base_Color=(0.6, 0.55, 0.5), Roughness=0.9), (0, 4, 0), (math.pi / 2, 0, 0))
    white = principled("white", Base_Color=(0.75, 0.75, 0.75), Roughness=0.45)
    for i in range(5):
        sphere("ball%d" % i, (-4 + 2 * i, 0, 0.6), 0.6, white)
    lamp("point", "POINT", 60, (-4, -1.5, 2.5), shadow_soft_size=0.2, color=(1, 0.5, 0.4))
    lamp(
        "spot",
        "SPOT",
        300,
        (-1.5, -2, 4),
        (-1.5, 0.5, 0),
        shadow_soft_size=0.1,
        spot_size=math.radians(40),
        spot_blend=0.4,
        color=(0.5, 1, 0.5),
    )
    lamp("sun", "SUN", 0.6, (5, -6, 8), (0, 0, 0), angle=math.radians(4))
    lamp("square", "AREA", 60, (1.5, -1.5, 3), (1.5, 0, 0), shape="RECTANGLE", size=1.2, size_y=0.5, color=(0.4, 0.5, 1))
    lamp("round", "AREA", 50, (4, -1.5, 2.6), (4, 0, 0.5), shape="ELLIPSE", size=1.0, size_y=0.6, color=(1, 0.9, 0.4))
    m = Nodes("tube")
    shining = m.close(m.add("Emission", Color=(1, 0.3, 0.8), Strength=6.0))
    bpy.ops.mesh.primitive_cylinder_add(radius=0.08, depth=6, location=(0, 3.6, 3.2), rotation=(0, math.pi / 2, 0))
    bpy.context.object.data.materials.append(shining)


def crowd():
    clear()
    sky((0.5, 0.55, 0.6), 0.8)
    camera((0, -10, 5), (0, 0, 0.6), 45)
    lamp("sun", "SUN", 2.5, (4, -5, 7), angle=math.radians(3))
    plane("floor", 20, principled("earth", Base_Color=(0.35, 0.3, 0.22), Roughness=1.0))
    cone_material = principled("green", Base_Color=(0.12, 0.4, 0.12), Roughness=0.7)
    trunk = principled("brown", Base_Color=(0.3, 0.18, 0.1), Roughness=0.8)
    tree = bpy.data.collections.new("tree")  # in no scene: its instances alone are seen
    for name, maker, material in (
        (
            "crown",
            lambda: bpy.ops.mesh.primitive_cone_add(vertices=12, radius1=0.5, depth=1.2, location=(0, 0, 1)),
            cone_material,
        ),
        ("trunk", lambda: bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.1, depth=0.5, location=(0, 0, 0.2)), trunk),
    ):
        maker()
        o = bpy.context.object
        o.name = name
        o.data.materials.append(material)
        for c in list(o.users_collection):
            c.objects.unlink(o)
        tree.objects.link(o)
    for i in range(12):
        o = shown("tree%d" % i, None, (-4.4 + 0.8 * i, 2.5 + 0.8 * math.sin(3.7 * i), 0), (0, 0, i))
        o.instance_type, o.instance_collection = "COLLECTION", tree
        o.scale = (0.8 + 0.04 * i,) * 3
    ball = sphere("seed", (0, 0, -5), 0.14, principled("red", Base_Color=(0.7, 0.1, 0.1), Roughness=0.3), 16)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=6, y_subdivisions=4, size=1, location=(2.6, -1, 0.15))
    grid = bpy.context.object
    grid.scale = (1.6, 1.2, 1)
    grid.instance_type, grid.show_instancer_for_render = "VERTS", False
    ball.location = (0, 0, 0)
    ball.parent = grid
    text = bpy.data.curves.new("text", "FONT")
    text.body, text.size, text.extrude = "RIB", 0.5, 0.05
    text.materials.append(principled("letters", Base_Color=(0.1, 0.2, 0.6), Roughness=0.5))
    shown("text", text, (-0.6, -3, 0.02), (1.2, 0, 0))
    if bpy.app.version < (4, 0, 0):  # whose groups of nodes are made in another way
        boxes()
    head = sphere("head", (-2.4, -0.6, 0.9), 0.7, principled("skin", Base_Color=(0.5, 0.3, 0.2), Roughness=0.8), 32)
    head.data.materials.append(
        principled("hair", Base_Color=(0.45, 0.22, 0.08), Roughness=0.6, **{name_of("Specular", "Specular_IOR_Level"): 0.0})
    )
    head.modifiers.new("hair", "PARTICLE_SYSTEM")
    s = head.particle_systems[0].settings
    s.type, s.count, s.hair_length, s.material, s.use_advanced_hair = "HAIR", 1500, 0.5, 2, True
    s.root_radius, s.tip_radius, s.radius_scale, s.effector_weights.gravity = 1.0, 0.3, 0.03, 0.0
    s.render_step = 3
    bpy.context.scene.cycles_curves.shape = "THICK"
    bpy.ops.mesh.primitive_monkey_add(size=1.2, location=(0.2, -1.2, 0.7))
    o = bpy.context.object
    o.data.materials.append(principled("stone", Base_Color=(0.55, 0.55, 0.5), Roughness=0.5))
    o.modifiers.new("smooth", "SUBSURF").render_levels = 3
    for p in o.data.polygons:
        p.use_smooth = True


def boxes():
    """Cubes that geometry nodes put on the points of a grid."""
    group = bpy.data.node_groups.new("boxes", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    first, last, on, cube, paint = (
        group.nodes.new(k)
        for k in (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeInstanceOnPoints",
            "GeometryNodeMeshCube",
            "GeometryNodeSetMaterial",
        )
    )
    cube.inputs[0].default_value = (0.2, 0.2, 0.2)
    paint.inputs["Material"].default_value = principled("boxes", Base_Color=(0.8, 0.7, 0.2), Roughness=0.6)
    group.links.new(cube.outputs[0], paint.inputs[0])
    group.links.new(paint.outputs[0], on.inputs["Instance"])
    group.links.new(first.outputs[0], on.inputs[0])
    group.links.new(on.outputs[0], last.inputs[0])
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=5, y_subdivisions=3, size=1.6, location=(-3.6, -3, 0.1))
    bpy.context.object.modifiers.new("boxes", "NODES").node_group = group


def motion_of(o, path, first, last):
    """Keys at frames 0 and 2, in a straight line."""
    setattr(o, path, first)
    o.keyframe_insert(path, frame=0)
    setattr(o, path, last)
    o.keyframe_insert(path, frame=2)
    for curve in o.animation_data.action.fcurves:
        for k in curve.keyframe_points:
            k.interpolation = "LINEAR"


def lens():
    clear()
    scene = bpy.context.scene
    sky((0.4, 0.45, 0.5))
    eye = camera((0, -9, 2.4), (0, 0, 0.8), 70)
    eye.data.shift_x, eye.data.shift_y, eye.data.sensor_fit = 0.06, -0.04, "VERTICAL"
    eye.data.dof.use_dof, eye.data.dof.focus_distance, eye.data.dof.aperture_fstop = True, 8.5, 0.25
    lamp("sun", "SUN", 2.0, (-4, -5, 7), angle=math.radians(6))
    plane("floor", 30, principled("floor", Base_Color=(0.5, 0.5, 0.5), Roughness=0.9))
    for i in range(5):
        sphere(
            "post%d" % i,
            (-1.6 + 0.8 * i, -4.5 + 3 * i, 0.5),
            0.5,
            principled("post%d" % i, Base_Color=(0.2 + 0.15 * i, 0.4, 0.8 - 0.15 * i), Roughness=0.6),
        )
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(1.5, 0, 0.9))
    cube = bpy.context.object
    cube.data.materials.append(principled("moving", Base_Color=(0.8, 0.5, 0.1), Roughness=0.5))
    motion_of(cube, "location", (0.6, -0.6, 0.9), (2.4, -0.6, 1.1))
    cube.animation_data_clear()
    cube.keyframe_insert("location", frame=0)
    motion_of(cube, "location", (0.6, -0.6, 0.9), (2.4, -0.6, 1.1))
    motion_of(cube, "rotation_euler", (0, 0, 0), (0, 0, 1.5))
    bpy.ops.mesh.primitive_grid_add(
        x_subdivisions=24, y_subdivisions=24, size=1.6, location=(-1.6, -0.5, 1.1), rotation=(math.pi / 2, 0, 0)
    )
    flag = bpy.context.object
    flag.data.materials.append(principled("flag", Base_Color=(0.7, 0.1, 0.2), Roughness=0.8))
    flag.shape_key_add(name="still")
    swung = flag.shape_key_add(name="swung")
    for v, p in zip(flag.data.vertices, swung.data):
        p.co = v.co + Vector((0.25 * v.co.y, 0.3 * math.sin(3 * v.co.x), 0.3))
    motion_of(swung, "value", 0.0, 1.0) if False else None
    swung.value = 0
    swung.keyframe_insert("value", frame=0)
    swung.value = 1
    swung.keyframe_insert("value", frame=2)
    for curve in flag.data.shape_keys.animation_data.action.fcurves:
        for k in curve.keyframe_points:
            k.interpolation = "LINEAR"
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.frame_set(1)


SCENES = {"default": default, "materials": materials, "lights": lights, "crowd": crowd, "lens": lens}
__all__ = ["SCENES", "Matrix"]

"""What users set: of the render, of materials, of view layers, of the add-on."""
import json

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

OUTPUTS = (
    ("use_direct", "direct", "Direct", "Light that was scattered once at most"),
    ("use_indirect", "indirect", "Indirect", "Light that was scattered twice or more"),
    ("use_albedo", "albedo", "Albedo", "What the surfaces give back of even light"),
    ("use_variance", "variance", "Variance", "Variance of the luminance of a pixel"),
    ("use_samples", "samples", "Samples", "Samples of a pixel"),
)


class AlpenglowPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: StringProperty(
        name="Program", subtype="FILE_PATH", description="Path of the program `alpenglow`; empty: it is found on PATH"
    )

    def draw(self, _):
        self.layout.prop(self, "program")


class AlpenglowScene(bpy.types.PropertyGroup):
    hider: EnumProperty(
        name="Hider",
        default="path",
        items=(
            ("path", "Path", "Path tracing: light between all surfaces"),
            ("hidden", "Hidden", "Micropolygons and lights alone, as RISpec has it"),
            ("raytrace", "Raytrace", "As hidden; each sample is shaded where it lies"),
        ),
    )
    samples: IntProperty(name="Samples", default=64, min=1, soft_max=4096, description="Samples of a pixel")
    preview_samples: IntProperty(
        name="Viewport", default=8, min=1, soft_max=256, description="Samples of a pixel in the viewport"
    )
    use_noise: BoolProperty(name="Stop at Noise", description="Go on until the noise is as low as this; Samples has no say")
    noise: FloatProperty(
        name="Noise", default=0.02, min=0.0005, max=1, precision=4, description="Mean relative error of the light on surfaces"
    )
    time: FloatProperty(
        name="Time Limit", default=0, min=0, unit="TIME_ABSOLUTE", description="Go on for about so many seconds; 0: no limit"
    )
    threads: IntProperty(name="Threads", default=0, min=0, max=1024, description="0: as many as there are processors")
    seed: IntProperty(name="Seed", default=0, min=0)
    seed_by_frame: BoolProperty(name="Seed by Frame", description="The noise of an animation changes")
    filter: EnumProperty(
        name="Filter",
        default="gaussian",
        items=(("gaussian", "Gaussian", "As wide as Blender's own of the same size"), ("box", "Box", "The mean over a square")),
    )
    max_depth: IntProperty(name="Bounces", default=32, min=0, max=1000)
    clamp: FloatProperty(
        name="Clamp", default=0, min=0, description="Scale brighter samples down to this: less noise, but a bias; 0: not at all"
    )
    guide: BoolProperty(name="Guide Caustics", default=True, description="Aim rays at mirrors and glass that light comes from")
    caustics: BoolProperty(name="Caustics by Photons")
    motion_keys: IntProperty(
        name="Motion Keys", default=3, min=2, max=32, description="Times of the shutter at which the scene is read"
    )
    subdivision: BoolProperty(
        name="Subdivision Surfaces",
        default=True,
        description="Write a mesh whose one modifier is a subdivision surface as the smooth surface itself",
    )
    binary: BoolProperty(name="Binary RIB", default=True)
    folder: StringProperty(
        name="Keep Files",
        subtype="DIR_PATH",
        description="Folder in which RIB, shaders and pictures stay; empty: they are removed",
    )
    options: StringProperty(name="More Options", description="Added to the command line of `alpenglow render`")
    requests: StringProperty(name="More Requests", description="RIB requests before the world")


class AlpenglowParameter(bpy.types.PropertyGroup):
    kind: StringProperty()
    number: FloatProperty(name="Value", precision=4)
    color: FloatVectorProperty(name="Value", subtype="COLOR", size=3, soft_min=0, soft_max=1)
    vector: FloatVectorProperty(name="Value", size=3)
    text: StringProperty(name="Value")
    count: IntProperty(default=0)
    use: BoolProperty(name="Set", description="Write this parameter; else the shader's own default holds")
    attribute: StringProperty(
        name="Attribute", description="Attribute, UV layer or vertex group of the mesh that gives the parameter"
    )

    def value(self):
        if self.kind == "float":
            return self.number
        return self.text if self.kind == "string" else list(self.color if self.kind == "color" else self.vector)

    def field(self):
        return {"float": "number", "string": "text", "color": "color"}.get(self.kind, "vector")


class AlpenglowMaterial(bpy.types.PropertyGroup):
    use_shader: BoolProperty(name="RSL Shader", description="Use an RSL surface shader in place of the nodes")
    shader: StringProperty(
        name="Shader", subtype="FILE_PATH", description="An RSL file (.sl), or the name of a shader that ships"
    )
    shader_name: StringProperty()
    parameters: CollectionProperty(type=AlpenglowParameter)

    def request(self):
        """Parameters of the Surface request: those that are set."""
        return {"%s %s" % (p.kind, p.name): p.value() for p in self.parameters if p.use and not p.attribute}

    def fill(self, name, parameters):
        """Takes what `alpenglow info --json` said; values that are set stay. Returns the names of parameters that have no
        place here."""
        old = {p.name: (p.kind, p.use, p.value(), p.attribute) for p in self.parameters}
        self.shader_name, left = name, []
        self.parameters.clear()
        for one in parameters:
            default = one.get("default")
            if (
                one.get("output")
                or one["type"] not in ("float", "string", "color", "point", "vector", "normal")
                or "array" in one
                or "length" in one
            ):
                left.append(one["name"])
                continue
            p = self.parameters.add()
            p.name, p.kind = one["name"], one["type"]
            value = default if isinstance(default, list) else [default]
            if p.kind == "string":
                p.text = str(value[0] if value and value[0] is not None else "")
            elif value and all(isinstance(v, (int, float)) for v in value):
                if p.kind == "float":
                    p.number = value[0]
                elif len(value) == 3:
                    setattr(p, p.field(), value)
            if old.get(p.name, ("",))[0] == p.kind:
                _, p.use, kept, p.attribute = old[p.name]
                if p.use:
                    setattr(p, p.field(), kept)
        return left


class AlpenglowViewLayer(bpy.types.PropertyGroup):
    pass


AlpenglowViewLayer.__annotations__ = {
    use: BoolProperty(name=name, description=text, update=lambda layer, context: layer.changed())
    for use, _, name, text in OUTPUTS
}
AlpenglowViewLayer.__annotations__["lights"] = BoolProperty(
    name="Lights", description="A pass for each light: its light alone", update=lambda layer, context: layer.changed()
)
AlpenglowViewLayer.__annotations__["expressions"] = StringProperty(
    name="Light Paths",
    description='Passes by expressions, as JSON: {"name": "lpe:C<RD>L"}',
    update=lambda layer, context: layer.changed(),
)


def changed(self):
    for layer in self.id_data.view_layers:
        layer.update_render_passes()


AlpenglowViewLayer.changed = changed


def expressions(layer):
    """Passes that the user names: name -> expression. Raises ValueError."""
    text = layer.alpenglow.expressions.strip()
    if not text:
        return {}
    found = json.loads(text)
    if not isinstance(found, dict) or not all(isinstance(v, str) for v in found.values()):
        raise ValueError('expected {"name": "lpe:..."}')
    return found


CLASSES = (AlpenglowPreferences, AlpenglowScene, AlpenglowParameter, AlpenglowMaterial, AlpenglowViewLayer)


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.alpenglow = PointerProperty(type=AlpenglowScene)
    bpy.types.Material.alpenglow = PointerProperty(type=AlpenglowMaterial)
    bpy.types.ViewLayer.alpenglow = PointerProperty(type=AlpenglowViewLayer)


def unregister():
    del bpy.types.Scene.alpenglow, bpy.types.Material.alpenglow, bpy.types.ViewLayer.alpenglow
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)


def program(context=None):
    """The path that the preferences name."""
    addon = (context or bpy.context).preferences.addons.get(__package__)
    return addon.preferences.program if addon else ""

"""Panels."""
import bpy

from . import program, properties

ENGINE = {"ALPENGLOW"}


class Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"

    @classmethod
    def poll(cls, context):
        return context.engine in ENGINE


def rows(panel, of, *names):
    panel.layout.use_property_split = True
    panel.layout.use_property_decorate = False
    for name in names:
        panel.layout.prop(of, name)


class ALPENGLOW_PT_sampling(Panel, bpy.types.Panel):
    bl_label, bl_context = "Sampling", "render"

    def draw(self, context):
        own = context.scene.alpenglow
        rows(self, own, "hider", "samples", "preview_samples")
        if own.hider == "path":
            rows(self, own, "use_noise", "noise", "time", "clamp", "guide", "caustics")
        rows(self, own, "max_depth", "seed", "seed_by_frame")


class ALPENGLOW_PT_machine(Panel, bpy.types.Panel):
    bl_label, bl_context, bl_options = "Export and Performance", "render", {"DEFAULT_CLOSED"}

    def draw(self, context):
        rows(self, context.scene.alpenglow, "threads", "binary", "subdivision", "folder", "options", "requests")


class ALPENGLOW_PT_motion(Panel, bpy.types.Panel):
    bl_label, bl_context, bl_options = "Motion Blur", "render", {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        rows(self, context.scene.render, "motion_blur_shutter")
        rows(self, context.scene.alpenglow, "motion_keys")


class ALPENGLOW_PT_film(Panel, bpy.types.Panel):
    bl_label, bl_context, bl_options = "Film", "render", {"DEFAULT_CLOSED"}

    def draw(self, context):
        rows(self, context.scene.render, "film_transparent", "filter_size")
        rows(self, context.scene.alpenglow, "filter")


class ALPENGLOW_PT_passes(Panel, bpy.types.Panel):
    bl_label, bl_context = "Passes", "view_layer"

    def draw(self, context):
        layer = context.view_layer
        rows(
            self,
            layer,
            "use_pass_z",
            "use_pass_normal",
            "use_pass_diffuse_direct",
            "use_pass_diffuse_indirect",
            "use_pass_glossy_direct",
            "use_pass_glossy_indirect",
            "use_pass_transmission_direct",
            "use_pass_transmission_indirect",
            "use_pass_emit",
            "use_pass_environment",
        )
        rows(self, layer.alpenglow, *[use for use, _, _, _ in properties.OUTPUTS], "lights", "expressions")


class ALPENGLOW_OT_read_parameters(bpy.types.Operator):
    """Asks the program for the parameters of the shader"""

    bl_idname, bl_label = "alpenglow.read_parameters", "Read Parameters"

    def execute(self, context):
        material = context.material if hasattr(context, "material") and context.material else context.object.active_material
        own = material.alpenglow
        try:
            binary = program.find(properties.program(context))
            name, parameters = program.parameters(binary, bpy.path.abspath(own.shader))
        except (program.Missing, ValueError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        left = own.fill(name, parameters)
        if left:
            self.report({"INFO"}, "Without a field here: " + ", ".join(left))
        return {"FINISHED"}


class ALPENGLOW_PT_material(Panel, bpy.types.Panel):
    bl_label, bl_context = "RSL Shader", "material"

    @classmethod
    def poll(cls, context):
        return context.engine in ENGINE and context.material is not None

    def draw_header(self, context):
        self.layout.prop(context.material.alpenglow, "use_shader", text="")

    def draw(self, context):
        own = context.material.alpenglow
        self.layout.active = own.use_shader
        rows(self, own, "shader")
        self.layout.operator("alpenglow.read_parameters")
        for p in own.parameters:
            row = self.layout.row(align=True)
            row.prop(p, "use", text="")
            row.label(text=p.name)
            if p.attribute:
                row.prop(p, "attribute", text="")
            else:
                row.prop(p, p.field(), text="")
                row.prop(p, "attribute", text="", icon="SPREADSHEET")


CLASSES = (
    ALPENGLOW_PT_sampling,
    ALPENGLOW_PT_motion,
    ALPENGLOW_PT_film,
    ALPENGLOW_PT_machine,
    ALPENGLOW_PT_passes,
    ALPENGLOW_OT_read_parameters,
    ALPENGLOW_PT_material,
)
SKIPPED = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_freestyle", "RENDER_PT_simplify"}


SHARED = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_EEVEE_light",
    "DATA_PT_spot",
}


def panels():
    """Blender's own panels that serve any renderer. Each must have a set of engines of its own: panels of Cycles share one."""
    for panel in bpy.types.Panel.__subclasses__():
        if (
            "COMPAT_ENGINES" in panel.__dict__
            and panel.__name__ not in SKIPPED
            and ("BLENDER_RENDER" in panel.COMPAT_ENGINES or panel.__name__ in SHARED)
        ):
            yield panel


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    for panel in panels():
        panel.COMPAT_ENGINES.add("ALPENGLOW")


def unregister():
    for panel in panels():
        panel.COMPAT_ENGINES.discard("ALPENGLOW")
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)

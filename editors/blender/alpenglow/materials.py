"""Materials: each is the text of a shader next to the RIB, or an RSL shader that the user names."""
import os

import numpy as np

from . import exr
from .compiler import Compiler, identifier, output_node

HEAD = '#define BL_LIGHTS "%s", 1\n#include "closures.h"\n#include "textures.h"\n'
DEFAULT = (
    "surface bldefault()\n{\n    Oi = 1;\n    Ci = .8 * diffuse(blSeen((blFront() == 1) ? normalize(N) : -normalize(N)));\n}\n"
)


class Images:
    """Image files by image: those that lie in the blend file or in memory are written next to the RIB."""

    def __init__(self, folder, report):
        self.folder, self.report, self.found = folder, report, {}

    def file(self, image, where):
        """(path, "srgb" or "linear": as what the program takes its numbers); (None, None) where there is none."""
        key = image.name_full
        if key not in self.found:
            self.found[key] = self._file(image, where)
        return self.found[key]

    def _file(self, image, where):
        import bpy

        path = os.path.normpath(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else ""
        coded = "linear" if image.is_float else "srgb"
        if image.packed_file is not None and not image.is_dirty and image.source == "FILE":
            path = os.path.join(self.folder, "%s%s" % (identifier(image.name), os.path.splitext(path)[1] or ".png"))
            with open(path, "wb") as f:
                f.write(image.packed_file.data)
            return path, coded
        if image.source in ("FILE", "SEQUENCE", "TILED") and not image.is_dirty and os.path.isfile(path):
            return path, coded
        if image.size[0] * image.size[1] == 0:
            self.report.lost("Image that is not there: %s" % (path or image.name), where)
            return None, None
        pixels = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
        image.pixels.foreach_get(pixels)
        pixels = pixels.reshape(image.size[1], image.size[0], image.channels)[::-1]
        if image.channels < 3:
            pixels = np.repeat(pixels[:, :, :1], 3, 2)
        if not image.is_float and image.colorspace_settings.name == "sRGB":  # bytes come as they are stored
            light = pixels[:, :, :3]
            pixels = np.concatenate(
                [np.where(light <= 0.04045, light / 12.92, ((np.maximum(light, 0) + 0.055) / 1.055) ** 2.4), pixels[:, :, 3:]],
                2,
            )
        path = os.path.join(self.folder, identifier(image.name) + ".exr")
        exr.write(path, pixels)
        return path, "done"


class Written:
    """A material in RIB. name: of the surface; parameters: of its request; needs: what geometry must bring; lamp: radiance of
    an area light
    or None; medium: parameters of its Interior; displacement: name of a shader."""

    def __init__(self, name, parameters=None, needs=()):
        self.name, self.parameters, self.needs = name, parameters or {}, set(needs)
        self.lamp = self.medium = self.displacement = None
        self.bound = 0.0


class Materials:
    def __init__(self, folder, report, images, lights_word):
        self.folder, self.report, self.images, self.head = folder, report, images, HEAD % lights_word
        self.written, self.names = {}, set()
        self.default = None

    def get(self, material):
        """What a slot holds; None is Blender's default, a white that reflects .8."""
        if material is None:
            if self.default is None:
                self._file("bldefault", DEFAULT)
                self.default = Written("bldefault")
            return self.default
        material = material.original
        key = material.name_full
        if key not in self.written:
            self.written[key] = self._make(material)
        return self.written[key]

    def _file(self, name, text):
        with open(os.path.join(self.folder, name + ".sl"), "w", encoding="utf-8") as f:
            f.write(self.head + text)

    def _name(self, material):
        name = "bl_" + identifier(material.name)
        while name in self.names:
            name += "x"
        self.names.add(name)
        return name

    def _make(self, material):
        own = getattr(material, "alpenglow", None)
        if own is not None and own.use_shader and own.shader:
            return self._shader(own)
        name = self._name(material)
        if not material.use_nodes or material.node_tree is None:
            r, g, b = material.diffuse_color[:3]
            text = DEFAULT.replace("bldefault", name).replace(".8", "color(%.7g, %.7g, %.7g)" % (r, g, b))
            self._file(name, text)
            return Written(name)
        out, tree = Written(name), material.node_tree
        out.lamp = lamp(self._compiler(name, material), tree)
        compiler = self._compiler(name, material)
        compiler.emission = out.lamp is None
        bumped(compiler, material, tree)
        text = compiler.surface(tree)
        out.needs = compiler.needs
        self._file(name, text)
        end = output_node(tree)
        if end is not None:
            if end.inputs["Volume"].is_linked:
                out.medium = medium(self._compiler(name, material), end)
                if out.medium is not None and not end.inputs["Surface"].is_linked:
                    out.name = "null"
            if end.inputs["Displacement"].is_linked and method(material) != "BUMP":
                moving = self._compiler(name + "_moved", material)
                moving.kind = "displacement"
                self._file(name + "_moved", moving.displacement(tree))
                out.displacement, out.bound = name + "_moved", 1.0
                out.needs |= moving.needs
        return out

    def _compiler(self, name, material):
        return Compiler(name, material.name, "surface", self.report, self.images)

    def _shader(self, own):
        import bpy

        path = bpy.path.abspath(own.shader)
        name = own.shader_name or os.path.splitext(os.path.basename(path))[0]
        out = Written(name, own.request())
        out.folder = os.path.dirname(path) if os.path.isfile(path) else ""
        for p in own.parameters:  # what geometry brings under the parameter's name
            if p.attribute:
                out.needs.add(("parameter", p.name, p.kind, p.attribute))
        return out


def method(material):
    return getattr(material, "displacement_method", None) or getattr(
        getattr(material, "cycles", None), "displacement_method", "BUMP"
    )


def bumped(compiler, material, tree):
    """Displacement as bump, Blender's default: the normal of the whole shader turns."""
    end = output_node(tree)
    if end is None or not end.inputs["Displacement"].is_linked or method(material) == "DISPLACEMENT":
        return
    moved = compiler.value(end, "Displacement", "vector").code
    compiler.say('blN = blBumped(vtransform("object", "current", %s), blN);' % moved)


def lamp(compiler, tree):
    """Radiance that a material emits where it is the same everywhere, else None: then rays find it."""
    end = output_node(tree)
    links = end.inputs["Surface"].links if end else ()
    if not links:
        return None
    groups, out = compiler.source(end.inputs["Surface"])

    def of(groups, out):
        if out is None:
            return (0.0, 0.0, 0.0)
        n = out.node
        compiler.groups = groups
        names = {
            "ShaderNodeEmission": ("Color", "Strength"),
            "ShaderNodeBackground": ("Color", "Strength"),
            "ShaderNodeBsdfPrincipled": (("Emission", "Emission Color"), "Emission Strength"),
        }.get(n.bl_idname)
        if names:
            colour, strength = compiler.fixed(n, names[0], (0, 0, 0)), compiler.fixed(n, names[1], 1.0)
            if n.bl_idname == "ShaderNodeBsdfPrincipled" and (colour == (0.0, 0.0, 0.0) or strength == 0):
                return (0.0, 0.0, 0.0)
            if (
                colour is None
                or strength is None
                or n.bl_idname == "ShaderNodeBsdfPrincipled"
                and compiler.fixed(n, "Alpha", 1.0) != 1
            ):
                return None
            return tuple(x * strength for x in colour)
        if n.bl_idname == "ShaderNodeAddShader":
            parts = []
            for s in n.inputs:
                compiler.groups = groups
                parts.append(of(*compiler.source(s)))
            return None if None in parts else tuple(map(sum, zip(*parts)))
        if n.bl_idname == "ShaderNodeMixShader" or n.bl_idname not in NO_LIGHT:
            return None
        return (0.0, 0.0, 0.0)

    found = of(groups, out)
    return found if found is not None and any(x > 0 for x in found) else None


NO_LIGHT = {
    "ShaderNodeBsdf" + k for k in ("Diffuse", "Glossy", "Glass", "Refraction", "Translucent", "Velvet", "Sheen", "Anisotropic")
}


def medium(compiler, end):
    """Parameters of the shipped volume shader `medium`, of constant nodes."""
    total = {"color scattering": [0, 0, 0], "color absorption": [0, 0, 0], "float anisotropy": 0.0}

    def add(groups, out):
        n = out.node
        compiler.groups = groups
        if n.bl_idname == "ShaderNodeAddShader":
            for s in n.inputs:
                compiler.groups = groups
                inner, source = compiler.source(s)
                if source is not None:
                    add(inner, source)
            return
        density = compiler.fixed(n, "Density", 1.0)
        colour = compiler.fixed(n, "Color", (0.5, 0.5, 0.5))
        if density is None or colour is None:
            compiler.lost("Volumes that vary from place to place (their nodes' own values are taken)")
            density, colour = density or 1.0, colour or (0.5, 0.5, 0.5)
        if n.bl_idname in ("ShaderNodeVolumeScatter", "ShaderNodeVolumePrincipled"):
            total["color scattering"] = [a + density * x for a, x in zip(total["color scattering"], colour)]
            total["float anisotropy"] = compiler.fixed(n, "Anisotropy", 0.0) or 0.0
        if n.bl_idname == "ShaderNodeVolumePrincipled":
            dark = compiler.fixed(n, "Absorption Color", (0, 0, 0)) or (0, 0, 0)
            total["color absorption"] = [
                a + density * max(1 - x, 0) * max(1 - d, 0)
                for a, x, d in zip(total["color absorption"], colour, [d**0.5 for d in dark])
            ]
            if compiler.fixed(n, "Emission Strength", 0.0) or compiler.fixed(n, "Blackbody Intensity", 0.0):
                compiler.lost("Emission of volumes")
        elif n.bl_idname == "ShaderNodeVolumeAbsorption":
            total["color absorption"] = [a + density * max(1 - x, 0) for a, x in zip(total["color absorption"], colour)]
        elif n.bl_idname != "ShaderNodeVolumeScatter":
            compiler.lost("Node %s of a volume" % n.bl_label)

    groups, out = compiler.source(end.inputs["Volume"])
    if out is None:
        return None
    add(groups, out)
    return total

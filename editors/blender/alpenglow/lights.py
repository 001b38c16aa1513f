"""Lights. Blender's watts are constants times intensity and radiance; docs/blender.md has the formulas."""
import math

import bpy
from mathutils import Matrix

from . import rib as ribs
from .compiler import output_node
from .rib import Block


def colour(light, report, where):
    """Colour times power (watts; of a sun watts per square metre), with the constant Emission of its nodes."""
    strength = [light.energy * x for x in light.color]
    exposure = getattr(light, "exposure", 0.0)
    strength = [x * 2**exposure for x in strength]
    if getattr(light, "use_temperature", False):
        from .nodes.converters import blackbody_colour

        strength = [x * max(k, 0) for x, k in zip(strength, blackbody_colour(light.temperature))]
    if not light.use_nodes or light.node_tree is None:
        return strength
    end = output_node(light.node_tree)
    links = end.inputs["Surface"].links if end else ()
    source = links[0].from_node if links else None
    if source is None or source.bl_idname != "ShaderNodeEmission" or any(s.is_linked for s in source.inputs):
        report.lost("Nodes of lights (other than a constant Emission)", where)
        return strength
    e = source.inputs
    return [x * e["Color"].default_value[i] * e["Strength"].default_value for i, x in enumerate(strength)]


def unscaled(m):
    """A placement without its scale, right-handed."""
    place, turn, _ = m.decompose()
    return Matrix.Translation(place) @ turn.to_matrix().to_4x4()


class Lights:
    """Writes lights before everything that they shine on. Each has a handle, its name."""

    def __init__(self, rib, report, times):
        self.rib, self.report, self.times, self.count = rib, report, times, 0

    def handle(self, name):
        self.count += 1
        return "%s.%d" % (name, self.count)

    def write(self, name, light, matrices, visible):
        """light: the evaluated data; matrices: of its object at each time; visible: names of attributes -> 0, as
        object_visibility()."""
        where, rib = name, self.rib
        power = colour(light, self.report, where)
        if not getattr(light, "use_shadow", True) or not getattr(getattr(light, "cycles", None), "cast_shadow", True):
            self.report.lost("Lights without shadows", where)
        for field, what in (("diffuse_factor", "Diffuse"), ("specular_factor", "Specular"), ("volume_factor", "Volume")):
            if abs(getattr(light, field, 1.0) - 1) > 1e-4:
                self.report.lost("%s factor of lights" % what, where)
        kind = light.type
        radius = getattr(light, "shadow_soft_size", 0.0)
        handle = self.handle(name)
        with Block(rib, "Attribute"):
            rib.request("Attribute", "light", {"string group": name})
            if kind == "SUN":
                ribs.transform(rib, [ribs.matrix(unscaled(m)) for m in matrices], self.times)
                rib.request("LightSource", "blsun", handle, {"color irradiance": power, "float half": light.angle / 2})
            elif kind == "AREA":
                self._area(handle, light, matrices, power, visible)
            else:
                spot = {}
                if kind == "SPOT":
                    spot = {
                        "float edge": math.cos(light.spot_size / 2),
                        "float blend": light.spot_blend,
                        "float falling": 1 if bpy.app.version < SPOT_CHANGED else 0,
                    }
                self._ball(handle, kind, matrices, power, radius, spot, visible)
        rib.request("Illuminate", handle, 1)

    def _ball(self, handle, kind, matrices, power, radius, spot, visible):
        """Point and spot lights: a sphere that its camera does not see, or a point."""
        rib = self.rib
        shader = "blspot" if kind == "SPOT" else "blpoint" if radius <= 0 else "blarea"
        ribs.transform(rib, [ribs.matrix(unscaled(m)) for m in matrices], self.times)
        if radius <= 0:
            rib.request(
                "LightSource", shader, handle, dict({"color intensity": [p / (4 * math.pi**2) for p in power]}, **spot)
            )
            return
        radiance = [p / (4 * math.pi**2 * radius**2) for p in power]
        if kind == "SPOT":
            rib.request("AreaLightSource", shader, handle, dict({"color intensity": radiance, "float area": 1}, **spot))
        else:
            rib.request("AreaLightSource", shader, handle, {"color radiance": radiance})
        self._unseen(visible)
        rib.request("Sphere", radius, -radius, radius, 360)

    def _unseen(self, visible):
        """As in Cycles: seen by rays but those of the camera, and in nobody's way. The shape reflects nothing."""
        rib = self.rib
        rib.request("Sides", 1)
        rib.request("Surface", "constant")
        rib.request("Color", [0, 0, 0])
        rib.request(
            "Attribute",
            "visibility",
            dict(
                {"int camera": 0, "int transmission": 0},
                **{k: v for k, v in visible.items() if k not in ("int camera", "int transmission")}
            ),
        )

    def _area(self, handle, light, matrices, power, visible):
        rib, m = self.rib, matrices[0]
        round_shape = light.shape in ("DISK", "ELLIPSE")
        x, y = light.size / 2, (light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size) / 2
        sides = [m.col[i].to_3d().length for i in range(2)]
        x, y = x * sides[0], y * sides[1]
        area = math.pi * x * y if round_shape else 4 * x * y
        if getattr(light, "spread", math.pi) < math.pi - 1e-4:
            self.report.lost("Spread of area lights", light.name)
        if area <= 0:
            return
        ribs.transform(rib, [ribs.matrix(unscaled(k)) for k in matrices], self.times)
        rib.request("AreaLightSource", "blarea", handle, {"color radiance": [p / (4 * area) for p in power]})
        self._unseen(visible)
        if round_shape:
            rib.request("Scale", x, y, 1)
            rib.request("ReverseOrientation")
            rib.request("Disk", 0, 1, 360)
        else:
            rib.request("PointsPolygons", [4], [0, 1, 2, 3], {"P": [-x, -y, 0, -x, y, 0, x, y, 0, x, -y, 0]})


SPOT_CHANGED = (3, 6, 0)

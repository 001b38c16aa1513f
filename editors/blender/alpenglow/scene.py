"""A scene of Blender as RIB: what is in it, at the times of the shutter, and how it is written."""
import os
import shutil

import numpy as np

from . import camera, geometry, hair, world
from . import rib as ribs
from .lights import Lights
from .materials import Images, Materials
from .report import Report
from .rib import Block, Rib

MESHES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
IGNORED = {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}
SHADERS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "shaders")


class Shape:
    """Geometry that one or more instances show. meshes: a Mesh or None; strands: [(Strands, index of a material)]."""

    def __init__(self, name, slots):
        self.name, self.slots, self.mesh, self.strands, self.points, self.tags = name, slots, None, [], None, None
        self.deforms = False


class Instance:
    def __init__(self, shape, matrix, visible, user):
        self.shape, self.matrices, self.visible, self.user = shape, [matrix], visible, user


class Scene:
    """Everything that is written of a depsgraph. frame_set(frame, subframe): evaluates another time (for motion); None: no motion.
    view: an eye in place of the scene's camera."""

    def __init__(self, depsgraph, folder, settings, lights_word, frame_set=None, progress=None, view=None):
        self.depsgraph, self.folder, self.settings, self.frame_set = depsgraph, folder, settings, frame_set
        self.progress = progress or (lambda part, text: None)
        self.report, self.shapes, self.instances, self.lamps = Report(), {}, {}, {}
        self.images = Images(folder, self.report)
        self.materials = Materials(folder, self.report, self.images, lights_word)
        self.camera, self.view = None, view

    # Reading.
    def read(self):
        """Reads the scene, at each time of the shutter. The places come last, so that the first is the frame's own geometry."""
        self.times, offsets = [0.0], [0.0]
        scene = self.depsgraph.scene_eval
        motion = scene.render.use_motion_blur and self.frame_set is not None
        if motion:
            shutter = scene.render.motion_blur_shutter
            where = getattr(scene.render, "motion_blur_position", None) or getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
            start = {"START": 0.0, "CENTER": -.5, "END": -1.0}.get(where, -.5) * shutter
            keys = max(2, self.settings.motion_keys)
            self.times = [i / (keys - 1) for i in range(keys)]
            offsets = [start + shutter * t for t in self.times]
        frame = scene.frame_current + scene.frame_subframe
        self._gather(first=True)
        if not motion:
            return
        base = {key: (list(i.matrices)) for key, i in self.instances.items()}
        points = {key: s.mesh.P[0] for key, s in self.shapes.items() if s.mesh is not None}
        for all_of in (self.instances, self.lamps):
            for one in all_of.values():
                one.matrices = []
        cameras = []
        for s in self.shapes.values():
            if s.mesh is not None and s.deforms:
                s.mesh.P = []
        for offset in offsets:
            at = frame + offset
            self.frame_set(int(np.floor(at)), at - float(np.floor(at)))
            self._gather(first=False)
            cameras.append(self._camera_place())
        self.frame_set(int(np.floor(frame)), frame - float(np.floor(frame)))
        self.camera = cameras
        for key, one in self.instances.items():
            if len(one.matrices) != len(offsets):
                self.report.lost("Motion of what appears or goes while the shutter is open", one.shape.name)
                one.matrices = base[key]
        for one in self.lamps.values():
            if len(one.matrices) != len(offsets):
                one.matrices = [one.first]
        for key, s in self.shapes.items():
            if s.mesh is not None and (len(s.mesh.P) != len(offsets) and s.deforms):
                if s.mesh.P:
                    self.report.lost("Motion of meshes whose number of points changes", s.name)
                s.mesh.P = [points[key]]

    def _camera_place(self):
        if self.view is not None:
            return camera.from_eye(self.view[0])
        eye = self.depsgraph.scene_eval.camera
        return None if eye is None else camera.placed(eye)

    def _gather(self, first):
        if first:
            self.camera = [self._camera_place()]
        lamps, self.seen_now = {}, set()
        for inst in self.depsgraph.object_instances:
            obj = inst.object
            key = (obj.name_full, inst.parent.name_full if inst.is_instance and inst.parent else "", tuple(inst.persistent_id))
            if obj.type == "LIGHT":
                if inst.show_self:
                    lamps[key] = (obj, inst.matrix_world.copy())
                continue
            if inst.show_self or inst.show_particles:
                self._object(inst, obj, key, first)
        for key, (obj, place) in lamps.items():
            if first:
                self.lamps[key] = Lamp(obj, place)
            elif key in self.lamps:
                self.lamps[key].matrices.append(place)

    def _shape_key(self, inst, obj):
        """What instances share: an object, and data that geometry nodes put in its place."""
        data = obj.data.name_full if obj.data is not None else ""
        own = obj.original.data is not None and data == obj.original.data.name_full
        return (obj.name_full, data if own or not inst.is_instance else (data, obj.data.as_pointer()), inst.show_self)

    def _object(self, inst, obj, key, first):
        kind = obj.type
        if kind in IGNORED:
            return
        if kind not in MESHES | {"CURVES", "POINTCLOUD"}:
            self.report.lost({"VOLUME": "Volume objects", "GPENCIL": "Grease pencil", "GREASEPENCIL": "Grease pencil"}.get(kind, "Objects of type " + kind), obj.name)
            return
        shape_key = self._shape_key(inst, obj)
        if first:
            shape = self.shapes.get(shape_key)
            if shape is None:
                shape = self.shapes[shape_key] = self._shape(inst, obj)
            self.instances[key] = Instance(shape, inst.matrix_world.copy(), visibility(obj, self.report),
                                           user(inst, obj) if shape.asks else {})
        elif key in self.instances:
            one = self.instances[key]
            one.matrices.append(inst.matrix_world.copy())
            shape = one.shape
            if shape.mesh is not None and shape.deforms and id(shape) not in self.seen_now:
                self.seen_now.add(id(shape))
                me = self._mesh_of(obj)
                if me is not None and len(me.vertices) == shape.count:
                    shape.mesh.P.append(geometry.positions(self._base(obj, me) if shape.mesh.subdivision is not None else me))
                self._clear(obj)

    def _mesh_of(self, obj):
        try:
            return obj.to_mesh(preserve_all_data_layers=True, depsgraph=self.depsgraph)
        except RuntimeError:
            return None

    @staticmethod
    def _clear(obj):
        obj.to_mesh_clear()

    @staticmethod
    def _base(obj, me):
        return obj.original.data

    def _shape(self, inst, obj):
        slots = [s.material for s in obj.material_slots] or list(getattr(obj.data, "materials", None) or []) or [None]
        shape = Shape(obj.name, slots)
        written = [self.materials.get(m) for m in slots]
        needs = set().union(*(w.needs for w in written))
        shape.asks = True
        if obj.type == "CURVES":
            shape.strands.append((hair.hair_curves(obj.data), 0))
            return shape
        if obj.type == "POINTCLOUD":
            shape.points = geometry.taken(obj.data.points, "co", 3), geometry.taken(obj.data.points, "radius", 1)
            return shape
        if inst.show_self:
            self._read_mesh(shape, obj, needs)
        if getattr(inst, "show_particles", True) and obj.type == "MESH":
            self._read_hair(shape, obj)
        return shape

    def _read_mesh(self, shape, obj, needs):
        me = self._mesh_of(obj)
        if me is None or len(me.polygons) == 0:
            self._clear(obj)
            return
        smooth = subdivided(obj, len(set(geometry.taken(me.polygons, "material_index", 1, np.int32).tolist())), self.settings, self.report)
        if smooth:
            base = obj.original.data
            shape.mesh = geometry.read(obj, base, needs, obj.name, self.report, polygons=True)
            index = geometry.taken(base.polygons, "material_index", 1, np.int32)
            shape.mesh.materials[:] = index[0] if len(index) else 0
            shape.tags = geometry.creases(base)
        else:
            shape.mesh = geometry.read(obj, me, needs, obj.name, self.report)
        shape.count = len(me.vertices)
        shape.deforms = not smooth and (len(obj.modifiers) > 0 or getattr(obj.data, "shape_keys", None) is not None or obj.type != "MESH")
        self._clear(obj)

    def _read_hair(self, shape, obj):
        systems = [m for m in obj.modifiers if m.type == "PARTICLE_SYSTEM" and m.show_render]
        for modifier in systems:
            system = modifier.particle_system
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                strands = hair.particles(obj, system, modifier, obj.matrix_world, self.report)
                if strands is not None:
                    shape.strands.append((strands, max(system.settings.material - 1, 0)))
            elif system.settings.type == "EMITTER" and system.settings.render_type in ("HALO", "LINE", "PATH"):
                self.report.lost("Particles drawn as %s" % system.settings.render_type.lower(), obj.name)
        if systems and self.depsgraph.scene_eval.render.use_motion_blur:
            self.report.lost("Motion of hair against its object", obj.name)

    # Writing.
    def write(self, path, head):
        """Writes the scene. head(rib, hider): the requests of the picture; hider: parameters that the camera gives."""
        for name in os.listdir(SHADERS):
            shutil.copy(os.path.join(SHADERS, name), self.folder)
        scene = self.depsgraph.scene_eval
        with Rib(path, self.settings.binary) as rib:
            rib.comment("Alpenglow's exporter for Blender")
            rib.request("version", 3.03)
            if len(self.times) > 1:
                rib.request("Shutter", 0, 1)
            if self.view is not None:
                hider = camera.write_view(rib, self.view)
            else:
                hider = camera.write(rib, scene.camera, scene, self.report)
            head(rib, hider)
            ribs.transform(rib, self.camera, self.times)
            with Block(rib, "World"):
                rib.request("Sides", 2)
                world.write(rib, scene, self.folder, self.report, self.images)
                lights = Lights(rib, self.report, self.times)
                for lamp in self.lamps.values():
                    lights.write(lamp.name, lamp.data, lamp.matrices, lamp.visible)
                self._shining(rib, lights)
                self._shapes(rib)
        return self.report

    def _shining(self, rib, lights):
        """Meshes that emit, as area lights."""
        handles = []
        for one in self.instances.values():
            shape = one.shape
            if shape.mesh is None:
                continue
            for index in shape.mesh.material_indices():
                w = self._written(shape, index)
                if w.lamp is not None:
                    handles.append(lights.handle(shape.name))
                    with Block(rib, "Attribute"):
                        rib.request("Attribute", "light", {"string group": shape.name})
                        rib.request("AreaLightSource", "bllamp", handles[-1], {"color radiance": list(w.lamp)})
                        self._place(rib, one)
                        self._material(rib, w)
                        self._mesh(rib, shape, index)
        for handle in handles:
            rib.request("Illuminate", handle, 1)

    def _written(self, shape, index):
        return self.materials.get(shape.slots[min(index, len(shape.slots) - 1)])

    def _place(self, rib, one):
        rib.request("Attribute", "identifier", {"string name": one.shape.name})
        if one.visible:
            rib.request("Attribute", "visibility", one.visible)
        if one.user:
            rib.request("Attribute", "user", one.user)
        ribs.transform(rib, [ribs.matrix(m) for m in one.matrices], self.times)

    def _material(self, rib, w):
        if getattr(w, "folder", ""):
            rib.request("Option", "searchpath", {"string shader": w.folder + ":&"})
        rib.request("Surface", w.name, w.parameters)
        if w.displacement:
            rib.request("Attribute", "displacementbound", {"float sphere": w.bound})
            rib.request("Displacement", w.displacement)
        if w.medium is not None:
            rib.request("Interior", "medium", w.medium)

    def _mesh(self, rib, shape, index):
        geometry.write_mesh(rib, shape.mesh, index, self.times, shape.tags)

    def _draw(self, rib, shape):
        """All of a shape but what shines, with its materials."""
        if shape.mesh is not None:
            for index in shape.mesh.material_indices():
                w = self._written(shape, index)
                if w.lamp is None:
                    with Block(rib, "Attribute"):
                        rib.request("Attribute", "user", {"float blmaterial": index})
                        self._material(rib, w)
                        self._mesh(rib, shape, index)
        for strands, index in shape.strands:
            with Block(rib, "Attribute"):
                w = self._written(shape, index)
                self._material(rib, w)
                hair.write(rib, strands, self.times, "strandrandom" in w.needs)
        if shape.points is not None:
            with Block(rib, "Attribute"):
                self._material(rib, self._written(shape, 0))
                rib.request("Points", {"P": shape.points[0], "varying float width": 2 * shape.points[1]})

    def _shapes(self, rib):
        shown = {}
        for one in self.instances.values():
            shown.setdefault(id(one.shape), []).append(one)
        for number, group in enumerate(shown.values()):
            shape = group[0].shape
            self.progress(number / len(shown), shape.name)
            if len(group) == 1:
                with Block(rib, "Attribute"):
                    self._place(rib, group[0])
                    self._draw(rib, shape)
                continue
            handle = "%s.%d" % (shape.name, number)
            rib.request("ObjectBegin", handle)
            self._draw(rib, shape)
            rib.request("ObjectEnd")
            for one in group:
                with Block(rib, "Attribute"):
                    self._place(rib, one)
                    rib.request("ObjectInstance", handle)


class Lamp:
    """A light: its data as numbers may go when another frame is evaluated, so it is read again from the original."""

    def __init__(self, obj, place):
        self.name, self.data, self.first, self.matrices = obj.name, obj.original.data, place, [place]
        self.visible = {}


def visibility(obj, report):
    """Attributes of an object's ray visibility that differ from the default."""
    out = {}
    for field, name in (("visible_camera", "int camera"), ("visible_diffuse", "int diffuse"), ("visible_glossy", "int specular"),
                        ("visible_shadow", "int transmission")):
        if not getattr(obj, field, True):
            out[name] = 0
    if not getattr(obj, "visible_transmission", True) and "int specular" not in out:
        report.lost("Ray visibility Transmission", obj.name)
    if getattr(obj, "is_shadow_catcher", False):
        report.lost("Shadow catchers", obj.name)
    if getattr(obj, "is_holdout", False):
        report.lost("Holdout objects", obj.name)
    return out


def user(inst, obj):
    """What Object Info asks for."""
    place = inst.matrix_world.translation
    return {"float blrandom": (inst.random_id & 0xffffffff) / 0xffffffff, "float blobject": obj.pass_index,
            "color bllocation": list(place), "color blcolor": list(obj.color)[:3], "float blalpha": obj.color[3]}


def subdivided(obj, materials, settings, report):
    """Whether an object is written as a SubdivisionMesh: its one modifier that renders is Catmull and Clark's."""
    active = [m for m in obj.modifiers if m.show_render and m.type != "PARTICLE_SYSTEM"]
    if not settings.subdivision or obj.type != "MESH" or not active or active[-1].type != "SUBSURF":
        return False
    last = active[-1]
    if last.subdivision_type != "CATMULL_CLARK" or last.render_levels == 0:
        return False
    if len(active) > 1 or getattr(obj.original.data, "shape_keys", None) is not None or obj.original.mode == "EDIT":
        report.lost("SubdivisionMesh behind other modifiers (the mesh is written as it is subdivided)", obj.name)
        return False
    if materials > 1:
        report.lost("SubdivisionMesh of several materials (the mesh is written as it is subdivided)", obj.name)
        return False
    return True

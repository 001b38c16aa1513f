"""Meshes as arrays, and as primitives of RIB: one for each material."""
import numpy as np

from .compiler import identifier

WIDTHS = {"FLOAT": 1, "INT": 1, "BOOLEAN": 1, "INT8": 1, "FLOAT_VECTOR": 3, "FLOAT2": 2, "FLOAT_COLOR": 4, "BYTE_COLOR": 4}
FIELDS = {"FLOAT_VECTOR": "vector", "FLOAT2": "vector", "FLOAT_COLOR": "color", "BYTE_COLOR": "color"}


def taken(collection, field, width, kind=np.float32, count=None):
    out = np.zeros((len(collection) if count is None else count) * width, kind)
    if len(out):
        collection.foreach_get(field, out)
    return out if width == 1 else out.reshape(-1, width)


class Mesh:
    """What of a mesh is written. P: [points at each time]; triangles: three corners each; the rest by corner or by point."""

    def __init__(self):
        self.P, self.variables, self.subdivision = [], {}, None
        self.corners = self.points = self.materials = np.zeros(0, np.int32)

    def material_indices(self):
        return np.unique(self.materials).tolist()


def positions(me):
    return taken(me.vertices, "co", 3)


def corner_normals(me):
    """Normals of corners, or None where all faces are flat."""
    smooth = taken(me.polygons, "use_smooth", 1, bool)
    if not smooth.any() and not getattr(me, "has_custom_normals", False):
        return None
    if hasattr(me, "corner_normals"):  # Blender 4.1
        return taken(me.corner_normals, "vector", 3)
    me.calc_normals_split()
    return taken(me.loops, "normal", 3)


def undeformed(me, co):
    """Generated coordinates of points: 0 to 1 over the texture space."""
    try:
        flat = taken(me.vertices, "undeformed_co", 3)
    except (AttributeError, TypeError, RuntimeError):
        flat = co
    space = np.array(me.texspace_location, np.float32), np.array(me.texspace_size, np.float32)
    size = np.where(np.abs(space[1]) < 1e-9, 1, space[1])
    return (flat - space[0]) / size * 0.5 + 0.5


def attribute_values(me, name, corner_points, corner_faces):
    """(values as colours, "corner" or "point" or "face"), None where there is no such attribute."""
    if name == "":
        found = me.color_attributes.active_color if hasattr(me, "color_attributes") else None
    else:
        found = me.attributes.get(name)
    if found is None or found.data_type not in WIDTHS or found.domain not in ("POINT", "CORNER", "FACE"):
        return None
    width = WIDTHS[found.data_type]
    kind = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool}.get(found.data_type, np.float32)
    v = taken(found.data, FIELDS.get(found.data_type, "value"), width, kind).astype(np.float32).reshape(-1, width)
    if width == 1:
        v = np.repeat(v, 3, 1)
    elif width == 2:
        v = np.concatenate([v, np.zeros((len(v), 1), np.float32)], 1)
    return v[:, :3], {"POINT": "point", "CORNER": "corner", "FACE": "face"}[found.domain]


def vertex_group(obj, me, name):
    group = obj.vertex_groups.get(name) if hasattr(obj, "vertex_groups") else None
    if group is None:
        return None
    v = np.zeros((len(me.vertices), 3), np.float32)
    for vertex in me.vertices:
        for g in vertex.groups:
            if g.group == group.index:
                v[vertex.index] = g.weight
    return v, "point"


def read(obj, me, needs, where, report, polygons=False):
    """A Mesh of an evaluated mesh. needs: as compiler.needs. polygons: whole faces, for SubdivisionMesh."""
    out = Mesh()
    co = positions(me)
    out.P = [co]
    loop_vertices = taken(me.loops, "vertex_index", 1, np.int32)
    if polygons:
        totals = taken(me.polygons, "loop_total", 1, np.int32)
        out.subdivision = totals
        corners = np.arange(len(loop_vertices), dtype=np.int32)
        faces = np.repeat(np.arange(len(totals), dtype=np.int32), totals)
        out.materials = np.zeros(len(totals), np.int32)
    else:
        me.calc_loop_triangles()
        corners = taken(me.loop_triangles, "loops", 3, np.int32).ravel()
        faces = np.repeat(taken(me.loop_triangles, "polygon_index", 1, np.int32), 3)
        out.materials = (
            taken(me.polygons, "material_index", 1, np.int32)[faces[::3]] if len(me.polygons) else np.zeros(0, np.int32)
        )
        normals = corner_normals(me)
        if normals is not None:
            out.variables["facevarying normal N"] = normals[corners]
    out.corners, out.points = corners, loop_vertices[corners] if len(corners) else corners
    point_variables(out, obj, me, co, needs, corners, faces, where, report)
    return out


def point_variables(out, obj, me, co, needs, corners, faces, where, report):
    """Texture coordinates, generated ones and attributes."""
    layers = me.uv_layers
    active = next((layer for layer in layers if layer.active_render), None)
    if active is not None:
        out.variables["facevarying float[2] st"] = taken(active.data, "uv", 2)[corners]
    for need in sorted((n for n in needs if isinstance(n, tuple)), key=str):
        if need[0] == "uv" and need[1]:
            layer = layers.get(need[1])
            if layer is not None:
                out.variables["facevarying float[2] bl_uv_" + identifier(need[1])] = taken(layer.data, "uv", 2)[corners]
            else:
                report.lost("UV layer %s that is not there" % need[1], where)
        elif need[0] in ("attribute", "parameter"):
            name = need[1] if need[0] == "attribute" else need[3]
            found = attribute_values(me, name, None, None) or vertex_group(obj, me, name)
            if found is None and name in layers:
                uv = taken(layers[name].data, "uv", 2)
                found = np.concatenate([uv, np.zeros((len(uv), 1), np.float32)], 1), "corner"
            if found is None:
                report.lost("Attribute %s that is not there" % (name or "(active colour)"), where)
                continue
            values, domain = found
            if domain == "point":
                values = values[out.points]
            else:
                values = values[corners] if domain == "corner" else values[faces]
            if need[0] == "attribute":
                out.variables["facevarying color bl_at_" + identifier(name)] = values
            else:
                width = 1 if need[2] == "float" else 3
                out.variables["facevarying %s %s" % (need[2], need[1])] = values[:, :width]
    if "generated" in needs:
        out.variables["vertex color bl_generated"] = undeformed(me, co)


def creases(me):
    """Tags of SubdivisionMesh: sharp edges as OpenSubdiv counts them (Blender's 0 to 1, squared times 10)."""
    if "crease_edge" in me.attributes:
        c = taken(me.attributes["crease_edge"].data, "value", 1)
    else:
        try:
            c = taken(me.edges, "crease", 1)
        except (AttributeError, TypeError):
            return [], [], [], []
    sharp = np.nonzero(c > 0)[0]
    ends = taken(me.edges, "vertices", 2, np.int32)[sharp]
    count = len(sharp)
    return (["crease"] * count, [2, 1] * count, ends.ravel().tolist(), (c[sharp] ** 2 * 10).tolist())


def write_mesh(rib, mesh, material, times, tags=None):
    """One primitive: the faces with this index of a material."""
    if mesh.subdivision is not None:
        names, counts, ints, floats = tags
        names, counts = ["interpolateboundary"] + names, [1, 0] + counts
        values = {"P": mesh.P[0], **mesh.variables}
        moved(
            rib,
            mesh.P,
            times,
            lambda P: rib.request(
                "SubdivisionMesh",
                "catmull-clark",
                mesh.subdivision,
                mesh.points,
                names,
                counts,
                [2] + ints,
                floats,
                dict(values, P=P),
            ),
        )
        return
    chosen = mesh.materials == material
    if not chosen.any():
        return
    of_corner = np.repeat(chosen, 3)
    used, points = np.unique(mesh.points[of_corner], return_inverse=True)
    values = {}
    for name, v in mesh.variables.items():
        values[name] = v[used] if name.startswith("vertex") else v[of_corner]
    counts = np.full(len(points) // 3, 3, np.int32)
    moved(rib, [P[used] for P in mesh.P], times, lambda P: rib.request("PointsPolygons", counts, points, {"P": P, **values}))


def moved(rib, P, times, write):
    """A primitive whose points are elsewhere at each time. P: arrays, one or as many as times."""
    if len(P) == 1 or all(np.array_equal(P[0], p) for p in P[1:]):
        write(P[0])
        return
    rib.request("MotionBegin", list(times))
    for p in P:
        write(p)
    rib.request("MotionEnd")

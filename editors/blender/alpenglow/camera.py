"""The camera: what of a picture it takes, where it stands, its lens."""
import math

from mathutils import Matrix

from . import rib as ribs

FLIP = Matrix.Diagonal((1, 1, -1, 1))  # Blender looks along -z, RIB along +z


def placed(camera):
    """From the world to the camera, as RIB has it. camera: the evaluated object."""
    return from_eye(camera.matrix_world)


def from_eye(eye):
    """The same of the matrix of an eye that looks along -z."""
    return ribs.matrix(FLIP @ eye.normalized().inverted_safe())


def write_view(rib, view):
    """A viewport's projection. view: as viewport.view_camera() gives it. Returns parameters for the hider."""
    _, screen, perspective, clipping = view
    rib.request("Projection", "perspective" if perspective else "orthographic", {"float fov": 90.0} if perspective else {})
    rib.request("ScreenWindow", *screen)
    rib.request("Clipping", max(clipping[0], 1e-6), clipping[1])
    return {}


def window(camera, scene):
    """ScreenWindow: left, right, bottom, top of the picture; perspective: at distance 1."""
    corners = camera.data.view_frame(scene=scene)
    scale = 1.0 if camera.data.type == "ORTHO" else -corners[0].z
    xs, ys = [v.x / scale for v in corners], [v.y / scale for v in corners]
    return [min(xs), max(xs), min(ys), max(ys)]


def focus_distance(camera):
    dof = camera.data.dof
    if dof.focus_object is None:
        return dof.focus_distance
    place = dof.focus_object.matrix_world.translation
    return abs((camera.matrix_world.normalized().inverted_safe() @ place).z)


def write(rib, camera, scene, report):
    """Projection, window, clipping and lens; the place comes from placed(). Returns parameters for the hider."""
    data, hider = camera.data, {}
    if data.type == "PANO":
        report.lost("Panoramic cameras (perspective is taken)", camera.name)
    if data.type == "ORTHO":
        rib.request("Projection", "orthographic")
    else:
        rib.request("Projection", "perspective", {"float fov": 90.0})
    rib.request("ScreenWindow", *window(camera, scene))
    rib.request("Clipping", max(data.clip_start, 1e-6), data.clip_end)
    if data.dof.use_dof and data.dof.aperture_fstop > 0:
        if data.type == "ORTHO":
            report.lost("Depth of field of orthographic cameras", camera.name)
        else:
            # the lens in scene units: Blender's millimetres are thousandths of a unit
            rib.request("DepthOfField", data.dof.aperture_fstop, data.lens * 1e-3, max(focus_distance(camera), 1e-4))
            if data.dof.aperture_blades >= 3:
                hider["float[4] aperture"] = [data.dof.aperture_blades, math.degrees(data.dof.aperture_rotation), 0, 0]
            if abs(data.dof.aperture_ratio - 1) > 1e-4:
                report.lost("Anamorphic bokeh (aperture ratio)", camera.name)
    return hider

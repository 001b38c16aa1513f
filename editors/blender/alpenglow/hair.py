"""Particle hair and hair curves as Curves."""
import numpy as np

from .geometry import moved, taken

RANDOM = np.random.RandomState


class Strands:
    """P: [points at each time]; counts: points of each strand; widths: diameters by point; values: other variables of
    strands."""

    def __init__(self, P, counts, widths, values=None):
        self.P, self.counts, self.widths, self.values = [P], counts, widths, values or {}


def particle_width(settings, time):
    """Radius along a strand (time 0 to 1), as Cycles has it."""
    shape, t = settings.shape, 1 - np.asarray(time)
    if shape != 0:
        t = np.power(t, 1 + shape if shape < 0 else 1 / max(1 - shape, 1e-6))
    root, tip = settings.root_radius, settings.tip_radius
    radius = (t * (root - tip) + tip) * settings.radius_scale * 0.5
    if settings.use_close_tip and len(radius):
        radius[-1] = 0
    return radius


def particles(obj, system, modifier, world, report):
    """Strands of a hair system in the object's own space, None for others. world: matrix of the object."""
    settings = system.settings
    if settings.type != "HAIR" or settings.render_type != "PATH":
        return None
    steps = 2**settings.render_step + 1
    if settings.kink == "SPIRAL":
        steps += settings.kink_extra_steps
    parents, children = len(system.particles), len(system.child_particles)
    first = 0 if children == 0 or settings.use_parent_particles else parents
    back = np.array(world.inverted_safe(), np.float64)
    points, counts, widths, roots = [], [], [], []
    has_uv = obj.type == "MESH" and len(obj.data.uv_layers) > 0
    for i in range(first, parents + children):
        strand = [system.co_hair(obj, particle_no=i, step=k) for k in range(steps)]
        strand = np.array(strand, np.float64)
        keep = np.concatenate([[True], np.linalg.norm(np.diff(strand, axis=0), axis=1) > 1e-9])
        strand = strand[keep]
        if len(strand) < 2:
            continue
        points.append(strand)
        counts.append(len(strand))
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(strand, axis=0), axis=1))])
        widths.append(2 * particle_width(settings, along / along[-1]))
        if has_uv:
            p = system.particles[min(i, parents - 1)] if parents else None
            try:
                roots.append(tuple(system.uv_on_emitter(modifier, particle=p, particle_no=i, uv_no=0)))
            except (RuntimeError, TypeError):
                has_uv = False
    if not points:
        return None
    P = np.concatenate(points) @ back[:3, :3].T + back[:3, 3]
    values = {"uniform float[2] st": np.array(roots, np.float32)} if has_uv and len(roots) == len(counts) else {}
    return Strands(P.astype(np.float32), np.array(counts, np.int32), np.concatenate(widths).astype(np.float32), values)


def hair_curves(data):
    """Strands of a hair Curves object's evaluated data."""
    P = taken(data.points, "position", 3)
    first = taken(data.curves, "first_point_index", 1, np.int32)
    counts = np.diff(np.concatenate([first, [len(P)]])).astype(np.int32)
    radius = data.attributes.get("radius")
    widths = 2 * taken(radius.data, "value", 1) if radius is not None else np.full(len(P), 0.01, np.float32)
    return Strands(P, counts, widths, {})


def write(rib, strands, times, random):
    """Curves through the points (Catmull and Rom), whose first and last count twice, as in Cycles. random: whether shaders ask
    for it."""
    chosen = strands.counts >= 2
    if not chosen.any():
        return
    starts = np.concatenate([[0], np.cumsum(strands.counts)[:-1]])
    order, counts = [], []
    for start, count in zip(starts[chosen].tolist(), strands.counts[chosen].tolist()):
        order.extend([start] + list(range(start, start + count)) + [start + count - 1])
        counts.append(count + 2)
    order = np.array(order, np.int64)
    # widths are varying: one at the ends of segments, which are the strand's own points
    own = np.repeat(chosen, strands.counts)
    values = {"varying float width": strands.widths[own]}
    for name, v in strands.values.items():
        values[name] = v[chosen]
    if random:
        values["uniform float bl_random"] = RANDOM(0).random_sample(len(counts)).astype(np.float32)
    rib.request("Attribute", "dice", {"int roundcurve": 1})
    rib.request("Attribute", "user", {"float blstrand": 1})
    rib.request("Basis", "catmull-rom", 1, "catmull-rom", 1)
    moved(
        rib,
        [P[order] for P in strands.P],
        times,
        lambda P: rib.request("Curves", "cubic", np.array(counts, np.int32), "nonperiodic", {"P": P, **values}),
    )

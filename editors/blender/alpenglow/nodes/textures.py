"""Texture nodes."""
import math

from mathutils import Euler, Matrix

from ..compiler import Value, constant, node
from . import inputs


def place(c, n, default="generated"):
    """Where a texture is looked up: a variable. Texture mappings that nodes keep from old files are applied."""
    if c.linked(n, "Vector"):
        code = c.input(n, "Vector", "vector")
    else:
        code = (inputs.uv(c) if default == "uv" else inputs.generated(c)).code
    m = getattr(n, "texture_mapping", None)
    if m is not None:
        if (
            m.vector_type not in ("POINT", "TEXTURE")
            or (m.mapping_x, m.mapping_y, m.mapping_z) != ("X", "Y", "Z")
            or m.use_min
            or m.use_max
        ):
            c.lost("Texture Mapping of a node in its sidebar")
        t = Matrix.LocRotScale(m.translation, Euler(m.rotation), m.scale)
        if m.vector_type == "TEXTURE":
            t = t.inverted_safe()
        if any(abs(t[i][k] - (i == k)) > 1e-7 for i in range(3) for k in range(4)):
            w = c.name_of("vector", code)
            code = "vector(%s)" % ", ".join(
                " + ".join(["(%.9g) * %scomp(%s)" % (t[i][k], "xyz"[k], w) for k in range(3)] + ["(%.9g)" % t[i][3]])
                for i in range(3)
            )
    return c.name_of("vector", code)


def looked_up(c, n, image, s, t):
    """texture() of an image, as light or as numbers, whichever the image says."""
    path, coded = c.images.file(image, c.where)
    if path is None:
        return Value("color", "color(1, 0, 1)"), None
    wide = ', "filter", "box", "width", 0' if n.interpolation == "Closest" else ""
    name = '"%s"' % path.replace("\\", "/").replace('"', '\\"')
    code = "color texture(%s, %s, 1 - (%s)%s)" % (name, s, t, wide)
    space, as_srgb = image.colorspace_settings.name, coded == "srgb"
    raw = space in ("Non-Color", "Raw", "Linear", "Linear Rec.709", "Linear BT.709", "scene_linear", "Non-Colour Data")
    if not raw and space != "sRGB":
        c.lost("Colour space %s of an image" % space)
    if raw and as_srgb:
        code = "blEncode(%s)" % code
    elif not raw and not as_srgb:
        code = "blDecode(%s)" % code
    return c.let("color", code), name


@node("ShaderNodeTexImage")
def image(c, n, out):
    if n.image is None:
        return constant("color", (1, 0, 1)) if out.name == "Color" else constant("float", 1.0)
    p, alpha = place(c, n, "uv"), out.name == "Alpha"
    if n.image.source in ("SEQUENCE", "MOVIE", "TILED"):
        c.lost({"SEQUENCE": "Image sequences", "MOVIE": "Movies as textures", "TILED": "UDIM tiles"}[n.image.source])
    if n.projection == "BOX":
        w = c.name_of("vector", 'normalize(vector(ntransform("object", N)))')
        c.lost("Blending of Box projection (the nearest side is taken)")
        s = "((abs(xcomp({w})) > max(abs(ycomp({w})), abs(zcomp({w})))) ? ycomp({p}) : xcomp({p}))".format(w=w, p=p)
        t = "((abs(zcomp({w})) >= max(abs(xcomp({w})), abs(ycomp({w})))) ? ycomp({p}) : zcomp({p}))".format(w=w, p=p)
    elif n.projection in ("SPHERE", "TUBE"):
        q = c.name_of("vector", "2 * %s - vector(1, 1, 1)" % p)
        s = "(.5 - atan(xcomp(%s), ycomp(%s)) / (2 * PI))" % (q, q)
        t = "((zcomp(%s) + 1) / 2)" % q if n.projection == "TUBE" else "(1 - acos(clamp(zcomp(normalize(%s)), -1, 1)) / PI)" % q
    else:
        s, t = "xcomp(%s)" % p, "ycomp(%s)" % p
    s, t = c.name_of("float", s), c.name_of("float", t)
    outside = None
    if n.extension == "REPEAT":
        s, t = c.name_of("float", "mod(%s, 1)" % s), c.name_of("float", "mod(%s, 1)" % t)
    if n.extension == "EXTEND":
        s, t = c.name_of("float", "clamp(%s, 0, 1)" % s), c.name_of("float", "clamp(%s, 0, 1)" % t)
    elif n.extension == "CLIP":
        outside = "((%s < 0 || %s > 1 || %s < 0 || %s > 1) ? 0 : 1)" % (s, s, t, t)
    elif n.extension == "MIRROR":
        s, t = (c.name_of("float", "1 - abs(mod(%s, 2) - 1)" % x) for x in (s, t))
    value, name = looked_up(c, n, n.image, s, t)
    if alpha:
        if (
            name is None
            or n.image.alpha_mode == "NONE"
            or n.image.channels not in (2, 4)
            and n.image.depth not in (16, 32, 64, 128)
        ):
            value = constant("float", 1.0)
        else:
            value = c.let("float", 'float texture(%s[3], %s, 1 - (%s), "fill", 1)' % (name, s, t))
    return value if outside is None else c.let(value.kind, "%s * %s" % (outside, value.code))


@node("ShaderNodeTexEnvironment")
def environment(c, n, out):
    if n.image is None:
        return constant("color", (1, 0, 1))
    if c.linked(n, "Vector") or c.kind == "light":
        d = c.name_of("vector", "normalize(%s)" % place(c, n))
    else:
        d = c.name_of("vector", 'normalize(vector(transform("world", P)))')
    if n.projection == "MIRROR_BALL":
        b = c.name_of("vector", "%s - vector(0, 1, 0)" % d)
        k = c.name_of("float", "2 * sqrt(max(-.5 * ycomp(%s), 0))" % b)
        s, t = "(.5 + .5 * blSafeDivide(xcomp(%s), %s))" % (b, k), "(.5 + .5 * blSafeDivide(zcomp(%s), %s))" % (b, k)
        return looked_up(c, n, n.image, c.name_of("float", s), c.name_of("float", t))[0]
    path, coded = c.images.file(n.image, c.where)
    if path is None:
        return constant("color", (1, 0, 1))
    # environment() has its poles on z, Blender's s falls as the angle from x to y grows
    code = 'color environment("%s", %s)' % (path.replace("\\", "/"), ENVIRONMENT % (d, d, d))
    if n.image.colorspace_settings.name == "Non-Color" and coded == "srgb":
        code = "blEncode(%s)" % code
    return c.let("color", code)


ENVIRONMENT = "vector(-xcomp(%s), ycomp(%s), zcomp(%s))"


@node("ShaderNodeTexSky")
def sky(c, n, out):
    c.lost("Sky Texture (an even sky of its mean colour)")
    return constant("color", (0.25, 0.35, 0.55))


@node("ShaderNodeTexChecker")
def checker(c, n, out):
    f = c.let("float", "blChecker(%s * %s)" % (c.input(n, "Scale", "float"), place(c, n)))
    if out.name != "Color":
        return f
    return c.let("color", "mix(%s, %s, color(%s))" % (c.input(n, "Color2", "color"), c.input(n, "Color1", "color"), f.code))


def four(c, n):
    """The fourth coordinate and how many there are."""
    size = (
        getattr(n, "noise_dimensions", None)
        or getattr(n, "voronoi_dimensions", None)
        or getattr(n, "musgrave_dimensions", "3D")
    )
    return (c.input(n, "W", "float") if size in ("1D", "4D") else "0"), size[0]


@node("ShaderNodeTexNoise")
def noise(c, n, out):
    if getattr(n, "noise_type", "FBM") != "FBM":
        c.lost("Noise Texture of type %s" % n.noise_type.title())
    w, size = four(c, n)
    rest = ", ".join(
        [place(c, n), w, size]
        + [
            c.input(n, k, "float", d)
            for k, d in (("Scale", 5.0), ("Detail", 2.0), ("Roughness", 0.5), ("Lacunarity", 2.0), ("Distortion", 0.0))
        ]
    )
    if out.name == "Color":
        return c.let("color", "blNoiseColor(%s)" % rest)
    return c.let("float", "blNoise(%s)" % rest)


@node("ShaderNodeTexMusgrave")
def musgrave(c, n, out):
    if n.musgrave_type != "FBM":
        c.lost("Musgrave Texture of type %s (fBM is taken)" % n.musgrave_type.replace("_", " ").title())
    w, size = four(c, n)
    roughness = "pow(%s, -(%s))" % (c.input(n, "Lacunarity", "float", 2.0), c.input(n, "Dimension", "float", 2.0))
    octaves = c.name_of("float", "max(%s - 1, 0)" % c.input(n, "Detail", "float", 2.0))
    r = c.name_of("float", "clamp(%s, 0, 1)" % roughness)
    most = "((%s == 1) ? %s + 1 : (1 - pow(%s, %s + 1)) / (1 - %s))" % (r, octaves, r, octaves, r)
    return c.let(
        "float",
        "(2 * blNoise(%s, %s, %s, %s, %s, %s, %s, 0) - 1) * %s"
        % (place(c, n), w, size, c.input(n, "Scale", "float", 5.0), octaves, r, c.input(n, "Lacunarity", "float", 2.0), most),
    )


@node("ShaderNodeTexVoronoi")
def voronoi(c, n, out):
    features = {"F1": 0, "F2": 1, "DISTANCE_TO_EDGE": 2}
    metrics = {"EUCLIDEAN": 0, "MANHATTAN": 1, "CHEBYCHEV": 2}
    if n.feature not in features:
        c.lost("Voronoi Texture %s (F1 is taken)" % n.feature.replace("_", " ").title())
    if n.distance not in metrics or n.voronoi_dimensions not in ("2D", "3D"):
        c.lost("Voronoi Texture by %s in %s" % (n.distance.title(), n.voronoi_dimensions))
    if c.fixed(n, "Detail", 0.0) not in (0, 0.0):
        c.lost("Fractal Voronoi Texture (one layer is taken)")
    d, colour, at = c.call(
        "blVoronoi",
        ("float", "color", "vector"),
        place(c, n),
        n.voronoi_dimensions[0],
        c.input(n, "Scale", "float", 5.0),
        "clamp(%s, 0, 1)" % c.input(n, "Randomness", "float", 1.0),
        str(features.get(n.feature, 0)),
        str(metrics.get(n.distance, 0)),
    )
    return {"Distance": Value("float", d), "Color": Value("color", colour), "Position": Value("vector", at)}.get(
        out.name
    ) or c.nothing(out)


@node("ShaderNodeTexWave")
def wave(c, n, out):
    rings = n.wave_type == "RINGS"
    axis = {"X": 0, "Y": 1, "Z": 2}.get(n.rings_direction if rings else n.bands_direction, 3)
    rest = [
        c.input(n, k, "float", d)
        for k, d in (
            ("Scale", 5.0),
            ("Distortion", 0.0),
            ("Detail", 2.0),
            ("Detail Scale", 1.0),
            ("Detail Roughness", 0.5),
            ("Phase Offset", 0.0),
        )
    ]
    profile = {"SIN": 0, "SAW": 1, "TRI": 2}[n.wave_profile]
    f = c.let("float", "blWave(%s, %d, %d, %d, %s)" % (place(c, n), rings, axis, profile, ", ".join(rest)))
    return c.convert(f, "color") if out.name == "Color" else f


@node("ShaderNodeTexGradient")
def gradient(c, n, out):
    kinds = ["LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "SPHERICAL", "QUADRATIC_SPHERE"]
    f = c.let("float", "blGradient(%s, %d)" % (place(c, n), kinds.index(n.gradient_type)))
    return c.convert(f, "color") if out.name == "Color" else f


@node("ShaderNodeTexMagic")
def magic(c, n, out):
    colour = c.let(
        "color",
        "blMagic(%s, %s, %s, %d)"
        % (place(c, n), c.input(n, "Scale", "float"), c.input(n, "Distortion", "float"), n.turbulence_depth),
    )
    return colour if out.name == "Color" else c.convert(c.convert(colour, "vector"), "float")


@node("ShaderNodeTexBrick")
def brick(c, n, out):
    sizes = [c.input(n, k, "float") for k in ("Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")]
    rest = [str(x) for x in (n.offset, n.offset_frequency, n.squash, n.squash_frequency)]
    tint, mortar = c.call("blBrick", ("float", "float"), place(c, n), *sizes, *rest)
    if out.name != "Color":
        return Value("float", mortar)
    a, b, m = (c.input(n, k, "color") for k in ("Color1", "Color2", "Mortar"))
    return c.let("color", "mix(mix(%s, %s, color(%s)), %s, color(%s))" % (a, b, tint, m, mortar))


@node("ShaderNodeTexWhiteNoise")
def white_noise(c, n, out):
    w, _ = four(c, n)
    kind = "color" if out.name == "Color" else "float"
    p = c.name_of("vector", c.input(n, "Vector", "vector") if c.linked(n, "Vector") else "vector(0, 0, 0)")
    return c.let(
        kind,
        "%s cellnoise(point(xcomp(%s) * 7919.3, ycomp(%s) * 7919.3, zcomp(%s) * 7919.3), (%s) * 7919.3)" % (kind, p, p, p, w),
    )


__all__ = ["math"]

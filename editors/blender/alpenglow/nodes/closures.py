"""Shader nodes: what they reflect is a call of shaders/closures.h."""
import bpy

from ..compiler import Value, node
from .inputs import normal_of


def closure(c, light, through="color(0)"):
    return Value("closure", (c.name_of("color", light), through))


def tangent_of(c, n):
    if c.linked(n, "Tangent"):
        return 'vtransform("world", "current", %s)' % c.input(n, "Tangent", "vector")
    return "dPdu"


@node("ShaderNodeBsdfDiffuse")
def diffuse(c, n, out):
    return closure(
        c, "%s * blDiffuse(%s, %s)" % (c.input(n, "Color", "color"), normal_of(c, n), c.input(n, "Roughness", "float"))
    )


@node("ShaderNodeBsdfTranslucent")
def translucent(c, n, out):
    return closure(c, "%s * blTranslucent(%s)" % (c.input(n, "Color", "color"), normal_of(c, n)))


def rough(c, n):
    return "0" if getattr(n, "distribution", "") == "SHARP" else "clamp(%s, 0, 1)" % c.input(n, "Roughness", "float")


def facets(n):
    """1 where light lost between facets is given back, and the distribution of trace()."""
    kind = getattr(n, "distribution", "GGX")
    names = {"BECKMANN": "beckmann", "ASHIKHMIN_SHIRLEY": "ashikhmin-shirley"}
    return '%d, "%s"' % (kind == "MULTI_GGX", names.get(kind, "ggx"))


def ggx_alone(c, n):
    if getattr(n, "distribution", "") == "BECKMANN" and c.fixed(n, "Roughness") != 0:
        c.lost("Distribution Beckmann of glass (GGX is taken)")


@node("ShaderNodeBsdfGlossy", "ShaderNodeBsdfAnisotropic")
def glossy(c, n, out):
    return closure(
        c,
        "%s * blGlossy(%s, %s, %s, %s, %s, %s)"
        % (
            c.input(n, "Color", "color"),
            normal_of(c, n),
            tangent_of(c, n),
            rough(c, n),
            c.input(n, "Anisotropy", "float", 0.0),
            c.input(n, "Rotation", "float", 0.0),
            facets(n),
        ),
    )


@node("ShaderNodeBsdfGlass")
def glass(c, n, out):
    ggx_alone(c, n)
    mirrored, through = c.call(
        "blGlass", ("color", "color"), normal_of(c, n), "blSide", rough(c, n), c.input(n, "IOR", "float", 1.45)
    )
    return closure(c, "%s * (%s + %s)" % (c.input(n, "Color", "color"), mirrored, through))


@node("ShaderNodeBsdfRefraction")
def refraction(c, n, out):
    ggx_alone(c, n)
    return closure(
        c,
        "%s * blRefraction(%s, blSide, %s, %s)"
        % (c.input(n, "Color", "color"), normal_of(c, n), rough(c, n), c.input(n, "IOR", "float", 1.45)),
    )


@node("ShaderNodeBsdfTransparent")
def transparent(c, n, out):
    return Value("closure", ("color(0)", c.name_of("color", c.input(n, "Color", "color"))))


@node("ShaderNodeHoldout")
def holdout(c, n, out):
    c.lost("Holdout (black)")
    return Value("closure", ("color(0)", "color(0)"))


@node("ShaderNodeBsdfVelvet", "ShaderNodeBsdfSheen")
def velvet(c, n, out):
    return closure(
        c,
        "%s * blVelvet(%s, %s)"
        % (c.input(n, "Color", "color"), normal_of(c, n), c.input(n, ("Sigma", "Roughness"), "float", 0.5)),
    )


@node("ShaderNodeBsdfToon")
def toon(c, n, out):
    c.lost("Toon BSDF (Diffuse or Glossy BSDF is taken)")
    if n.component == "DIFFUSE":
        return closure(c, "%s * diffuse(%s)" % (c.input(n, "Color", "color"), normal_of(c, n)))
    return closure(
        c,
        '%s * blGlossy(%s, dPdu, %s, 0, 0, 0, "ggx")'
        % (c.input(n, "Color", "color"), normal_of(c, n), c.input(n, "Size", "float")),
    )


@node("ShaderNodeSubsurfaceScattering")
def subsurface(c, n, out):
    radius = "blToColor(%s)" % c.input(n, "Radius", "vector")
    return closure(
        c,
        "blSubsurface(%s, %s * %s, %s)"
        % (
            c.input(n, "Color", "color"),
            c.input(n, "Scale", "float"),
            radius,
            c.input(n, ("Anisotropy", "Subsurface Anisotropy"), "float", 0.0),
        ),
    )


def emitted(c, n, colour, strength):
    """Nothing, where an area light carries it."""
    if not c.emission:
        return "color(0)"
    return "%s * %s" % (c.input(n, strength, "float", 1.0), c.input(n, colour, "color", (0, 0, 0)))


@node("ShaderNodeEmission", "ShaderNodeBackground")
def emission(c, n, out):
    return closure(c, emitted(c, n, "Color", "Strength"))


@node("ShaderNodeEeveeSpecular")
def specular_bsdf(c, n, out):
    light = "%s * diffuse(%s)" % (c.input(n, "Base Color", "color"), normal_of(c, n))
    light += ' + %s * blGlossy(%s, dPdu, %s, 0, 0, 0, "ggx")' % (
        c.input(n, "Specular", "color"),
        normal_of(c, n),
        c.input(n, "Roughness", "float"),
    )
    return closure(c, light + " + %s" % emitted(c, n, "Emissive Color", "-"))


@node("ShaderNodeMixShader")
def mix_shader(c, n, out):
    a, b = n.inputs[1].identifier, n.inputs[2].identifier
    f = c.fixed(n, n.inputs[0].identifier)
    if f is not None and f <= 0:
        return c.value(n, a, "closure")
    if f is not None and f >= 1:
        return c.value(n, b, "closure")
    f = c.name_of("color", "color(clamp(%s, 0, 1))" % c.input(n, n.inputs[0].identifier, "float"))
    (la, ta), (lb, tb) = c.value(n, a, "closure").code, c.value(n, b, "closure").code
    return closure(c, "(color(1) - %s) * %s + %s * %s" % (f, la, f, lb), blend(c, f, ta, tb))


def blend(c, f, a, b):
    if a == b == "color(0)":
        return a
    return c.name_of("color", "(color(1) - %s) * %s + %s * %s" % (f, a, f, b))


@node("ShaderNodeAddShader")
def add_shader(c, n, out):
    (la, ta), (lb, tb) = (c.value(n, s.identifier, "closure").code for s in n.inputs)
    return closure(
        c,
        "%s + %s" % (la, lb),
        ta if tb == "color(0)" else tb if ta == "color(0)" else c.name_of("color", "%s + %s" % (ta, tb)),
    )


@node("ShaderNodeBsdfHairPrincipled")
def hair_principled(c, n, out):
    kind = n.parametrization
    rough_of = "clamp(%s, .05, 1)" % c.input(n, "Roughness", "float", 0.3)
    c.lost("Principled Hair BSDF's roughness, coat and random colours (trace()'s hair lobes have widths of their own)")
    if kind == "ABSORPTION":
        sigma = "blToColor(%s)" % c.input(n, "Absorption Coefficient", "vector", (0.2, 0.5, 1))
    elif kind == "MELANIN":
        m = c.name_of("float", "-log(max(1 - clamp(%s, 0, 1), .0001))" % c.input(n, "Melanin", "float", 0.8))
        red = c.name_of("float", "clamp(%s, 0, 1)" % c.input(n, "Melanin Redness", "float", 1.0))
        sigma = "(%s * (1 - %s) * color(.506, .841, 1.653) + %s * %s * color(.343, .733, 1.924))" % (m, red, m, red)
    else:  # Chiang et al. 2016, equation 9; the denominator at Blender's default roughness
        x = c.name_of("color", "clamp(%s, color(.0001), color(.9999))" % c.input(n, "Color", "color", (0.02, 0.01, 0.005)))
        parts = ["pow(log(comp(%s, %d)) / 4.86, 2)" % (x, i) for i in range(3)]
        sigma = "color(%s)" % ", ".join(parts)
    return closure(c, "blHair(normalize(dPdv), %s, %s, .3, 0, %s)" % (sigma, rough_of, c.input(n, "IOR", "float", 1.55)))


@node("ShaderNodeBsdfHair")
def hair(c, n, out):
    c.lost("Hair BSDF (Diffuse and Glossy BSDF are taken)")
    return closure(
        c,
        '%s * (.7 * diffuse(blN) + .3 * blGlossy(blN, dPdv, clamp(%s, 0, 1), 0, 0, 0, "ggx"))'
        % (c.input(n, "Color", "color"), c.input(n, "RoughnessU", "float", 0.1)),
    )


@node("ShaderNodeVolumeScatter", "ShaderNodeVolumeAbsorption", "ShaderNodeVolumePrincipled")
def volume(c, n, out):
    c.lost("A volume where a surface belongs")
    return Value("closure", ("color(0)", "color(0)"))


@node("ShaderNodeBsdfPrincipled")
def principled(c, n, out):
    """Where another surface is to take its place, this is the function to change: shaders/closures.h has both models."""

    def x(*names, default=0.0):
        return c.input(n, names, "float", default)

    normal = normal_of(c, n)
    coat = normal_of(c, n, ("Clearcoat Normal", "Coat Normal"))
    radius = "blToColor(%s)" % c.input(n, "Subsurface Radius", "vector", (1, 0.2, 0.1))
    base = c.name_of("color", "clamp(%s, color(0), color(1))" % c.input(n, "Base Color", "color"))
    common = [normal, coat, tangent_of(c, n), "blSide", base]
    if bpy.app.version < (4, 0, 0):
        if n.subsurface_method != "RANDOM_WALK" and c.fixed(n, "Subsurface", 0.0) != 0:
            c.lost("Subsurface method %s (Random Walk is taken)" % n.subsurface_method.replace("_", " ").title())
        rest = [
            x("Subsurface"),
            radius,
            c.input(n, "Subsurface Color", "color", (0.8, 0.8, 0.8)),
            x("Metallic"),
            x("Specular", default=0.5),
            x("Specular Tint"),
            x("Roughness", default=0.5),
            x("Anisotropic"),
            x("Anisotropic Rotation"),
            x("Sheen"),
            x("Sheen Tint"),
            x("Clearcoat"),
            x("Clearcoat Roughness", default=0.03),
            x("IOR", default=1.45),
            x("Transmission"),
            x("Transmission Roughness"),
        ]
        light = "blPrincipled3(%s)" % ", ".join(common + rest)
    else:
        rest = [
            x("Subsurface Weight"),
            "%s * %s" % (x("Subsurface Scale", default=0.05), radius),
            x("Metallic"),
            x("Specular IOR Level", default=0.5),
            c.input(n, "Specular Tint", "color", (1, 1, 1)),
            x("Roughness", default=0.5),
            x("Anisotropic"),
            x("Anisotropic Rotation"),
            x("Sheen Weight"),
            x("Sheen Roughness", default=0.5),
            c.input(n, "Sheen Tint", "color", (1, 1, 1)),
            x("Coat Weight"),
            x("Coat Roughness", default=0.03),
            x("Coat IOR", default=1.5),
            c.input(n, "Coat Tint", "color", (1, 1, 1)),
            x("IOR", default=1.5),
            x("Transmission Weight"),
            x("Diffuse Roughness"),
        ]
        if c.fixed(n, "Thin Film Thickness", 0.0) not in (0, 0.0):
            c.lost("Thin film of Principled BSDF")
        light = "blPrincipled4(%s)" % ", ".join(common + rest)
    light = "%s + %s" % (light, emitted(c, n, ("Emission", "Emission Color"), "Emission Strength"))
    alpha = c.fixed(n, "Alpha", 1.0)
    if alpha is not None and alpha >= 1:
        return closure(c, light)
    opaque = c.name_of("float", "clamp(%s, 0, 1)" % x("Alpha", default=1.0))
    return closure(c, "%s * (%s)" % (opaque, light), c.name_of("color", "color(1 - %s)" % opaque))

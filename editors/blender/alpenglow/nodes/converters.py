"""Colour and converter nodes."""
import math

from ..compiler import Value, constant, literal, node

BLEND = {
    "ADD": "({a} + {f} * {b})",
    "MULTIPLY": "({a} * (1 - {f} + {f} * {b}))",
    "SUBTRACT": "({a} - {f} * {b})",
    "SCREEN": "(color(1) - (1 - {f} + {f} * (color(1) - {b})) * (color(1) - {a}))",
    "DIFFERENCE": "mix({a}, max({a}, {b}) - min({a}, {b}), {f})",
    "EXCLUSION": "max(mix({a}, {a} + {b} - 2 * {a} * {b}, {f}), color(0))",
    "DARKEN": "mix({a}, min({a}, {b}), {f})",
    "LIGHTEN": "mix({a}, max({a}, {b}), {f})",
    "OVERLAY": "blOverlay({f}, {a}, {b})",
    "DIVIDE": "blDivide({f}, {a}, {b})",
    "DODGE": "blDodge({f}, {a}, {b})",
    "BURN": "blBurn({f}, {a}, {b})",
    "HUE": "blOfHsv(comp({f}, 0), 0, {a}, {b})",
    "SATURATION": "blOfHsv(comp({f}, 0), 1, {a}, {b})",
    "VALUE": "blOfHsv(comp({f}, 0), 2, {a}, {b})",
    "COLOR": "blOfHsv(comp({f}, 0), 3, {a}, {b})",
    "SOFT_LIGHT": "((1 - {f}) * {a} + {f} * ((color(1) - {a}) * {b} * {a} +"
    " {a} * (color(1) - (color(1) - {b}) * (color(1) - {a}))))",
    "LINEAR_LIGHT": "({a} + {f} * (2 * {b} - color(1)))",
}


def mixed(c, blend, f, a, b):
    """Two colours (texts) by a mode; f: a float text."""
    if blend == "MIX":
        return c.let("color", "mix(%s, %s, color(%s))" % (a, b, f))
    if blend not in BLEND:
        c.lost("Mix mode %s" % blend.title())
        return c.let("color", "mix(%s, %s, color(%s))" % (a, b, f))
    names = {"f": c.name_of("color", "color(%s)" % f), "a": c.name_of("color", a), "b": c.name_of("color", b)}
    return c.let("color", BLEND[blend].format(**names))


def held(c, value, clamp):
    return c.let("color", "clamp(%s, color(0), color(1))" % value.code) if clamp else value


@node("ShaderNodeMixRGB")
def mix_rgb(c, n, out):
    f = "clamp(%s, 0, 1)" % c.input(n, "Fac", "float")
    return held(c, mixed(c, n.blend_type, f, c.input(n, "Color1", "color"), c.input(n, "Color2", "color")), n.use_clamp)


@node("ShaderNodeMix")
def mix(c, n, out):
    kind = {"FLOAT": "float", "VECTOR": "vector", "RGBA": "color"}.get(n.data_type)
    if kind is None:
        c.lost("Mix of %s" % n.data_type.lower())
        kind = "vector"
    inputs = [s for s in n.inputs if s.enabled]
    even = not (kind == "vector" and n.factor_mode == "NON_UNIFORM")
    f = c.input(n, inputs[0].identifier, "float" if even else "vector")
    a, b = (c.input(n, s.identifier, kind) for s in inputs[1:3])
    if n.clamp_factor:
        f = "clamp(%s, 0, 1)" % f if even else "clamp(%s, vector(0), vector(1))" % f
    if kind == "color":
        return held(c, mixed(c, n.blend_type, f, a, b), n.clamp_result)
    if kind == "float":
        return c.let("float", "mix(%s, %s, %s)" % (a, b, f))
    f, a, b = (c.name_of("vector", "vector(%s)" % x) for x in (f, a, b))
    return c.let(
        "vector", "vector(%s)" % ", ".join("mix(%scomp(%s), %scomp(%s), %scomp(%s))" % (k, a, k, b, k, f) for k in "xyz")
    )


@node("ShaderNodeHueSaturation")
def hue_saturation(c, n, out):
    names = ("Hue", "Saturation", "Value", "Fac")
    return c.let(
        "color", "blHueSaturation(%s, %s)" % (", ".join(c.input(n, x, "float") for x in names), c.input(n, "Color", "color"))
    )


@node("ShaderNodeInvert")
def invert(c, n, out):
    colour = c.name_of("color", c.input(n, "Color", "color"))
    return c.let("color", "mix(%s, color(1) - %s, color(%s))" % (colour, colour, c.input(n, "Fac", "float")))


@node("ShaderNodeGamma")
def gamma(c, n, out):
    return c.let("color", "blGamma(%s, %s)" % (c.input(n, "Color", "color"), c.input(n, "Gamma", "float")))


@node("ShaderNodeBrightContrast")
def bright_contrast(c, n, out):
    return c.let(
        "color",
        "blContrast(%s, %s, %s)"
        % (c.input(n, "Color", "color"), c.input(n, "Bright", "float"), c.input(n, "Contrast", "float")),
    )


@node("ShaderNodeRGBToBW")
def rgb_to_bw(c, n, out):
    return c.convert(c.value(n, "Color", "color"), "float")


@node("ShaderNodeLightFalloff")
def light_falloff(c, n, out):
    if out.name != "Quadratic":
        c.lost("Light Falloff %s" % out.name)
    return c.value(n, "Strength", "float")


def table(c, colours, f):
    """A colour between the entries of a table, by f from 0 to 1."""
    last = len(colours) - 1
    c.count += 1
    name = "table%d" % c.count
    c.say(
        "uniform color %s[%d] = {%s};"
        % (name, len(colours), ", ".join("color(%.7g, %.7g, %.7g)" % tuple(x[:3]) for x in colours))
    )
    at = c.name_of("float", "clamp(%s, 0, 1) * %d" % (f, last))
    i = c.name_of("float", "min(floor(%s), %d)" % (at, last - 1))
    return c.let("color", "mix(%s[%s], %s[%s + 1], color(%s - %s))" % (name, i, name, i, at, i))


@node("ShaderNodeValToRGB")
def color_ramp(c, n, out):
    ramp, f = n.color_ramp, c.name_of("float", c.input(n, "Fac", "float"))
    alpha = out.name == "Alpha"
    stops = [(e.position, (e.color[3],) * 3 if alpha else tuple(e.color)[:3]) for e in ramp.elements]
    if ramp.color_mode == "RGB" and ramp.interpolation in ("LINEAR", "CONSTANT") and len(stops) <= 16:
        code = constant("color", stops[0][1]).code
        for (p0, _), (p1, colour) in zip(stops, stops[1:]):
            if ramp.interpolation == "CONSTANT":
                step = "((%s < %.7g) ? 0 : 1)" % (f, p1)
            else:
                step = "clamp((%s - %.7g) / %.7g, 0, 1)" % (f, p0, max(p1 - p0, 1e-6))
            code = c.name_of("color", "mix(%s, %s, color(%s))" % (code, constant("color", colour).code, step))
        value = Value("color", code)
    else:
        entries = [ramp.evaluate(i / 256) for i in range(257)]
        value = table(c, [(e[3],) * 3 if alpha else e for e in entries], f)
    return Value("float", "comp(%s, 0)" % value.code) if alpha else value


def curves_table(mapping, count):
    mapping.initialize()
    return [[mapping.evaluate(mapping.curves[k], i / (count - 1)) for k in range(len(mapping.curves))] for i in range(count)]


@node("ShaderNodeRGBCurve")
def rgb_curve(c, n, out):
    rows = curves_table(n.mapping, 65)
    whole = [[n.mapping.evaluate(n.mapping.curves[k], row[3]) for k in range(3)] for row in rows]
    colour = c.name_of("color", c.input(n, "Color", "color"))
    parts = [table(c, whole, "comp(%s, %d)" % (colour, k)).code for k in range(3)]
    return c.let(
        "color",
        "mix(%s, color(comp(%s, 0), comp(%s, 1), comp(%s, 2)), color(%s))" % (colour, *parts, c.input(n, "Fac", "float")),
    )


@node("ShaderNodeFloatCurve")
def float_curve(c, n, out):
    rows = curves_table(n.mapping, 65)
    x = c.name_of("float", c.input(n, "Value", "float"))
    return c.let(
        "float", "mix(%s, comp(%s, 0), %s)" % (x, table(c, [(r[0],) * 3 for r in rows], x).code, c.input(n, "Factor", "float"))
    )


@node("ShaderNodeCombineRGB", "ShaderNodeCombineHSV", "ShaderNodeCombineXYZ", "ShaderNodeCombineColor")
def combine(c, n, out):
    parts = ", ".join(c.input(n, s.identifier, "float") for s in n.inputs)
    if n.bl_idname == "ShaderNodeCombineXYZ":
        return c.let("vector", "vector(%s)" % parts)
    mode = getattr(n, "mode", "HSV" if "HSV" in n.bl_idname else "RGB")
    if mode == "HSL":
        return c.let("color", 'ctransform("hsl", "rgb", color(%s))' % parts)
    return c.let("color", "blRgb(color(%s))" % parts if mode == "HSV" else "color(%s)" % parts)


@node("ShaderNodeSeparateRGB", "ShaderNodeSeparateHSV", "ShaderNodeSeparateXYZ", "ShaderNodeSeparateColor")
def separate(c, n, out):
    i = list(n.outputs).index(out)
    if n.bl_idname == "ShaderNodeSeparateXYZ":
        return Value("float", "%scomp(%s)" % ("xyz"[i], c.name_of("vector", c.input(n, "Vector", "vector"))))
    colour = c.input(n, n.inputs[0].identifier, "color")
    mode = getattr(n, "mode", "HSV" if "HSV" in n.bl_idname else "RGB")
    if mode != "RGB":
        colour = 'ctransform("rgb", "%s", %s)' % (mode.lower(), colour)
    return Value("float", "comp(%s, %d)" % (c.name_of("color", colour), i))


@node("ShaderNodeClamp")
def clamp(c, n, out):
    x, low, high = (c.input(n, k, "float") for k in ("Value", "Min", "Max"))
    if n.clamp_type == "RANGE":
        low, high = "min(%s, %s)" % (low, high), "max(%s, %s)" % (low, high)
    return c.let("float", "clamp(%s, %s, %s)" % (x, low, high))


@node("ShaderNodeMapRange")
def map_range(c, n, out):
    if getattr(n, "data_type", "FLOAT") == "FLOAT_VECTOR":
        c.lost("Map Range of vectors")
        return c.value(n, "Vector", "vector")
    x, a, b, to_a, to_b = (
        c.name_of("float", c.input(n, k, "float")) for k in ("Value", "From Min", "From Max", "To Min", "To Max")
    )
    f = c.name_of("float", "blSafeDivide(%s - %s, %s - %s)" % (x, a, b, a))
    kind = n.interpolation_type
    if kind == "STEPPED":
        steps = c.input(n, "Steps", "float")
        f = c.name_of("float", "blSafeDivide(floor(%s * (%s + 1)), %s)" % (f, steps, steps))
    elif kind == "SMOOTHSTEP":
        f = c.name_of("float", "smoothstep(0, 1, %s)" % f)
    elif kind == "SMOOTHERSTEP":
        f = c.name_of("float", "clamp(%s, 0, 1)" % f)
        f = c.name_of("float", "%s * %s * %s * (%s * (%s * 6 - 15) + 10)" % (f, f, f, f, f))
    code = "mix(%s, %s, %s)" % (to_a, to_b, f)
    return c.let("float", "clamp(%s, min(%s, %s), max(%s, %s))" % (code, to_a, to_b, to_a, to_b) if n.clamp else code)


MATH = {
    "ADD": "{a} + {b}",
    "SUBTRACT": "{a} - {b}",
    "MULTIPLY": "{a} * {b}",
    "DIVIDE": "blSafeDivide({a}, {b})",
    "MULTIPLY_ADD": "{a} * {b} + {c}",
    "POWER": "pow({a}, {b})",
    "LOGARITHM": "(({a} > 0 && {b} > 0 && {b} != 1) ? log({a}) / log({b}) : 0)",
    "SQRT": "sqrt(max({a}, 0))",
    "INVERSE_SQRT": "inversesqrt(max({a}, 1e-20))",
    "ABSOLUTE": "abs({a})",
    "EXPONENT": "exp({a})",
    "MINIMUM": "min({a}, {b})",
    "MAXIMUM": "max({a}, {b})",
    "LESS_THAN": "(({a} < {b}) ? 1 : 0)",
    "GREATER_THAN": "(({a} > {b}) ? 1 : 0)",
    "SIGN": "sign({a})",
    "COMPARE": "((abs({a} - {b}) <= max({c}, 1e-5)) ? 1 : 0)",
    "ROUND": "floor({a} + .5)",
    "FLOOR": "floor({a})",
    "CEIL": "ceil({a})",
    "TRUNC": "(({a} < 0) ? ceil({a}) : floor({a}))",
    "FRACT": "({a} - floor({a}))",
    "MODULO": "(({b} == 0) ? 0 : {a} - {b} * (({a} / {b} < 0) ? ceil({a} / {b}) : floor({a} / {b})))",
    "FLOORED_MODULO": "(({b} == 0) ? 0 : {a} - {b} * floor({a} / {b}))",
    "WRAP": "(({b} == {c}) ? {c} : {a} - ({b} - {c}) * floor(({a} - {c}) / ({b} - {c})))",
    "SNAP": "(({b} == 0) ? 0 : floor({a} / {b}) * {b})",
    "PINGPONG": "(({b} == 0) ? 0 : abs((({a} - {b}) / ({b} * 2) - floor(({a} - {b}) / ({b} * 2))) * {b} * 2 - {b}))",
    "SINE": "sin({a})",
    "COSINE": "cos({a})",
    "TANGENT": "tan({a})",
    "ARCSINE": "asin(clamp({a}, -1, 1))",
    "ARCCOSINE": "acos(clamp({a}, -1, 1))",
    "ARCTANGENT": "atan({a})",
    "ARCTAN2": "atan({a}, {b})",
    "SINH": "(.5 * (exp({a}) - exp(-{a})))",
    "COSH": "(.5 * (exp({a}) + exp(-{a})))",
    "TANH": "(1 - 2 / (exp(2 * {a}) + 1))",
    "RADIANS": "radians({a})",
    "DEGREES": "degrees({a})",
}


@node("ShaderNodeMath")
def maths(c, n, out):
    a, b, d = (c.name_of("float", c.input(n, s.identifier, "float")) for s in list(n.inputs)[:3])
    if n.operation in ("SMOOTH_MIN", "SMOOTH_MAX"):
        c.lost("Math Smooth %s" % ("Minimum" if n.operation == "SMOOTH_MIN" else "Maximum"))
        code = "%s(%s, %s)" % ("min" if n.operation == "SMOOTH_MIN" else "max", a, b)
    elif n.operation in MATH:
        code = MATH[n.operation].format(a=a, b=b, c=d)
    else:
        c.lost("Math %s" % n.operation.title())
        code = a
    return c.let("float", "clamp(%s, 0, 1)" % code if n.use_clamp else code)


def blackbody_colour(kelvin):
    """Linear Rec. 709 colour of a black body, of luminance 1: Planck's spectrum with the CIE 1931 observer by the fits of
    Wyman, Sloan
    and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions" (JCGT 2013)."""

    def bell(x, middle, low, high):
        t = (x - middle) * (low if x < middle else high)
        return math.exp(-0.5 * t * t)

    X = Y = Z = 0.0
    for nm in range(380, 781, 5):
        power = 1 / ((nm / 500) ** 5 * (math.exp(min(700, 1.4387769e7 / (nm * max(kelvin, 800)))) - 1))
        X += power * (
            1.056 * bell(nm, 599.8, 0.0264, 0.0323)
            + 0.362 * bell(nm, 442, 0.0624, 0.0374)
            - 0.065 * bell(nm, 501.1, 0.0490, 0.0382)
        )
        Y += power * (0.821 * bell(nm, 568.8, 0.0213, 0.0247) + 0.286 * bell(nm, 530.9, 0.0613, 0.0322))
        Z += power * (1.217 * bell(nm, 437, 0.0845, 0.0278) + 0.681 * bell(nm, 459, 0.0385, 0.0725))
    X, Z = X / Y, Z / Y
    return (
        3.2404542 * X - 1.5371385 - 0.4985314 * Z,
        -0.9692660 * X + 1.8760108 + 0.0415560 * Z,
        0.0556434 * X - 0.2040259 + 1.0572252 * Z,
    )


@node("ShaderNodeBlackbody")
def blackbody(c, n, out):
    kelvin = c.fixed(n, "Temperature", 1500.0)
    if kelvin is not None:
        return constant("color", blackbody_colour(kelvin))
    colours = [blackbody_colour(800 + 11200 * i / 64) for i in range(65)]
    return table(c, colours, "(%s - 800) / 11200" % c.input(n, "Temperature", "float"))


__all__ = ["literal"]

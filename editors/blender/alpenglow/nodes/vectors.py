"""Vector nodes."""
import math

from mathutils import Euler

from ..compiler import Value, constant, node
from . import inputs


def rotation(x, y, z):
    """Rows of the matrix of an Euler rotation x, y, z (radians) for points as columns."""
    return [list(r) for r in Euler((x, y, z)).to_matrix()]


def turned(c, v, angles, back=False):
    """v (a variable) turned by Euler angles; back: by the inverse."""
    if angles.constant is not None:
        m = rotation(*angles.constant)
        if back:
            m = [list(r) for r in zip(*m)]
        return "vector(%s)" % ", ".join(
            " + ".join("(%.9g) * %scomp(%s)" % (m[i][k], "xyz"[k], v) for k in range(3)) for i in range(3)
        )
    a = c.name_of("vector", angles.code)
    p = c.name_of("point", "point(xcomp(%s), ycomp(%s), zcomp(%s))" % (v, v, v))
    sign, order = ("-", "zyx") if back else ("", "xyz")
    for axis in order:
        ends = {"x": "1, 0, 0", "y": "0, 1, 0", "z": "0, 0, 1"}[axis]
        c.say("%s = rotate(%s, %s%scomp(%s), point(0, 0, 0), point(%s));" % (p, p, sign, axis, a, ends))
    return "vector(%s)" % p


def product(a, b):
    return "vector(xcomp(%s) * xcomp(%s), ycomp(%s) * ycomp(%s), zcomp(%s) * zcomp(%s))" % (a, b, a, b, a, b)


@node("ShaderNodeMapping")
def mapping(c, n, out):
    s = c.socket(n, "Vector")
    v = c.name_of("vector", c.input(n, "Vector", "vector") if s else "vector(0, 0, 0)")
    angles, kind = c.value(n, "Rotation", "vector"), n.vector_type
    size = c.name_of("vector", c.input(n, "Scale", "vector", (1, 1, 1)))
    place = c.input(n, "Location", "vector")
    if kind == "TEXTURE":
        moved = c.name_of("vector", "%s - %s" % (v, place))
        back = c.name_of("vector", turned(c, moved, angles, True))
        return c.let(
            "vector", "vector(%s)" % ", ".join("blSafeDivide(%scomp(%s), %scomp(%s))" % (a, back, a, size) for a in "xyz")
        )
    if kind == "NORMAL":
        scaled = c.name_of(
            "vector", "vector(%s)" % ", ".join("blSafeDivide(%scomp(%s), %scomp(%s))" % (a, v, a, size) for a in "xyz")
        )
        return c.let("vector", "normalize(%s)" % turned(c, scaled, angles))
    scaled = c.name_of("vector", product(v, size))
    code = turned(c, scaled, angles)
    return c.let("vector", "%s + %s" % (code, place) if kind == "POINT" else code)


def tangents(c, n):
    """dP along u and v of a layer of coordinates."""
    layer = inputs.uv(c, n.uv_map).code
    w = c.name_of("vector", layer)
    su, sv, tu, tv = ("%s(%scomp(%s))" % (d, a, w) for a in "xy" for d in ("Du", "Dv"))
    det = c.name_of("float", "sign(%s * %s - %s * %s)" % (su, tv, sv, tu))
    along = c.name_of("vector", "%s * (dPdu * %s - dPdv * %s)" % (det, tv, tu))
    up = c.name_of("vector", "%s * (dPdv * %s - dPdu * %s)" % (det, su, sv))
    return ("(%s == vector(0, 0, 0) ? dPdu : %s)" % (along, along), "(%s == vector(0, 0, 0) ? dPdv : %s)" % (up, up))


@node("ShaderNodeNormalMap")
def normal_map(c, n, out):
    colour, strength = c.input(n, "Color", "color"), c.input(n, "Strength", "float")
    if n.space == "TANGENT":
        along, up = tangents(c, n)
        code = "blNormalMap(%s, %s, blN, %s, %s)" % (colour, strength, along, up)
    else:
        x = c.name_of("vector", "2 * blToVector(%s) - vector(1, 1, 1)" % colour)
        if n.space.startswith("BLENDER"):
            x = c.name_of("vector", "vector(xcomp(%s), -ycomp(%s), -zcomp(%s))" % (x, x, x))
        space = "object" if "OBJECT" in n.space else "world"
        code = 'normalize(blN + %s * (normalize(ntransform("%s", "current", normal(%s))) - blN))' % (strength, space, x)
    return world(c, code)


def world(c, code):
    """A normal of current space as a vector socket has it: of the world."""
    return c.let("vector", 'vtransform("world", vector(%s))' % code)


@node("ShaderNodeBump")
def bump(c, n, out):
    facing = inputs.normal_of(c, n)
    if not c.linked(n, "Height"):
        return world(c, facing)
    height = "%s * %s" % (c.input(n, "Distance", "float", 1.0), c.input(n, "Height", "float"))
    if n.invert:
        height = "-(%s)" % height
    side = "((blSide == 1) ? 1 : -1)"
    return world(c, "blBump(%s, %s, 1, %s * %s, %s)" % (height, c.input(n, "Strength", "float"), side, "blN", facing))


@node("ShaderNodeDisplacement")
def displacement(c, n, out):
    height = "%s * (%s - %s)" % (c.input(n, "Scale", "float"), c.input(n, "Height", "float"), c.input(n, "Midlevel", "float"))
    if n.space == "WORLD":
        return c.let("vector", '(%s) * vtransform("current", "object", vector(normalize(N)))' % height)
    return c.let("vector", '(%s) * normalize(vector(ntransform("object", N)))' % height)


@node("ShaderNodeNormal")
def normal(c, n, out):
    d = constant("vector", list(n.outputs[0].default_value)[:3])
    if out.name == "Normal":
        return d
    return c.let("float", "normalize(%s) . normalize(%s)" % (c.input(n, "Normal", "vector"), d.code))


@node("ShaderNodeVectorTransform")
def transform(c, n, out):
    v = c.input(n, "Vector", "vector")
    spaces = {"WORLD": "world", "OBJECT": "object", "CAMERA": "camera"}
    kind, a, b = n.vector_type, spaces[n.convert_from], spaces[n.convert_to]
    function, of = {"POINT": ("transform", "point"), "VECTOR": ("vtransform", "vector"), "NORMAL": ("ntransform", "normal")}[
        kind
    ]
    code = 'vector(%s("%s", "%s", %s(%s)))' % (function, a, b, of, v)
    return c.let("vector", "normalize(%s)" % code if kind == "NORMAL" else code)


@node("ShaderNodeVectorRotate")
def rotate(c, n, out):
    v, kind = c.name_of("vector", c.input(n, "Vector", "vector")), n.rotation_type
    centre = c.name_of("vector", c.input(n, "Center", "vector"))
    moved = c.name_of("vector", "%s - %s" % (v, centre))
    if kind == "EULER_XYZ":
        return c.let("vector", "%s + %s" % (turned(c, moved, c.value(n, "Rotation", "vector"), n.invert), centre))
    axis = {"X_AXIS": "vector(1, 0, 0)", "Y_AXIS": "vector(0, 1, 0)", "Z_AXIS": "vector(0, 0, 1)"}.get(kind) or c.input(
        n, "Axis", "vector"
    )
    angle = ("-" if n.invert else "") + c.input(n, "Angle", "float")
    return c.let("vector", "vector(rotate(point(%s), %s, point(0, 0, 0), point(%s))) + %s" % (moved, angle, axis, centre))


@node("ShaderNodeVectorMath")
def vector_math(c, n, out):
    op = n.operation
    vectors = [s for s in n.inputs if s.enabled and s.type == "VECTOR"]
    a, b, d = (
        (c.name_of("vector", c.input(n, vectors[i].identifier, "vector")) if i < len(vectors) else "vector(0, 0, 0)")
        for i in range(3)
    )
    scale = next((c.input(n, s.identifier, "float") for s in n.inputs if s.enabled and s.type == "VALUE"), "1")

    def each(form):
        return "vector(%s)" % ", ".join(
            form.replace("$a", "%scomp(%s)" % (k, a)).replace("$b", "%scomp(%s)" % (k, b)).replace("$c", "%scomp(%s)" % (k, d))
            for k in "xyz"
        )

    plain = {
        "ADD": "%s + %s" % (a, b),
        "SUBTRACT": "%s - %s" % (a, b),
        "CROSS_PRODUCT": "%s ^ %s" % (a, b),
        "SCALE": "%s * %s" % (scale, a),
        "NORMALIZE": "(%s . %s == 0 ? %s : normalize(%s))" % (a, a, a, a),
        "PROJECT": "blSafeDivide(%s . %s, %s . %s) * %s" % (a, b, b, b, b),
        "REFLECT": "%s - 2 * (%s . normalize(%s)) * normalize(%s)" % (a, a, b, b),
        "FACEFORWARD": "((%s . %s < 0) ? %s : -%s)" % (d, b, a, a),
        "REFRACT": "vector(refract(%s, normal(normalize(%s)), %s))" % (a, b, scale),
    }
    forms = {
        "MULTIPLY": "$a * $b",
        "DIVIDE": "blSafeDivide($a, $b)",
        "MULTIPLY_ADD": "$a * $b + $c",
        "ABSOLUTE": "abs($a)",
        "FLOOR": "floor($a)",
        "CEIL": "ceil($a)",
        "FRACTION": "($a - floor($a))",
        "MINIMUM": "min($a, $b)",
        "MAXIMUM": "max($a, $b)",
        "SINE": "sin($a)",
        "COSINE": "cos($a)",
        "TANGENT": "tan($a)",
        "MODULO": "(($b == 0) ? 0 : $a - $b * (($a / $b < 0) ? ceil($a / $b) : floor($a / $b)))",
        "SNAP": "(($b == 0) ? 0 : floor($a / $b) * $b)",
        "WRAP": "(($b == $c) ? $c : $a - ($b - $c) * floor(($a - $c) / ($b - $c)))",
        "POWER": "pow($a, $b)",
        "SIGN": "sign($a)",
        "ROUND": "floor($a + .5)",
    }
    values = {"DOT_PRODUCT": "%s . %s" % (a, b), "DISTANCE": "length(%s - %s)" % (a, b), "LENGTH": "length(%s)" % a}
    if op in values:
        return c.let("float", values[op])
    if op in plain:
        return c.let("vector", plain[op])
    if op in forms:
        return c.let("vector", each(forms[op]))
    c.lost("Vector Math %s" % op.title())
    return Value("vector", a)


__all__ = ["rotation", "math"]

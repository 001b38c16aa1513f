"""Input nodes: coordinates, attributes, values of the point that is shaded."""
from ..compiler import Value, constant, identifier, node
from ..rib import matrix

WORLD_P = 'transform("world", P)'


def as_vector(c, code):
    """A point, a normal or a vector as a vector, number by number."""
    return c.let("vector", "vector(%s)" % code)


def world_vector(c, code):
    return Value("vector", 'vtransform("world", vector(%s))' % code)


def generated(c):
    """Generated coordinates: in a world the direction."""
    if c.kind == "light":
        return Value("vector", "blD")
    c.needs.add("generated")
    c.parameter("bl_generated", "varying color bl_generated = 0")
    return Value("vector", "blToVector(bl_generated)")


def uv(c, name=""):
    """A layer of texture coordinates as a vector; v grows upward. "": the one that renders."""
    if c.kind == "light":
        return Value("vector", "blD")
    c.needs.add(("uv", name))
    if not name:
        return Value("vector", "vector(s, t, 0)")
    p = "bl_uv_" + identifier(name)
    c.parameter(p, "varying float %s[2] = {0, 0}" % p)
    return Value("vector", "vector(%s[0], %s[1], 0)" % (p, p))


def attribute(c, name):
    """A colour attribute, a vertex group or another attribute of the geometry, as a colour."""
    p = "bl_at_" + identifier(name)
    c.needs.add(("attribute", name))
    c.parameter(p, "varying color %s = 0" % p)
    return Value("color", p)


@node("ShaderNodeTexCoord")
def texture_coordinate(c, n, out):
    name = out.name
    if c.kind == "light":
        if name not in ("Generated", "Object", "Normal", "Reflection"):
            c.lost("Texture Coordinate %s of a world" % name)
        return Value("vector", "-blD" if name == "Normal" else "blD")
    if name == "Generated":
        return generated(c)
    if name == "UV":
        return uv(c)
    if name == "Normal":
        return as_vector(c, 'ntransform("object", blN)')
    if name == "Object":
        if n.object is None:
            return as_vector(c, 'transform("object", P)')
        m = ", ".join("%.9g" % x for x in matrix(n.object.matrix_world.inverted_safe()))
        return as_vector(c, "transform(matrix(%s), %s)" % (m, WORLD_P))
    if name == "Camera":
        return as_vector(c, "P")
    if name == "Window":
        p = c.name_of("point", 'transform("NDC", P)')
        return Value("vector", "vector(xcomp(%s), 1 - ycomp(%s), 0)" % (p, p))
    return c.let("vector", 'vtransform("world", reflect(normalize(I), vector(blN)))')


@node("ShaderNodeNewGeometry")
def geometry(c, n, out):
    name = out.name
    if c.kind == "light":
        return (
            Value("vector", "-blD" if name in ("Normal", "Incoming", "True Normal") else "blD")
            if out.type == "VECTOR"
            else constant("float", 0.0)
        )
    if name == "Position":
        return as_vector(c, WORLD_P)
    if name == "Normal":
        return as_vector(c, 'ntransform("world", blN)')
    if name == "True Normal":
        return as_vector(c, 'ntransform("world", faceforward(normalize(Ng), I))')
    if name == "Tangent":
        return world_vector(c, "normalize(dPdu)")
    if name == "Incoming":
        return world_vector(c, "-normalize(I)")
    if name == "Backfacing":
        return Value("float", "(1 - blSide)")
    if name == "Parametric":
        return Value("vector", "vector(u, v, 0)")
    c.lost("Geometry node's %s" % name)
    return constant("float", 0.5)


@node("ShaderNodeObjectInfo")
def object_info(c, n, out):
    names = {
        "Location": ("color", "bllocation", "vector"),
        "Color": ("color", "blcolor", "color"),
        "Alpha": ("float", "blalpha", "float"),
        "Object Index": ("float", "blobject", "float"),
        "Material Index": ("float", "blmaterial", "float"),
        "Random": ("float", "blrandom", "float"),
    }
    kind, name, as_kind = names[out.name]
    variable = c.name_of(kind, "0")
    c.say('attribute("user:%s", %s);' % (name, variable))
    return c.convert(Value(kind, variable), as_kind)


@node("ShaderNodeUVMap")
def uv_map(c, n, out):
    return uv(c, n.uv_map)


@node("ShaderNodeAttribute")
def attribute_node(c, n, out):
    if getattr(n, "attribute_type", "GEOMETRY") != "GEOMETRY":
        c.lost("Attributes of the %s" % n.attribute_type.lower())
        return constant(
            {"Color": "color", "Vector": "vector"}.get(out.name, "float"), 0.0 if out.name in ("Fac", "Alpha") else (0, 0, 0)
        )
    if out.name == "Alpha":
        return constant("float", 1.0)
    found = attribute(c, n.attribute_name)
    if out.name in ("Fac", "Factor"):
        return c.convert(c.convert(found, "vector"), "float")
    return c.convert(found, "vector" if out.name == "Vector" else "color")


@node("ShaderNodeVertexColor")
def vertex_color(c, n, out):
    if out.name == "Alpha":
        return constant("float", 1.0)
    return attribute(c, n.layer_name)


@node("ShaderNodeTangent")
def tangent(c, n, out):
    if n.direction_type == "UV_MAP":
        return world_vector(c, "normalize(dPdu)")
    axis = {"X": "(0, -zcomp(p), ycomp(p))", "Y": "(zcomp(p), 0, -xcomp(p))", "Z": "(-ycomp(p), xcomp(p), 0)"}[n.axis]
    p = c.name_of("point", 'transform("object", P)')
    return c.let("vector", 'normalize(vtransform("object", "world", vector%s))' % axis.replace("p)", p + ")"))


@node("ShaderNodeRGB")
def rgb(c, n, out):
    return constant("color", list(n.outputs[0].default_value)[:3])


@node("ShaderNodeValue")
def value(c, n, out):
    return constant("float", n.outputs[0].default_value)


@node("ShaderNodeLightPath")
def light_path(c, n, out):
    name = out.name
    kinds = {
        "Is Camera Ray": "camera",
        "Is Diffuse Ray": "diffuse",
        "Is Glossy Ray": "specular",
        "Is Singular Ray": "specular",
        "Is Reflection Ray": "specular",
        "Is Shadow Ray": "transmission",
    }
    if name in kinds:
        if "blRay" not in c.values:
            c.values["blRay"] = True
            c.say('string blRay = "";')
            c.say('rayinfo("type", blRay);')
        return Value("float", '((blRay == "%s") ? 1 : 0)' % kinds[name])
    depths = {"Ray Depth": "depth", "Ray Length": "length", "Diffuse Depth": "diffusedepth", "Glossy Depth": "speculardepth"}
    if name in depths:
        variable = c.name_of("float", "0")
        c.say('rayinfo("%s", %s);' % (depths[name], variable))
        return Value("float", variable)
    c.lost("Light Path's %s" % name)
    return constant("float", 0.0)


@node("ShaderNodeFresnel")
def fresnel(c, n, out):
    ior, normal = c.input(n, "IOR", "float"), normal_of(c, n)
    return c.let(
        "float", "blDielectric(-(%s . normalize(I)), (blSide == 1) ? max(%s, 1e-5) : 1 / max(%s, 1e-5))" % (normal, ior, ior)
    )


@node("ShaderNodeLayerWeight")
def layer_weight(c, n, out):
    blend, normal = c.name_of("float", c.input(n, "Blend", "float")), normal_of(c, n)
    if out.name == "Fresnel":
        eta = c.name_of("float", "max(1 - %s, 1e-5)" % blend)
        return c.let("float", "blDielectric(-(%s . normalize(I)), (blSide == 1) ? 1 / %s : %s)" % (normal, eta, eta))
    return c.let(
        "float",
        "1 - pow(clamp(-(%s . normalize(I)), 0, 1), (%s == .5) ? 1 : (%s < .5) ? 2 * clamp(%s, 0, .99999) : "
        ".5 / (1 - clamp(%s, 0, .99999)))" % (normal, blend, blend, blend, blend),
    )


@node("ShaderNodeHairInfo")
def hair_info(c, n, out):
    if out.name in ("Intercept", "Length"):
        return Value("float", "v") if out.name == "Intercept" else constant("float", 0.1)
    if out.name == "Tangent Normal":
        return world_vector(c, "normalize(dPdv)")
    if out.name == "Is Strand":
        variable = c.name_of("float", "0")
        c.say('attribute("user:blstrand", %s);' % variable)
        return Value("float", variable)
    if out.name == "Random":
        c.needs.add("strandrandom")
        c.parameter("bl_random", "varying float bl_random = 0")
        return Value("float", "bl_random")
    c.lost("Hair Info's %s" % out.name)
    return constant("float", 0.01)


def normal_of(c, n, names="Normal"):
    """The normal that a node is given, as an RSL normal of current space on the viewer's side."""
    if c.kind == "light" or not c.linked(n, names):
        return "blN"
    return c.name_of("normal", 'blSeen(normal(vtransform("world", "current", %s)))' % c.input(n, names, "vector"))

"""A tree of shader nodes as the text of one RSL shader. What each node becomes stands in nodes/."""
import re

NODES = {}  # type of node -> function(compiler, node, output socket) -> Value
KINDS = {
    "VALUE": "float",
    "INT": "float",
    "BOOLEAN": "float",
    "RGBA": "color",
    "VECTOR": "vector",
    "SHADER": "closure",
    "ROTATION": "vector",
}


def node(*types):
    """Registers a function as the translation of these types of nodes."""

    def register(function):
        for one in types:
            NODES[one] = function
        return function

    return register


class Value:
    """What a socket gives: kind float, color, vector or closure, and an RSL expression. A closure's code is two names: its
    light and
    how much goes straight through. constant: the numbers, where they are known."""

    def __init__(self, kind, code, constant=None):
        self.kind, self.code, self.constant = kind, code, constant


def literal(x):
    text = "%.9g" % x
    return "(%s)" % text if text.startswith("-") else text


def constant(kind, numbers):
    """A Value of numbers: one for a float, three for the others."""
    if kind == "float":
        x = numbers if isinstance(numbers, (int, float)) else numbers[0]
        return Value(kind, literal(float(x)), float(x))
    three = tuple(float(x) for x in numbers)[:3]
    return Value(kind, "%s(%s)" % (kind, ", ".join("%.9g" % x for x in three)), three)


def identifier(name):
    """A name that RSL takes, of any text: what is no letter or digit becomes its number."""
    return re.sub(r"[^A-Za-z0-9]", lambda m: "_%x_" % ord(m.group()), name)


class Compiler:
    """kind: "surface", "light" (of a world) or "displacement". where: the material's name, for reports."""

    def __init__(self, name, where, kind, report, images):
        self.name, self.where, self.kind, self.report, self.images = name, where, kind, report, images
        self.parameters, self.lines, self.values, self.groups, self.active = {}, [], {}, [], set()
        self.emission = True  # False: an area light carries what the material emits
        self.needs = set()  # what geometry must bring: "generated", ("uv", name), ("attribute", name)
        self.count = 0

    # Text.
    def name_of(self, kind, code):
        """A new variable of the shader that holds an expression."""
        self.count += 1
        variable = "%s%d" % (kind[0], self.count)
        self.lines.append("%s %s = %s;" % (kind, variable, code))
        return variable

    def say(self, line):
        self.lines.append(line)

    def let(self, kind, code):
        return Value(kind, self.name_of(kind, code))

    def call(self, function, outputs, *arguments):
        """A call of a void function: variables for its outputs, (kind, ...), which stand behind the arguments. Their names."""
        names = [self.name_of(kind, "0") for kind in outputs]
        self.say("%s(%s);" % (function, ", ".join(list(arguments) + names)))
        return names

    def parameter(self, name, declaration):
        self.parameters[name] = declaration

    def lost(self, what):
        self.report.lost(what, self.where)

    # Sockets.
    def socket(self, of, names):
        """The first enabled input of these names or identifiers; None where the node has none."""
        for name in (names,) if isinstance(names, str) else names:
            for s in of.inputs:
                if name in (s.identifier, s.name) and getattr(s, "enabled", True):
                    return s
        return None

    def linked(self, of, names):
        """Whether something comes into it."""
        s = self.socket(of, names)
        return s is not None and self.source(s)[1] is not None

    def fixed(self, of, names, default=0.0):
        """Its number or numbers where nothing is linked (default: no such input); None where something is."""
        s = self.socket(of, names)
        if s is None:
            return default
        groups, from_socket = self.source(s)
        if from_socket is not None:
            value = self.output(groups, from_socket)
            return value.constant
        return self.default(s, groups).constant

    def default(self, s, groups=None):
        kind = KINDS.get(s.type, "float")
        if kind == "closure":
            return Value("closure", ("color(0)", "color(0)"), None)
        v = s.default_value
        return constant(kind, v if kind == "float" else list(v)[:3])

    def source(self, s):
        """What an input gets: (groups around, output socket), None for nothing. Reroutes, groups and muted nodes are looked
        through."""
        groups = list(self.groups)
        for _ in range(1000):
            if not s.is_linked or s.links[0].is_muted or not s.links[0].is_valid:
                return self._unlinked(s, groups)
            out = s.links[0].from_socket
            n = out.node
            if n.mute:
                inner = [link.from_socket for link in n.internal_links if link.to_socket == out]
                if not inner:
                    return groups, None
                s = inner[0]
            elif n.bl_idname == "NodeReroute":
                s = n.inputs[0]
            elif n.bl_idname == "NodeGroupInput" and groups:
                outer = groups.pop()
                s = next((i for i in outer.inputs if i.identifier == out.identifier), None)
                if s is None:
                    return groups, None
            elif n.bl_idname == "ShaderNodeGroup" and n.node_tree:
                end = next((o for o in n.node_tree.nodes if o.bl_idname == "NodeGroupOutput" and o.is_active_output), None)
                inner = end and next((i for i in end.inputs if i.identifier == out.identifier), None)
                if inner is None:
                    return groups, None
                groups.append(n)
                s = inner
            else:
                return groups, out
        return groups, None

    def _unlinked(self, s, groups):
        if s.node.bl_idname in ("ShaderNodeGroup", "NodeGroupOutput") and s.type != "SHADER":
            return groups, _Constant(s)  # the value stands at the group, not at the node inside
        return groups, None

    def input(self, of, names, kind, default=0.0):
        """RSL text of an input, as kind. default: where the node has no such input (it came or went with a version)."""
        return self.value(of, names, kind, default).code

    def value(self, of, names, kind, default=0.0):
        s = self.socket(of, names)
        if s is None:
            return self.convert(
                constant("float", default) if isinstance(default, (int, float)) else constant("color", default), kind
            )
        groups, from_socket = self.source(s)
        if from_socket is None:
            return self.convert(self.default(s), kind)
        return self.convert(self.output(groups, from_socket), kind)

    def output(self, groups, out):
        """The value of an output socket; each is computed once."""
        if isinstance(out, _Constant):
            return self.default(out.socket)
        key = (tuple(g.name for g in groups), out.node.name, out.identifier, self.emission)
        if key in self.values:
            return self.values[key]
        if key in self.active:
            self.lost("Nodes in a circle")
            return self.nothing(out)
        self.active.add(key)
        before, self.groups = self.groups, groups
        translate = NODES.get(out.node.bl_idname)
        if translate is None:
            self.lost("Node %s" % (out.node.bl_label or out.node.bl_idname))
            value = self.nothing(out)
        else:
            value = translate(self, out.node, out)
        self.groups = before
        self.active.discard(key)
        self.values[key] = value
        return value

    def nothing(self, out):
        """In place of what is not known: the first input of the same kind, else a middle value."""
        kind = KINDS.get(out.type, "float")
        for s in out.node.inputs:
            if KINDS.get(s.type) == kind and kind != "closure":
                groups, source = self.source(s)
                return self.default(s) if source is None else self.convert(self.output(groups, source), kind)
        if kind == "closure":
            return Value(
                "closure", ("color(.5, .5, .5) * diffuse(blN)" if self.kind == "surface" else "color(.5, .5, .5)", "color(0)")
            )
        return constant(kind, 0.5 if kind == "float" else (0.5, 0.5, 0.5))

    def convert(self, value, kind):
        """As Blender converts between sockets."""
        a = value.kind
        if a == kind:
            return value
        if kind == "closure":  # a colour where a shader belongs is emission
            return Value("closure", (self.convert(value, "color").code, "color(0)"))
        if a == "closure":
            self.lost("A shader where a value belongs")
            return constant(kind, 0.0 if kind == "float" else (0, 0, 0))
        c = value.constant
        if c is not None:
            if kind == "float":
                c = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2] if a == "color" else sum(c) / 3
            return constant(kind, (c, c, c) if a == "float" else c)
        forms = {
            ("float", "color"): "color(%s)",
            ("float", "vector"): "vector(%s)",
            ("color", "float"): "blToFloat(%s)",
            ("vector", "float"): "blMean(%s)",
            ("color", "vector"): "blToVector(%s)",
            ("vector", "color"): "blToColor(%s)",
        }
        return Value(kind, forms[a, kind] % value.code)

    # Whole shaders.
    def surface(self, tree, target="CYCLES"):
        """The text of a surface shader; a tree without an output is black."""
        end = output_node(tree, target)
        light, through = (
            self.value(end, "Surface", "closure").code if end and self.linked(end, "Surface") else ("color(0)", "color(0)")
        )
        return self._text(
            "surface",
            ["Oi = color(1) - clamp(%s, color(0), color(1));" % through, "Ci = %s;" % light],
            ["float blSide = blFront();", "normal blN = blSeen((blSide == 1) ? normalize(N) : -normalize(N));"],
        )

    def world(self, tree, camera):
        """The text of a light shader that is the sky. camera False: the camera does not see it."""
        end = output_node(tree)
        light, _ = (
            self.value(end, "Surface", "closure").code if end and self.linked(end, "Surface") else ("color(0)", "color(0)")
        )
        first = ['vector blD = normalize(vtransform("world", -L));']
        last = ["Cl = %s;" % light]
        if not camera:
            first += ['string kind = "";', "float way = 1;", 'rayinfo("type", kind);', 'rayinfo("length", way);']
            last += ['if (kind == "camera" && way == 0) Cl = 0;']
        body = self.lines
        self.lines = []
        return self._text("light", ["solar() {"] + first + body + last + ["}"], [])

    def displacement(self, tree):
        """The text of a displacement shader."""
        end = output_node(tree)
        moved = self.value(end, "Displacement", "vector").code
        return self._text(
            "displacement",
            ['P += vtransform("object", "current", %s);' % moved, "N = calculatenormal(P);"],
            ["float blSide = 1;", "normal blN = normalize(N);"],
        )

    def _text(self, kind, last, first):
        parameters = "".join("\n    %s;" % p for p in self.parameters.values())
        return "%s %s(%s)\n{\n%s}\n" % (
            kind,
            self.name,
            parameters,
            "".join("    %s\n" % line for line in first + self.lines + last),
        )


class _Constant:
    """In place of an output socket: the value of an input that nothing is linked to."""

    def __init__(self, socket):
        self.socket, self.node, self.identifier = socket, socket.node, socket.identifier


def output_node(tree, target="CYCLES"):
    """The active output of a tree of a material or a world."""
    found = [
        n for n in tree.nodes if n.bl_idname in ("ShaderNodeOutputMaterial", "ShaderNodeOutputWorld", "ShaderNodeOutputLight")
    ]
    ranked = sorted(found, key=lambda n: (not n.is_active_output, getattr(n, "target", "ALL") not in ("ALL", target)))
    return ranked[0] if ranked else None

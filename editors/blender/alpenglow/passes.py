"""Passes: what Blender calls them, what the program is asked for, and how numbers are turned on the way."""
import numpy as np

from .properties import OUTPUTS, expressions


class Pass:
    """name, channels, letters and kind as RenderEngine.register_pass() has them; output: a channel of a Display; turn:
    function(numbers, pixels
    seen) or None."""

    def __init__(self, name, output, letters="RGB", kind="COLOR", turn=None):
        self.name, self.output, self.letters, self.kind, self.turn = name, output, letters, kind, turn

    @property
    def channels(self):
        return len(self.letters)


def identifier(text):
    return "".join(ch if ch.isalnum() else "_" for ch in text)


def listed(scene, layer, report=None):
    """All passes of a view layer but Combined."""
    out = []
    if layer.use_pass_z:
        out.append(Pass("Depth", "z", "Z", "VALUE", far))
    if layer.use_pass_normal:
        out.append(Pass("Normal", "normal", "XYZ", "VECTOR", "world"))
    own = getattr(layer, "alpenglow", None)
    if own is not None:
        for use, output, name, _ in OUTPUTS:
            if getattr(own, use):
                one = output in ("variance", "samples")
                out.append(Pass(name, output, "X" if one else "RGB", "VALUE" if one else "COLOR"))
        if own.lights:
            for obj in scene.objects:
                if obj.type == "LIGHT":
                    out.append(Pass("Light " + obj.name, "lpe:C.*<L.'%s'>" % obj.name))
        try:
            for name, text in expressions(layer).items():
                out.append(Pass(name, text if text.startswith("lpe:") else "lpe:" + text))
        except ValueError as error:
            if report is not None:
                report.lost("Light paths of the view layer (%s)" % error)
    for field, name in (
        ("use_pass_mist", "Mist"),
        ("use_pass_position", "Position"),
        ("use_pass_vector", "Vector"),
        ("use_pass_uv", "UV"),
        ("use_pass_object_index", "Object Index"),
        ("use_pass_material_index", "Material Index"),
        ("use_pass_emit", "Emission"),
        ("use_pass_environment", "Environment"),
        ("use_pass_shadow", "Shadow"),
        ("use_pass_ambient_occlusion", "Ambient Occlusion"),
        ("use_pass_diffuse_direct", "Diffuse Direct"),
        ("use_pass_diffuse_indirect", "Diffuse Indirect"),
        ("use_pass_diffuse_color", "Diffuse Color"),
        ("use_pass_glossy_direct", "Glossy Direct"),
        ("use_pass_glossy_indirect", "Glossy Indirect"),
        ("use_pass_glossy_color", "Glossy Color"),
        ("use_pass_transmission_direct", "Transmission Direct"),
        ("use_pass_transmission_indirect", "Transmission Indirect"),
        ("use_pass_transmission_color", "Transmission Color"),
        ("use_pass_cryptomatte_object", "Cryptomatte"),
        ("use_pass_cryptomatte_material", "Cryptomatte"),
    ):
        expression = LIGHT.get(name)
        if getattr(layer, field, False):
            if expression:
                out.append(Pass(NAMES[name], expression))
            elif report is not None:
                report.lost("Pass %s" % name, layer.name)
    return out


LIGHT = {
    "Emission": "lpe:CO",
    "Environment": "lpe:CB",
    "Diffuse Direct": "lpe:C<RD>[LO]",
    "Diffuse Indirect": "lpe:C<RD>[RTV]+[LO]",
    "Glossy Direct": "lpe:C<R[GS]>[LO]",
    "Glossy Indirect": "lpe:C<R[GS]>[RTV]+[LO]",
    "Transmission Direct": "lpe:C<T.>[LO]",
    "Transmission Indirect": "lpe:C<T.>[RTV]+[LO]",
}
NAMES = {
    "Emission": "Emit",
    "Environment": "Env",
    "Diffuse Direct": "DiffDir",
    "Diffuse Indirect": "DiffInd",
    "Glossy Direct": "GlossDir",
    "Glossy Indirect": "GlossInd",
    "Transmission Direct": "TransDir",
    "Transmission Indirect": "TransInd",
}


def far(z):
    """Blender has a great number where nothing is seen."""
    return np.where(np.isfinite(z) & (z < 1e10), z, 1e10)


def declarations(passes):
    """DisplayChannel requests: (declaration, parameters), and the mode of the Display that holds them."""
    out, mode = [], []
    for number, one in enumerate(passes):
        if one.output.startswith("lpe:"):
            channel = "pass%d" % number
            out.append(("color " + channel, {"string source": one.output}))
            mode.append(channel)
        else:
            mode.append(one.output)
    return out, mode

"""The world: a light shader that is the sky, made of its nodes."""
import os

from .compiler import Compiler, output_node

HEAD = '#include "textures.h"\n'


def write(rib, scene, folder, report, images):
    """LightSource of the world, seen by the camera unless the film is transparent."""
    world = scene.world
    if world is None:
        return
    camera = not scene.render.film_transparent
    name = "blworld"
    if world.use_nodes and world.node_tree:
        end = output_node(world.node_tree)
        if end is not None and end.inputs["Volume"].is_linked:
            report.lost("Volume of the world", world.name)
        text = Compiler(name, "world " + world.name, "light", report, images).world(world.node_tree, camera)
    else:
        seen = (
            ""
            if camera
            else (
                'string kind = ""; float way = 1; rayinfo("type", kind); rayinfo("length", way);\n'
                '        if (kind == "camera" && way == 0) Cl = 0;'
            )
        )
        text = "light %s()\n{\n    solar() {\n        Cl = color(%.7g, %.7g, %.7g);\n        %s\n    }\n}\n" % (
            (name,) + tuple(world.color) + (seen,)
        )
    with open(os.path.join(folder, name + ".sl"), "w", encoding="utf-8") as f:
        f.write(HEAD + text)
    rib.request("LightSource", name, "World")

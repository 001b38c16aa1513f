"""blender -b --factory-startup --python blender_stop.py -- PICTURE: a render that only a signal ends; what was done is kept as PICTURE."""
import os
import sys

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.environ.get("ALPENGLOW_ADDON", os.path.join(HERE, "..", "..", "editors", "blender"))]
import alpenglow  # noqa: E402

alpenglow.register()
S = bpy.context.scene
S.render.engine, S.alpenglow.samples = "ALPENGLOW", 1000000
S.render.resolution_x, S.render.resolution_y = 192, 108
bpy.ops.render.render()
bpy.data.images["Render Result"].save_render(sys.argv[sys.argv.index("--") + 1])
print("END", flush=True)

"""Alpenglow as a render engine of Blender 3.4 and later: writes RIB and RSL and runs the program `alpenglow`."""
bl_info = {"name": "Alpenglow", "author": "The Alpenglow authors", "version": (0, 2, 0), "blender": (3, 4, 0),
           "location": "Render Properties > Render Engine", "category": "Render",
           "description": "Renders by the RenderMan renderer Alpenglow: RIB, RSL, path tracing"}

try:
    import bpy  # noqa: F401
except ImportError:  # the plain parts (rib, exr, report) are used without Blender, too
    bpy = None

if bpy is not None:
    from . import engine, nodes, properties, ui

    def register():
        properties.register()
        engine.register()
        ui.register()

    def unregister():
        ui.unregister()
        engine.unregister()
        properties.unregister()

    __all__ = ["engine", "nodes", "properties", "register", "ui", "unregister"]

"""Blender's shader nodes as RSL: one function a node, found by the node's type."""
from . import closures, converters, inputs, textures, vectors  # noqa: F401  (they fill compiler.NODES)

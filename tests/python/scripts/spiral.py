#!/usr/bin/env python3
# A staircase by procedurals, and records.
import prman

ri = prman.Ri()
ri.Option("rib", {"string asciistyle": "indented"})


def steps(data, detail):
    ri, count, turn = data
    ri.TransformBegin()
    for _ in range(count):
        ri.Patch("bilinear", {"P": [0, 0, -0.2, 1, 0, -0.2, 0, 0, 0.2, 1, 0, 0.2]})
        ri.Translate(0, 0.2, 0)
        ri.Rotate(turn, 0, 1, 0)
    ri.TransformEnd()


ri.Begin("__render")
ri.ArchiveRecord(ri.COMMENT, "File " + __file__)
ri.Declare("Lamp", "string")
ri.Display("spiral.exr", "it", "rgba")
ri.Format(720, 575, 1)
ri.Projection(ri.PERSPECTIVE, {ri.FOV: 50})
ri.Translate(0, -1, 5)
ri.WorldBegin()
ri.LightSource("pointlight", {ri.HANDLEID: "Lamp", "point from": [2, 4, -4], "float intensity": [20]})
ri.Illuminate("Lamp", 1)
ri.Surface("matte")
ri.Procedural((ri, 12, 20), [-1, 1, 0, 3, -1, 1], steps, None)
ri.WorldEnd()
ri.End()

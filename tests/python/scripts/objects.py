#!/usr/bin/env python3
# Objects, motion, curves, points, subdivision with tags, a depth map made and read.
import prman


class Camera:
    def __init__(self, fov):
        self.fov = fov

    def place(self, ri):
        ri.Projection(ri.PERSPECTIVE, {ri.FOV: self.fov})
        ri.ConcatTransform([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 6, 1])


ri = prman.Ri()
ri.Begin("__render")
ri.Display("objects_depth.z", "zfile", "z")
ri.Clipping(1, 20)
ri.Format(64, 64, 1)
Camera(40).place(ri)
ri.WorldBegin()
ri.Sphere(1, -1, 1, 360)
ri.WorldEnd()
ri.MakeShadow("objects_depth.z", "objects_depth.shad")
ri.End()

ri.Begin("__render")
ri.Display("objects.exr", "openexr", "rgba")
ri.Shutter(0, 1)
ri.PixelFilter(ri.GAUSSIANFILTER, 2, 2)
ri.Hider("raytrace", {"int incremental": [1]})
Camera(45).place(ri)
ri.WorldBegin()
ball = ri.ObjectBegin()
ri.Sphere(0.3, -0.3, 0.3, 360)
ri.ObjectEnd()
for x in (-1, 0, 1):
    ri.TransformBegin()
    ri.Translate(x, 1, 0)
    ri.ObjectInstance(ball)
    ri.TransformEnd()
ri.MotionBegin([0, 1])
ri.Translate(0, 0, 0)
ri.Translate(0.2, 0, 0)
ri.MotionEnd()
ri.Attribute("identifier", {"name": "cage"})
ri.SubdivisionMesh("catmull-clark", [4], [0, 1, 2, 3], [ri.INTERPBOUNDARY, ri.CREASE], [0, 0, 2, 1], [0, 1], [3.0],
                   {ri.P: [-1, -1, 0, 1, -1, 0, 1, 0, 0, -1, 0, 0]})
ri.Curves("cubic", [4, 4], "nonperiodic", {ri.P: [x * 0.2 - 1 for x in range(24)], ri.CONSTANTWIDTH: [0.05]})
ri.Points({ri.P: [0, -1, 0, 1, -1, 0], ri.WIDTH: [0.1, 0.2], ri.CS: [1, 0, 0, 0, 1, 0]})
ri.WorldEnd()
ri.End()

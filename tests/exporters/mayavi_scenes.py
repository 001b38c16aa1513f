"""mayavi_scenes.py OUT: three scenes of mayavi as NAME.png and NAME.rib (its save_rib). Run with a display."""
import os
import sys

import numpy as np
from mayavi import mlab

mlab.options.offscreen = True


def surface():
    x, y = np.mgrid[-3:3:40j, -3:3:40j]
    mlab.surf(x, y, np.cos(x) * np.sin(y), colormap="viridis")


def knot():
    t = np.linspace(0, 4 * np.pi, 200)
    mlab.plot3d(np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t), tube_radius=.3, color=(.9, .5, .2))


def shell():
    x, y, z = np.mgrid[-2:2:30j, -2:2:30j, -2:2:30j]
    mlab.contour3d(x * x + y * y + .5 * z * z, contours=[1.5], color=(.3, .6, .9))


for make in (surface, knot, shell):
    figure = mlab.figure(size=(200, 200), bgcolor=(.1, .1, .2))
    make()
    figure.scene.anti_aliasing_frames = 0
    mlab.savefig(os.path.join(sys.argv[1], make.__name__ + ".png"), size=(200, 200))
    figure.scene.save_rib(os.path.join(sys.argv[1], make.__name__ + ".rib"), bg=1)
    mlab.close(figure)

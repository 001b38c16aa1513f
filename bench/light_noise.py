#!/usr/bin/env python3
"""docs/noise.md, lamps, skies, and lights behind mirrors: noise of light from each kind of light, and its time.

light_noise.py [--build FOLDER] [--spp N] [--seeds K] [--only WORD] [--json FILE] [--beside FILE]

Renders each scene with K seeds at N samples a pixel, one thread. Noise is the root mean square over pixels of the standard deviation over
seeds, relative to the mean of the seeds (plus a hundredth of the picture's mean); "most" leaves out the noisiest 1 % of the pixels. Light
that no seed finds is in no figure. Time is of the processor, what is learned before the first sample included. --json writes the figures;
--beside FILE compares them with figures that another build wrote: noise squared times time, above 1 if this build is better.
"""
import argparse
import json
import math
import os
import sys
import tempfile
import time

HEAD = '''Format 160 120 1
Projection "perspective" "fov" 40
Hider "path"
Scale 1 1 -1
Rotate 25 1 0 0
Translate 0 -2.6 -6
WorldBegin
Sides 2
'''
FLOOR = 'AttributeBegin Surface "slmaterial" "color diffusecolor" [.7 .7 .7] Polygon "P" [-4 0 -4  -4 0 4  4 0 4  4 0 -4] AttributeEnd\n'
GLASS = ('AttributeBegin Surface "slmaterial" "color diffusecolor" [0 0 0] "color transmissive" [1 1 1] "float kn" 1.5 '
         '"string fresnel" "exact" Translate 0 .7 0 Sphere .6 -.6 .6 360 AttributeEnd\n')
MIRROR = ('AttributeBegin Surface "slmaterial" "color diffusecolor" [0 0 0] "color specularcolor" [1 1 1] '
          'Polygon "P" [-1.5 .1 -2  1.5 .1 -2  1.5 1.8 -2  -1.5 1.8 -2] AttributeEnd\n')
SKY = '''light sunnysky(float angle = .026, bright = 4000; vector toward = vector(.4, .8, .3))
{ solar() { vector w = -normalize(L); Cl = color(.3, .4, .6) * .5; if (w . normalize(toward) > cos(angle)) Cl += bright; } }
'''


def lamp(shape):
    return ('AttributeBegin AreaLightSource "slrect" 1 "float intensity" 20 Surface "constant" Color 0 0 0 Translate 0 2 -.5 '
            + shape + ' AttributeEnd\nIlluminate 1 1\n')


def ball(n, m, radius):
    """A ball of n x m quadrangles."""
    points = [(radius * math.sin(math.pi * i / n) * math.cos(2 * math.pi * j / m), radius * math.cos(math.pi * i / n),
               radius * math.sin(math.pi * i / n) * math.sin(2 * math.pi * j / m)) for i in range(n + 1) for j in range(m)]
    corners = [v for i in range(n) for j in range(m)
               for v in (i * m + j, i * m + (j + 1) % m, (i + 1) * m + (j + 1) % m, (i + 1) * m + j)]
    return 'PointsPolygons [' + '4 ' * (n * m) + '] [' + ' '.join(map(str, corners)) + '] "P" [' + \
        ' '.join('%.6g' % x for p in points for x in p) + ']'


def scenes():
    """Name and what stands in the world."""
    spot = 'LightSource "spotlight" 1 "intensity" 20 "from" [.4 3 .6] "to" [0 0 0] "coneangle" .6 "beamdistribution" 0\n'
    sun = 'LightSource "distantlight" 1 "from" [.4 2 1] "to" [0 0 0]\n'
    yield from [('lamp: ' + name, lamp(shape) + FLOOR) for name, shape in (
        ('sphere', 'Sphere .2 -.2 .2 360'), ('disk', 'Rotate 90 1 0 0 Disk 0 .3 360'), ('tube', 'Rotate 90 0 1 0 Cylinder .05 -1.5 1.5 360'),
        ('torus', 'Rotate 90 1 0 0 Torus .6 .08 0 360 360'), ('mesh ball', ball(24, 48, .2)),
        ('bilinear patch', 'Patch "bilinear" "P" [-.5 0 -.5  .5 .3 -.5  -.5 .3 .5  .5 0 .5]'))]
    for degrees, bright in ((1.5, 4000), (.27, 128000)):
        yield 'sky: sun of %g degrees, glass ball' % degrees, \
            'LightSource "sunnysky" 1 "angle" %g "bright" %g\n' % (math.radians(degrees), bright) + FLOOR + GLASS
    yield 'sky: without a sun', 'LightSource "sunnysky" 1 "bright" 0\n' + FLOOR + GLASS
    yield from [('mirrored: ' + name, light + FLOOR + what) for name, light, what in (
        ('spot, plane mirror', spot, MIRROR), ('spot, glass ball', spot, GLASS), ('distant light, glass ball', sun, GLASS))]


def measure(alpenglow, numpy, text, spp, seeds, folder):
    path = os.path.join(folder, 'scene.rib')
    with open(path, 'w') as f:
        f.write('Option "searchpath" "string shader" ["%s:@"]\n' % folder + HEAD + text + 'WorldEnd\n')
    pictures, seconds = [], 0
    for seed in range(1, seeds + 1):
        begun = time.process_time()
        result = alpenglow.render(path, quiet=True, write=False, spp=spp, seed=seed, threads=1)
        seconds += time.process_time() - begun
        pictures.append(numpy.array(result.pictures[0].data)[..., :3] @ (.2126, .7152, .0722))
    mean = numpy.mean(pictures, axis=0)
    squares = numpy.sort((numpy.var(pictures, axis=0, ddof=1) / (mean + .01 * mean.mean()) ** 2).ravel())
    most = squares[:int(.99 * squares.size)]
    return {'noise': float(squares.mean() ** .5), 'most': float(most.mean() ** .5), 'seconds': seconds / seeds, 'mean': float(mean.mean())}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', default='build/release', metavar='FOLDER')
    parser.add_argument('--spp', type=int, default=16)
    parser.add_argument('--seeds', type=int, default=6)
    parser.add_argument('--only', default='', metavar='WORD', help='scenes whose name contains this')
    parser.add_argument('--json', metavar='FILE')
    parser.add_argument('--beside', metavar='FILE')
    options = parser.parse_args()
    if options.seeds < 2:
        parser.error('--seeds: 2 at least, because noise is the difference between seeds')
    sys.path.insert(0, os.path.join(options.build, 'python'))
    import alpenglow
    import numpy
    beside = {}
    if options.beside:
        with open(options.beside) as f:
            beside = json.load(f)
    figures = {}
    print('%-40s %8s %8s %8s %8s%s' % ('%d samples' % options.spp, 'noise', 'most', 'seconds', 'mean', '   gain' if beside else ''))
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, 'sunnysky.sl'), 'w') as f:
            f.write(SKY)
        for name, text in scenes():
            if options.only not in name:
                continue
            m = figures[name] = measure(alpenglow, numpy, text, options.spp, options.seeds, folder)
            gain = ''
            if b := beside.get(name):
                gain = '%7.2f' % (b['most'] ** 2 * b['seconds'] / (m['most'] ** 2 * m['seconds']))
            print('%-40s %8.4f %8.4f %8.2f %8.4f%s' % (name, m['noise'], m['most'], m['seconds'], m['mean'], gain), flush=True)
    if options.json:
        with open(options.json, 'w') as f:
            json.dump(figures, f, indent=1)


if __name__ == '__main__':
    main()

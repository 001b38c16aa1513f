#!/usr/bin/env python3
"""Scenes of old kinds for measuring `hidden` beside other renderers: make.py FOLDER
Writes into FOLDER, each with the shaders it needs beside it:
  terrain.rib    a height field of bicubic patch meshes around the eye, ShadingRate .25; most of it is not in the picture
  terrainn.rib   the same under a displacement shader that only turns normals
  teapots.rib    a pot of patches in three passes, two of them reflections; bumps by displacement, of size 0 in two passes
  wood.rib       a displaced character of quadrics and patches, wood by noise
  vase.rib       a vase of patches with two shadow maps
  patches.rib    10,000 displaced patches, a tenth of them in the picture
Made by formulas; no numbers of others."""
import math, os, sys

SHADERS = {
    'bumps.sl': '''displacement bumps(float Km = .1; float freq = 4;) {
    if (Km != 0) {
        P += Km * noise(freq * transform("shader", P)) * normalize(N);
        N = calculatenormal(P);
    }
}
''',
    'turned.sl': '''displacement turned(float Km = .2; float freq = 4;) {
    point Q = P + Km * noise(freq * transform("shader", P)) * normalize(N);
    N = calculatenormal(Q);
}
''',
    'soil.sl': '''surface soil(float Ka = .2; float Kd = .8;) {
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * Cs * (.5 + .5 * noise(transform("world", P))) * (Ka * ambient() + Kd * diffuse(Nf));
}
''',
    'grain.sl': '''surface grain(float Ka = .2; float Kd = .6; float Ks = .3; float roughness = .1;) {
    point Q = transform("shader", P);
    float r = sqrt(xcomp(Q) * xcomp(Q) + ycomp(Q) * ycomp(Q)) * 8 + noise(4 * Q);
    float ring = smoothstep(.3, .8, mod(r, 1));
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * (mix(color(.5, .3, .15), color(.25, .13, .06), ring) * (Ka * ambient() + Kd * diffuse(Nf)) +
               Ks * specular(Nf, -normalize(I), roughness));
}
''',
    'mirrored.sl': '''surface mirrored(string map = ""; float Ka = .2; float Kd = .5; float Ks = .3; float Kr = .4;) {
    normal Nf = faceforward(normalize(N), I);
    vector R = reflect(normalize(I), Nf);
    color c = 0;
    if (map != "") c = color environment(map, vtransform("world", R));
    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + Kr * c + Ks * specular(Nf, -normalize(I), .1));
}
''',
}


def numbers(values):
    return ' '.join('%.5g' % v for v in values)


def height(x, y):
    return 1.6 * math.sin(.31 * x) * math.cos(.27 * y) + .5 * math.sin(1.3 * x + .7 * y) + .12 * math.sin(4.1 * x) * math.sin(3.7 * y)


def terrain(folder, name, displacement):
    """Meshes of 24 x 24 patches, 12 x 12 of them, 10 units wide each; the eye stands above the middle."""
    out = ['Display "%s.tif" "tiff" "rgb"' % name, 'Format 640 480 1', 'PixelSamples 1 1', 'ShadingRate .25', 'Projection "perspective" "fov" 40',
           'Clipping .1 1000', 'Rotate -14 1 0 0', 'Translate 0 -4.5 0', 'WorldBegin', 'LightSource "ambientlight" 1 "intensity" .3',
           'LightSource "distantlight" 2 "from" [3 4 -2] "to" [0 0 0]', 'Surface "soil"', 'Color .5 .7 .3', 'Basis "b-spline" 1 "b-spline" 1'] + displacement
    tiles, cells, size = 12, 24, 10.
    step = size / cells
    for j in range(tiles):
        for i in range(tiles):
            x0, y0 = (i - tiles / 2) * size, (j - tiles / 2) * size
            points = []
            for b in range(cells + 3):
                for a in range(cells + 3):
                    x, y = x0 + (a - 1) * step, y0 + (b - 1) * step
                    points += [x, height(x, y), y]
            out.append('PatchMesh "bicubic" %d "nonperiodic" %d "nonperiodic" "P" [%s]' % (cells + 3, cells + 3, numbers(points)))
    write(folder, name, out + ['WorldEnd'])


def turned(profile, rings=8):
    """A surface of revolution by bicubic Bezier patches, four around (y up)."""
    k = .5522847
    around = [(1, 0), (1, k), (k, 1), (0, 1), (-k, 1), (-1, k), (-1, 0), (-1, -k), (-k, -1), (0, -1), (k, -1), (1, -k), (1, 0)]
    points = []
    for r, y in profile:
        for a, b in around:
            points += [r * a, y, r * b]
    return 'PatchMesh "bicubic" 13 "nonperiodic" %d "nonperiodic" "P" [%s]' % (len(profile), numbers(points))


POT = [(0, 0), (1, 0), (1.6, .1), (1.9, .5), (2.3, 1.1), (2, 2), (1.5, 2.6), (1.2, 3), (1, 3.3), (.6, 3.5), (.3, 3.5), (.2, 3.7), (0, 3.9)]
VASE = [(0, 0), (.6, 0), (.9, .1), (.8, .4), (.6, .9), (1.6, 1.6), (1.5, 2.5), (1.4, 3.4), (.5, 3.6), (.6, 4.2), (.65, 4.5), (.9, 4.6), (1., 4.9)]
HEAD = ['Basis "bezier" 3 "bezier" 3']


def teapots(folder):
    out = ['PixelSamples 2 2', 'ShadingRate 1', 'Exposure 1 2.2']
    lights = ['LightSource "ambientlight" 1 "intensity" .4', 'LightSource "distantlight" 2 "intensity" .8 "from" [-4 6 -7] "to" [0 0 0]']
    row = []
    for n in range(7):
        row += ['AttributeBegin', 'Translate %g 0 %g' % (5 * (n - 3), 3 * (n % 2)), turned(POT),
                'Translate 2.6 1.8 0', 'Torus .9 .2 0 360 360', 'AttributeEnd']
    bump = 'Displacement "bumps" "Km" [%g]'
    for frame, (km, eye, size) in enumerate([(0, ['Rotate 180 0 1 0', 'Translate 0 -2 0'], 256), (0, ['Rotate -90 1 0 0', 'Translate 0 -1 0'], 256),
                                             (.08, ['Translate 0 -2 13', 'Rotate -20 1 0 0'], 512)]):
        out += ['FrameBegin %d' % (frame + 1), 'Display "teapots%d.tif" "tiff" "rgb"' % frame, 'Format %d %d 1' % (size, size),
                'Projection "perspective" "fov" %d' % (90 if frame < 2 else 40)] + eye + ['WorldBegin'] + lights + HEAD
        out += ['Attribute "displacementbound" "sphere" [.1]', bump % km, 'Surface "mirrored"', 'Color 1 .6 .3'] + row
        out += ['Surface "soil"', 'Displacement "bumps" "Km" 0', 'Color .5 .5 .5', 'Patch "bilinear" "P" [-60 0 -60 60 0 -60 -60 0 60 60 0 60]', 'WorldEnd', 'FrameEnd']
    write(folder, 'teapots', out)


def wood(folder):
    out = ['Display "wood.tif" "tiff" "rgb"', 'Format 480 480 1', 'PixelSamples 2 2', 'ShadingRate 1', 'Projection "perspective" "fov" 30',
           'Translate 0 -3 16', 'Rotate -15 1 0 0', 'WorldBegin', 'LightSource "ambientlight" 1 "intensity" .3',
           'LightSource "distantlight" 2 "intensity" .9 "from" [-4 6 -7] "to" [0 0 0]', 'Surface "grain"',
           'Displacement "bumps" "Km" .06 "freq" 6', 'Attribute "displacementbound" "sphere" .08'] + HEAD
    for x, y, z, r in [(0, 4.8, 0, 1.1), (-.4, 5, -1, .2), (.4, 5, -1, .2), (-2, 3, 0, .6), (2, 3, 0, .6)]:
        out += ['AttributeBegin', 'Translate %g %g %g' % (x, y, z), 'Rotate -90 1 0 0', 'Sphere %g -%g %g 360' % (r, r, r), 'AttributeEnd']
    for x, y, z, r, h, tilt in [(0, 1.5, 0, 1.3, 2.4, 0), (-.6, -.5, 0, .5, 2, 4), (.6, -.5, 0, .5, 2, -4), (-1.4, 2.4, 0, .35, 1.6, 60), (1.4, 2.4, 0, .35, 1.6, -60)]:
        out += ['AttributeBegin', 'Translate %g %g %g' % (x, y, z), 'Rotate %g 0 0 1' % tilt, 'Rotate -90 1 0 0', 'Cylinder %g 0 %g 360' % (r, h), 'AttributeEnd']
    out += ['Patch "bilinear" "P" [-9 -.6 -9 9 -.6 -9 -9 -.6 9 9 -.6 9]', 'WorldEnd']
    write(folder, 'wood', out)


def vase(folder):
    shapes = HEAD + ['Surface "plastic"', 'Color .3 .5 .9', turned(VASE), 'Surface "matte"', 'Color .8 .8 .7',
                     'Patch "bilinear" "P" [-9 0 -9 9 0 -9 -9 0 9 9 0 9]']
    out = []
    places = [(-6, 8, -6), (5, 7, -4)]
    for n, (x, y, z) in enumerate(places):
        turn = math.degrees(math.atan2(x, -z))
        tilt = math.degrees(math.atan2(y, math.hypot(x, z)))
        out += ['FrameBegin %d' % (n + 1), 'Display "vase%d.z" "zfile" "z"' % n, 'Format 512 512 1', 'PixelSamples 1 1', 'Projection "perspective" "fov" 50',
                'Rotate %g 1 0 0' % -tilt, 'Rotate %g 0 1 0' % turn, 'Translate %g %g %g' % (-x, -y, -z), 'WorldBegin'] + shapes + \
               ['WorldEnd', 'FrameEnd', 'MakeShadow "vase%d.z" "vase%d.shd"' % (n, n)]
    out += ['FrameBegin 3', 'Display "vase.tif" "tiff" "rgb"', 'Format 480 480 1', 'PixelSamples 4 4', 'Projection "perspective" "fov" 35',
            'Translate 0 -2 11', 'Rotate -15 1 0 0', 'WorldBegin', 'LightSource "ambientlight" 1 "intensity" .2']
    for n, p in enumerate(places):
        out.append('LightSource "shadowspot" %d "shadowname" "vase%d.shd" "intensity" 60 "from" [%g %g %g] "to" [0 1 0] "coneangle" .5' % (n + 2, n, *p))
    write(folder, 'vase', out + shapes + ['WorldEnd', 'FrameEnd'])


def patches(folder):
    out = ['Display "patches.tif" "tiff" "rgb"', 'Format 320 240 1', 'PixelSamples 2 2', 'ShadingRate 1', 'Projection "perspective" "fov" 35',
           'Rotate -20 1 0 0', 'Translate 0 -6 0', 'WorldBegin', 'LightSource "ambientlight" 1 "intensity" .3',
           'LightSource "distantlight" 2 "from" [3 4 -2] "to" [0 0 0]', 'Surface "soil"', 'Displacement "bumps" "Km" .4 "freq" 3',
           'Attribute "displacementbound" "sphere" .5'] + HEAD
    for j in range(100):
        for i in range(100):
            x, z = i - 50, j - 50
            points = []
            for b in range(4):
                for a in range(4):
                    points += [x + a / 3, height(x + a / 3, z + b / 3) * .5, z + b / 3]
            out.append('Patch "bicubic" "P" [%s]' % numbers(points))
    write(folder, 'patches', out + ['WorldEnd'])


def write(folder, name, lines):
    with open(os.path.join(folder, name + '.rib'), 'w') as f:
        f.write('\n'.join(lines) + '\n')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, text in SHADERS.items():
        with open(os.path.join(folder, name), 'w') as f:
            f.write(text)
    terrain(folder, 'terrain', [])
    terrain(folder, 'terrainn', ['Displacement "turned"'])
    teapots(folder)
    wood(folder)
    vase(folder)
    patches(folder)


if __name__ == '__main__':
    main()

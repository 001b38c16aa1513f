/* slideprojector: a projector with a slide. Without a picture it throws a test card drawn by rule, so that it can be focused.
     slide       name of a texture, "" for the test card
     fov         angle of the beam, degrees
     aspect      width by height of the slide
     focus       how soft the edge is
     From the origin of shader space along +z; x is right and y is up.
   Lamp: LightSource "slideprojector" 1 "float fov" 26 "float intensity" 1.2 */
light slideprojector(
    string slide = ""; float intensity = 1, fov = 40, aspect = 1.333, focus = .01, falloff = 0;
    color lightcolor = 1;)
{
    uniform point from = point "shader" (0, 0, 0);
    uniform vector axis = vector "shader" (0, 0, 1);
    uniform float half = radians(fov) / 2;
    illuminate(from, normalize(axis), 1.5 * half) {
        point Q = transform("shader", Ps);
        float z = max(zcomp(Q), 1e-4), size = tan(half);
        float x = xcomp(Q) / (z * size), y = ycomp(Q) / (z * size) * aspect;
        float frame = (1 - smoothstep(1 - focus, 1 + focus, abs(x))) * (1 - smoothstep(1 - focus, 1 + focus, abs(y)));
        color film = 1;
        if (slide != "") {
            film = color texture(slide, .5 + .5 * x, .5 - .5 * y);
        } else {
            /* Bars of colour, a circle, a cross. */
            float bar = floor((x + 1) * 3.5);
            film = color(mod(floor(bar / 2), 2) < .5 ? .9 : .1, mod(floor(bar / 4), 2) < .5 ? .9 : .1, mod(bar, 2) < .5 ? .9 : .1);
            float r = sqrt(x * x + y * y / (aspect * aspect));
            float ring = smoothstep(.55, .57, r) - smoothstep(.6, .62, r);
            float cross = max(1 - smoothstep(.01, .03, abs(x)), 1 - smoothstep(.01, .03, abs(y)));
            film = mix(film, color(1), max(ring, cross * step(r, .6)));
        }
        Cl = intensity * lightcolor * film * frame;
        if (falloff > 0) Cl /= L . L;
    }
}

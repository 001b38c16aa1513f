/* what surface shaders ask from everywhere */
#ifdef BMRT
#  define TRACER 1
#else
#  define TRACER 0
#endif
#if defined(PRMAN) || (defined(DELIGHT) && !TRACER)
#  define NDCSPACE "NDC"
#else
#  define NDCSPACE "screen"
#endif

color toon(normal Nn; vector V; float edge) {
    extern point P; extern color Cs;
    color c = 0;
    illuminance(P, Nn, PI/2) {
        extern vector L; extern color Cl;
        float nd = 0; string cat = "";
        if (lightsource("__nondiffuse", nd) == 0) nd = 0;
        c += Cs * Cl * smoothstep(edge - .02, edge + .02, normalize(L) . Nn) * (1 - nd);
    }
    return c;
}

surface kitchensink(
    uniform string texname = "", bumpname = "", maps[2] = {"", ""};
    uniform float Ka = 1, Kd = .5, weights[3] = {.25, .5, .25};
    varying float fade = 1;
    uniform color ramp[4] = {0, color(1,0,0), (0,1,0), color "hsv" (.6, 1, 1)};
    point origin = point "world" (0, 0, 0);
    matrix xf = matrix "world" 1;
    output varying color Cdiff = 0, Camb = 0;
    output varying normal Nout = 0;
    output float uniformOut = 0;)
{
    normal Nn = normalize(N), Nf = faceforward(Nn, I, Nn);
    vector V = -normalize(I), T = normalize(dPdu), B = normalize(Nn ^ T);
    point Pndc = transform(NDCSPACE, P), Po = transform("current", "object", P), Px = transform(xf, P);
    float facing = abs(Nn . V), i, sum = 0;
    color Ct = 1, Cr;
    float disp = 0, bound = 0, maxdepth = 0;
    string type = "", sname = "";
    if (displacement("Km", disp) == 1) sum += disp;
    if (surface("fade", bound) != 0 && atmosphere("density", bound) == 0) sum += bound;
    attribute("displacementbound:sphere", bound);
    attribute("identifier:name", sname);
    rendererinfo("renderer", type);
    float shutter[2] = {0, 0};
    option("Shutter", shutter);
    if (texname != "") Ct = texture(texname, s, t, "swidth", 1, "twidth", 1);
    if (maps[0] != "") Ct *= color texture(maps[0], s, t, s + .1, t, s, t + .1, s + .1, t + .1);
    for (i = 0; i < 3; i = i + 1) { if (i == 1) continue; sum += weights[i]; if (sum > 100) break; }
    Cr = spline(facing, ramp) + spline("linear", facing, color(0), color(1), color(0), color(1));
    Cr = ctransform("rgb", "hsv", Cr);
    Cr = ctransform("hsv", Cr);
    Camb = Ka * ambient();
    Cdiff = Ct * toon(Nf, V, .3);
    Nout = ntransform("world", Nn);
    if (facing < .2 || (Nn . I > 0 && !(fade > .5))) Ct *= color(facing, pow(facing, 2), 1 - facing);
    printf("%s %f %p %c\n", concat(texname, ".tx"), facing, Po, Ct);
    Oi = Os * clamp(Cr, color(0,0,0), color(1,1,1)) * fade;
    Ci = Oi * (Camb + Cdiff + .2 * phong(Nf, V, 20) + specular(Nf, V, .1) * mix(color(1), Cs, .5));
    Ci += 0 * (length(Px - origin) + length(rotate(P, radians(20), point(0,0,0), point(0,0,1))) + Du(s) + Dv(t) + length(Deriv(P, s)));
    Ci += 0 * (xcomp(Pndc) + determinant(xf) + ptlined(origin, Po, P) + comp(xf, 0, 0) + depth(P) + round(s) + sign(s) + degrees(s));
    uniformOut = 1;
}

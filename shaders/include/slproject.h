/* The textures of SLProject's path tracer (SLGLTexture) as functions: 1D, 2D, 3D and cube maps, the texture matrix, bumps by height or
   normals, and what a name says about the kind of a texture. u runs to the right and v upward, as there; outside of 0 to 1 textures
   repeat. docs/maps.md has a page. */
#ifndef SLPROJECT_H
#define SLPROJECT_H

/* A list of colors as a picture of height 1, between texels linearly. */
color slTexture1D(color colours[]; float u)
{
    uniform float n = arraylength(colours);
    float x = (u - floor(u)) * n - .5, i = floor(x), f = x - i;
    float a = mod(i + n, n), b = mod(i + 1, n);
    return (1 - f) * colours[a] + f * colours[b];
}

/* Scale and offset of a texture matrix: m00, m11, m30, m31 */
float slU(float u, m00, m30) { return u * m00 + m30; }
float slV(float v, m11, m31) { return v * m11 + m31; }

color slTexture2D(string map; float u, v)
{
    return color texture(map, u - floor(u), 1 - (v - floor(v)));
}
color slTexture2D(string map; float u, v, m00, m11, m30, m31)
{
    return slTexture2D(map, slU(u, m00, m30), slV(v, m11, m31));
}

/* The whole texture matrix: scale, then a turn by so many degrees counterclockwise, then the offset. */
void slTransform(float u, v, scaleu, scalev, degrees, offsetu, offsetv; output float su, sv)
{
    float c = cos(radians(degrees)), s = sin(radians(degrees)), x = u * scaleu, y = v * scalev;
    su = c * x - s * y + offsetu;
    sv = s * x + c * y + offsetv;
}

/* A coordinate where it lies outside of 0 to 1: "repeat", "mirror" (every other copy turned over), "clamp" (the edge goes on) */
float slWrap(float x; string wrap)
{
    float w = x - floor(x);
    if (wrap == "clamp") w = clamp(x, 0, 1);
    else if (wrap == "mirror") {
        w = mod(x, 2);
        if (w > 1) w = 2 - w;
    }
    return w;
}

/* filter: "nearest" texel, "bilinear" between four, "mip": over the footprint, between levels of the map */
color slTexture2D(string map; float u, v; string wrapu, wrapv, filter)
{
    float s = slWrap(u, wrapu), t = 1 - slWrap(v, wrapv);
    color c = 0;
    if (filter == "nearest") {
        uniform float size[2] = {1, 1};
        textureinfo(map, "resolution", size);
        s = (min(floor(s * size[0]), size[0] - 1) + .5) / size[0];
        t = (min(floor(t * size[1]), size[1] - 1) + .5) / size[1];
    }
    if (filter == "mip") c = color texture(map, s, t);
    else c = color texture(map, s, t, s, t, s, t, s, t);
    return c;
}

/* A stack of slices over the box from lo to hi, in object space (autoCalcTM3D): "slice%03d.png", "strip.png*64", "cloud.vdb", or what
   maketx --gradients has made. 0 beside the box. */
color slTexture3D(string stack; point p, lo, hi; output float alpha; output vector gradient)
{
    point q = transform("object", p);
    point r = point((xcomp(q) - xcomp(lo)) / (xcomp(hi) - xcomp(lo)), 1 - (ycomp(q) - ycomp(lo)) / (ycomp(hi) - ycomp(lo)),
                    (zcomp(q) - zcomp(lo)) / (zcomp(hi) - zcomp(lo)));
    color c = 0;
    vector g = 0;
    float a = 0;
    texture3d(stack, r, normal(0, 0, 0), "coordsystem", "current", "filterradius", 0, "color", c, "alpha", a, "gradient", g);
    alpha = a;
    gradient = vector(xcomp(g), -ycomp(g), zcomp(g));
    return c;
}
color slTexture3D(string stack; point p, lo, hi)
{
    float a;
    vector g;
    return slTexture3D(stack, p, lo, hi, a, g);
}
/* The same over the box of the primitive that is shaded. Of a side without length the middle is taken. */
color slTexture3D(string stack; point p)
{
    uniform float b[6] = {-1, 1, -1, 1, -1, 1};
    uniform float i;
    attribute("geometry:boundingbox", b);
    for (i = 0; i < 6; i += 2)
        if (b[i] == b[i + 1]) {
            b[i] -= .5;
            b[i + 1] += .5;
        }
    return slTexture3D(stack, p, point(b[0], b[2], b[4]), point(b[1], b[3], b[5]));
}

/* Six pictures, "sky_<FACE>.png" with px nx py ny pz nz, or a cube map of maketx. The direction is one of world space. */
color slTextureCube(string faces; vector direction) { return color environment(faces, direction); }

/* Height maps: the change of the red channel over two texels, times -scale. normal maps: 2r - 1, 2g - 1. */
void slSlopes(string map, kind; float u, v, scale; output float du, dv)
{
    uniform float size[2] = {1, 1};
    du = 0;
    dv = 0;
    if (kind == "height") {
        textureinfo(map, "resolution", size);
        float x = 1 / size[0], y = 1 / size[1];
        du = -scale * (comp(slTexture2D(map, u + x, v), 0) - comp(slTexture2D(map, u - x, v), 0));
        dv = -scale * (comp(slTexture2D(map, u, v + y), 0) - comp(slTexture2D(map, u, v - y), 0));
    } else if (kind == "normal") {
        float a = u - floor(u), b = 1 - (v - floor(v));
        du = 2 * float texture(map[0], a, b) - 1;
        dv = 2 * float texture(map[1], a, b) - 1;
    }
}
/* n tilted by a bump map; t and b: where u and v grow. */
normal slBump(string map, kind; float u, v, scale; normal n; vector t, b)
{
    float du, dv;
    slSlopes(map, kind, u, v, scale, du, dv);
    return normalize(normalize(n) + normal(du * normalize(t) + dv * normalize(b)));
}

/* The kind of a texture by its name: "diffuse", "normal", "height", "specular", "roughness", "metallic", "occlusion", "font", "hdr". First
   the letters before the extension (wood_N.png), then words in the name. */
string slTextureType(string name)
{
    string kind = "diffuse";
    if (match("\\.[Hh][Dd][Rr]$", name) == 1) kind = "hdr";
    else if (match("_C\\.[A-Za-z]+$", name) == 1) kind = "diffuse";
    else if (match("_D\\.[A-Za-z]+$", name) == 1) kind = "diffuse";
    else if (match("_N\\.[A-Za-z]+$", name) == 1) kind = "normal";
    else if (match("_H\\.[A-Za-z]+$", name) == 1) kind = "height";
    else if (match("_[SG]\\.[A-Za-z]+$", name) == 1) kind = "specular";
    else if (match("_R\\.[A-Za-z]+$", name) == 1) kind = "roughness";
    else if (match("_M\\.[A-Za-z]+$", name) == 1) kind = "metallic";
    else if (match("_[OA]\\.[A-Za-z]+$", name) == 1) kind = "occlusion";
    else if (match("_F\\.[A-Za-z]+$", name) == 1) kind = "font";
    else if (match("[Cc][Oo][Ll]|[Aa][Ll][Bb][Ee][Dd][Oo]|[Dd][Ii][Ff][Ff]", name) == 1) kind = "diffuse";
    else if (match("[Nn][Rr][Mm]|[Nn][Oo][Rr][Mm]", name) == 1) kind = "normal";
    else if (match("[Dd][Ii][Ss][Pp]|[Hh][Ee][Ii][Gg][Hh][Tt]|[Bb][Uu][Mm][Pp]", name) == 1) kind = "height";
    else if (match("[Gg][Ll][Oo][Ss][Ss]|[Ss][Pp][Ee][Cc]", name) == 1) kind = "specular";
    else if (match("[Rr][Oo][Uu][Gg][Hh]", name) == 1) kind = "roughness";
    else if (match("[Mm][Ee][Tt][Aa][Ll]", name) == 1) kind = "metallic";
    else if (match("AO|[Oo][Cc][Cc]", name) == 1) kind = "occlusion";
    return kind;
}
#endif

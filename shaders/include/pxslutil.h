/* pxslUtil.h, pxslRayUtil.h: what shaders written by Slim and those of RenderMan for Maya call. */
#ifndef PXSLUTIL_H
#define PXSLUTIL_H
#include "filterwidth.h"
#include "noises.h"

/* n with length 1, turned toward the viewer where the surface has two sides or a ray hit it */
normal pxslUtilShadingNormal(normal n)
{
    extern vector I;
    uniform float sides = 2, depth = 0;
    attribute("Sides", sides);
    rayinfo("depth", depth);
    normal one = normalize(n);
    return (sides == 2 || depth > 0) ? faceforward(one, I, one) : one;
}

/* how far a position changes over one sample, from its steps along u and v: the length of both together, which is never too small, or
   the area between them, which is sharper. Displacements, whose cracks show, take the first, others the second; the first also where
   nothing is said about the kind of the shader before this file is included. */
#define pxslLooseFilterWidth(dQu, dQv) max(length(vector(dQu) + vector(dQv)), MINFILTWIDTH)
#define pxslTightFilterWidth(dQu, dQv) max(length(vector(dQu) ^ vector(dQv)), MINFILTWIDTH)
#if SLIM_SHADERTYPEID == SLIM_TYPEID_displacement
#define pxslFilterWidth(dQu, dQv) pxslLooseFilterWidth(dQu, dQv)
#else
#define pxslFilterWidth(dQu, dQv) pxslTightFilterWidth(dQu, dQv)
#endif

/* noise at p that gives way to its average where a sample, whose sides are du and dv, is larger than its features */
float pxslFilteredFNoise(point p; vector dQu, dQv) { return fadeout(float noise(p), 0.5, 1, pxslFilterWidth(dQu, dQv)); }
color pxslFilteredCNoise(point p; vector dQu, dQv) { return fadeout(color noise(p), color(0.5), 1, pxslFilterWidth(dQu, dQv)); }
/* a vector of components from -1 to 1 that vanishes there */
vector pxslFilteredVNoise(point p; vector dQu, dQv) { return vsnoise(p) * (1 - smoothstep(0.2, 0.75, pxslFilterWidth(dQu, dQv))); }

/* between four values at the corners of a square, c0 and c1 along x at y = 1, c2 and c3 along x at y = 0 */
float pxslBimix(float c0, c1, c2, c3, x, y) { return mix(mix(c2, c0, y), mix(c3, c1, y), x); }
color pxslBimix(color c0, c1, c2, c3; float x, y) { return mix(mix(c2, c0, y), mix(c3, c1, y), x); }
point pxslBimix(point c0, c1, c2, c3; float x, y) { return mix(mix(c2, c0, y), mix(c3, c1, y), x); }
vector pxslBimix(vector c0, c1, c2, c3; float x, y) { return mix(mix(c2, c0, y), mix(c3, c1, y), x); }
normal pxslBimix(normal c0, c1, c2, c3; float x, y) { return mix(mix(c2, c0, y), mix(c3, c1, y), x); }

/* between two colours, each component by its own amount */
color pxslCmix(color a, b, amount) { return (1 - amount) * a + amount * b; }

float pxslLuminance(color c) { return 0.3 * comp(c, 0) + 0.59 * comp(c, 1) + 0.11 * comp(c, 2); }

/* a colour near `average`, the same for the same seed: hue, saturation and value differ from its own by half of `variance` at most */
color pxslVaryColor(color average; float variance, seed)
{
    color hsv = ctransform("rgb", "hsv", average) + variance * (color cellnoise(seed) - color(0.5));
    return ctransform("hsv", "rgb", color(mod(comp(hsv, 0), 1), clamp(comp(hsv, 1), 0, 1), clamp(comp(hsv, 2), 0, 1)));
}

/* a direction of a map whose up is Y or Z for one whose up is another axis: "XtoY" takes X to Y, and the others in turn. "none" and
   whatever else leave it */
vector pxslEnvDirCorrect(uniform string how; vector R)
{
    vector q = R;
    float x = xcomp(R), y = ycomp(R), z = zcomp(R);
    if (how == "XtoY" || how == "YtoZ" || how == "ZtoX") q = vector(z, x, y);
    else if (how == "YtoX" || how == "ZtoY" || how == "XtoZ") q = vector(y, z, x);
    return q;
}

/* samples as the options of a scene scale them, fewer for rays of rays */
float pxslGetRaySamples(uniform float samples)
{
    uniform float all = 1, each = 1, depth = 0;
    option("user:tracebreadthfactor", all);
    option("user:tracedepthfactor", each);
    rayinfo("depth", depth);
    return floor(samples * all * pow(each, depth) + 0.5);
}

/* half the width of the patch of sky that one of so many directions stands for */
float pxslCalculateEnvSampleArea(float hemisphere, count) { return 0.5 * hemisphere / count; }

/* four directions around one */
void pxslBuildEnvironmentVectors(float spread; vector dir; output vector v1; output vector v2; output vector v3; output vector v4)
{
    vector z = normalize(dir);
    vector x = (xcomp(dir) != 0 || ycomp(dir) != 0) ? vector(ycomp(dir), -xcomp(dir), 0) : vector(0, zcomp(dir), -ycomp(dir));
    x = spread * normalize(x);
    vector y = z ^ x;
    v1 = z - x - y;
    v2 = z + x - y;
    v3 = z - x + y;
    v4 = z + x + y;
}

/* the highlight of Blinn (1977) as Maya has it: `eccentricity` is 1 / (e*e - 1), `rolloff` what is reflected straight back. Adds the
   highlight to C and the part that a shadow takes away to K. */
void rfmBlinnSpecular(vector l; color cl, unshadowed; float weight; normal n; vector v; float nv, eccentricity, rolloff, strength, depth;
                      output color C; output color K)
{
    vector ln = normalize(l), h = normalize(ln + v);
    float nh = n . h, vh = max(v . h, 1e-6), nl = n . ln;
    float d = (eccentricity + 1) / (nh * nh + eccentricity);
    float least = min(nv, nl), g = 1 / max(nv, 1e-6);
    if (2 * least * nh < vh) g = 2 * nh * least / (vh * max(nv, 1e-6));
    float f = pow(1 - vh, 3);
    color answer = weight * strength * d * d * g * (f + (1 - f) * rolloff);
    if (nl > 0) {
        C += cl * answer;
        K += (unshadowed - cl) * answer;
    }
}
#endif

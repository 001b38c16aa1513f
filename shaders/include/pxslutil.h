/* pxslUtil.h, pxslRayUtil.h: what shaders written by Slim and those of RenderMan for Maya call. */
#ifndef PXSLUTIL_H
#define PXSLUTIL_H

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

/* how far a position changes over one sample, from its steps along u and v */
float pxslFilterWidth(vector dQu, dQv) { return max(sqrt(length(dQu ^ dQv)), 1e-6); }

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

/* stdrsl/AreaSampler.h: points on the shapes of lights, in their space "shader": "rect" (x and y from -0.5 to 0.5), "disk" and "disc"
   (radius 0.5), "sphere" (radius 0.5). A negative lightPdf says that the shape is seen from behind; radiance holds s and t. */
#ifndef STDRSL_AREASAMPLER_H
#define STDRSL_AREASAMPLER_H
#include <stdrsl/Math.h>
#include <stdrsl/RadianceSample.h>
struct stdrsl_AreaSampler
{
    /* the point of the shape for two numbers from 0 to 1, with its normal and the area of the whole */
    void stdrsl_place(uniform string shape; float a, b; output point at; output normal n; output float size)
    {
        point p = point(a - 0.5, b - 0.5, 0);
        n = normal(0, 0, 1);
        size = 1;
        if (shape == "disk" || shape == "disc") {
            p = point(0.5 * sqrt(a) * cos(M_TWOPI * b), 0.5 * sqrt(a) * sin(M_TWOPI * b), 0);
            size = 0.25 * M_PI;
        } else if (shape == "sphere") {
            float z = 1 - 2 * a, r = sqrt(max(0, 1 - z * z));
            n = normal(r * cos(M_TWOPI * b), r * sin(M_TWOPI * b), z);
            p = point(0.5 * n);
            size = M_PI;
        }
        at = transform("shader", "current", p);
        n = normalize(ntransform("shader", "current", n));
        vector x = vtransform("shader", "current", vector(1, 0, 0)), y = vtransform("shader", "current", vector(0, 1, 0));
        size *= length(x ^ y);
    }
    public void generateSamples(point from; uniform string shape; uniform float count; output __radiancesample samples[])
    {
        uniform float i, first = arraylength(samples);
        resize(samples, first + count);
        for (i = 0; i < count; i += 1) {
            float a = random(), b = random();
            point at;
            normal n;
            float size;
            stdrsl_place(shape, a, b, at, n, size);
            vector to = at - from;
            float reach = length(to), faces = -(n . to) / max(reach, 1e-20);
            samples[first + i]->direction = normalize(to);
            samples[first + i]->distance = reach;
            samples[first + i]->radiance = color(a, b, 0);
            samples[first + i]->lightPdf = reach * reach / (size * max(abs(faces), 1e-6)) * (faces < 0 ? -1 : 1);
        }
    }
    /* of directions that others chose: only "rect" and the disks are looked for */
    public void evaluateSamples(point from; uniform string shape; output __radiancesample samples[])
    {
        point centre;
        normal n;
        float size;
        stdrsl_place(shape == "sphere" ? "disk" : shape, 0.5, 0.5, centre, n, size);
        uniform float i, count = arraylength(samples);
        for (i = 0; i < count; i += 1) {
            vector d = samples[i]->direction;
            float faces = -(n . d), pdf = 0;
            if (abs(faces) > 1e-6) {
                float reach = (n . (centre - from)) / (n . d);
                point hit = transform("shader", from + reach * d);
                float x = xcomp(hit), y = ycomp(hit);
                float inside = (shape == "rect") ? ((abs(x) < 0.5 && abs(y) < 0.5) ? 1 : 0) : ((x * x + y * y < 0.25) ? 1 : 0);
                if (inside == 1 && reach > 0) {
                    pdf = reach * reach / (size * faces);
                    samples[i]->radiance = color(x + 0.5, y + 0.5, 0);
                    samples[i]->distance = reach;
                }
            }
            samples[i]->lightPdf = pdf;
        }
    }
    public void generatePhoton(uniform string shape; uniform float sides; output point origin; output vector direction; output float ss, tt, size)
    {
        normal n;
        ss = random();
        tt = random();
        stdrsl_place(shape, ss, tt, origin, n, size);
        vector x = normalize(vtransform("shader", "current", vector(1, 0, 0)));
        x = normalize(x - (x . n) * n);
        float a = M_TWOPI * random(), r = random();
        direction = sqrt(r) * (cos(a) * x + sin(a) * (n ^ x)) + sqrt(1 - r) * vector(n);
        if (sides == 2 && random() < 0.5) direction = -direction;
    }
}
#endif

/* Where a ray meets a sphere about the origin. */
#ifndef RAYSPHERE_H
#define RAYSPHERE_H
/* From E in the direction I, sphere of radius r: the number of hits farther than eps, their distances in t0 and t1. */
float raysphere(point E; vector I; float r; output float t0, t1; float eps)
{
    float b = 2 * (vector(E) . I), c = vector(E) . vector(E) - r * r, a = I . I;
    float discriminant = b * b - 4 * a * c, hits = 0;
    if (discriminant > 0) {
        float root = sqrt(discriminant);
        t0 = (-b - root) / (2 * a);
        t1 = (-b + root) / (2 * a);
        if (t0 > eps) hits = 2;
        else if (t1 > eps) {
            t0 = t1;
            hits = 1;
        }
    }
    return hits;
}
#endif

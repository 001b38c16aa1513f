/* Where a ray meets a sphere about the origin. */
#ifndef RAYSPHERE_H
#define RAYSPHERE_H
/* From E in the direction I, sphere of radius r: the number of hits farther than eps, their distances in t0 and t1. */
float raysphere(point E; vector I; float r; float eps; output float t0, t1)
{
    float a = I . I, b = vector(E) . I, c = vector(E) . vector(E) - r * r, inside = b * b - a * c, hits = 0;
    if (inside >= 0) {
        float root = sqrt(inside), near = (-b - root) / a, far = (-b + root) / a;
        if (near > eps) {
            t0 = near;
            t1 = far;
            hits = inside > 0 ? 2 : 1;
        } else if (far > eps) {
            t0 = far;
            hits = 1;
        }
    }
    return hits;
}
#endif

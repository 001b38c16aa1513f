struct Ray { point org; vector dir; float tmin = 1e-4; float tmax = 1e30; };
struct Hit { Ray r; float t; color c = color(0.5); string what = "none"; };
Ray makeRay(point o; vector d) { Ray r; r->org = o; r->dir = normalize(d); return r; }
Hit intersect(Ray r; point centre; float radius)
{
    Hit h; h->r = r; h->t = -1;
    vector oc = r->org - centre;
    float b = oc . r->dir, cc = oc . oc - radius * radius, disc = b*b - cc;
    if (disc > 0) { h->t = -b - sqrt(disc); h->what = "sphere"; }
    return h;
}
point at(Ray r; float t) { return r->org + t * r->dir; }
surface structs()
{
    Ray rays[3]; Hit best; best->t = 1e30;
    uniform float i;
    for (i = 0; i < 3; i += 1) {
        rays[i] = makeRay(P, I + vector(0.1 * i));
        Hit h = intersect(rays[i], point(0, 0, 5), 1);
        if (h->t > 0 && h->t < best->t) best = h;
    }
    Ci = (best->what == "sphere") ? best->c : color(0);
    Ci += length(at(best->r, 0.5) - P);
    Oi = 1;
}

// RSL 2: where a shader reads a map, as four corners in s and t or as four directions or points. `blurred` is given to the map as
// its "blur"; `spread` is the half angle of the cone of directions, in radians.
struct filterregion {
    varying float s1 = 0, t1 = 0, s2 = 0, t2 = 0, s3 = 0, t3 = 0, s4 = 0, t4 = 0;
    varying vector v1 = 0, v2 = 0, v3 = 0, v4 = 0, centre = 0;
    varying float blurred = 0, spread = 0;
    public void calculate2d(varying float x, y) {
        extern float du, dv;
        calculate2d(x, y, Du(x) * du, Du(y) * du, Dv(x) * dv, Dv(y) * dv);
    }
    public void calculate2d(varying float x, y, x1, y1, x2, y2) {
        float ax = 0.5 * x1, ay = 0.5 * y1, bx = 0.5 * x2, by = 0.5 * y2;
        s1 = x - ax - bx; s2 = x + ax - bx; s3 = x - ax + bx; s4 = x + ax + bx;
        t1 = y - ay - by; t2 = y + ay - by; t3 = y - ay + by; t4 = y + ay + by;
        centre = vector(x, y, 0);
        blurred = 0;
    }
    public void calculate3d(varying vector x) {
        extern float du, dv;
        calculate3d(x, Du(x) * du, Dv(x) * dv);
    }
    public void calculate3d(varying vector x, side1, side2) {
        vector a = 0.5 * side1, b = 0.5 * side2;
        v1 = x - a - b; v2 = x + a - b; v3 = x - a + b; v4 = x + a + b;
        centre = x;
        spread = atan(max(length(a), length(b)), length(x));
        blurred = 0;
    }
    public void calculate3d(varying vector x; varying vector other) { calculate3d(x); }
    public void scale(float x, y) {
        float ms = 0.25 * (s1 + s2 + s3 + s4), mt = 0.25 * (t1 + t2 + t3 + t4);
        s1 = mix(ms, s1, x); s2 = mix(ms, s2, x); s3 = mix(ms, s3, x); s4 = mix(ms, s4, x);
        t1 = mix(mt, t1, y); t2 = mix(mt, t2, y); t3 = mix(mt, t3, y); t4 = mix(mt, t4, y);
        float k = max(x, y);
        v1 = centre + k * (v1 - centre); v2 = centre + k * (v2 - centre);
        v3 = centre + k * (v3 - centre); v4 = centre + k * (v4 - centre);
        spread *= k;
    }
    public void scale(float k) { scale(k, k); }
    public void blur(float b) { blurred += b; spread += b; }
    public void blur(float x, y) { blur(max(x, y)); }
}

float pattern (float x, y; float fuzz) {
    return smoothstep(.3-fuzz,.3+fuzz,mod(x,1)) * smoothstep(.3-fuzz,.3+fuzz,mod(y,1));
}
color pattern (float x, y, fuzz; color a, b) {
    return mix(a, b, pattern(x, y, fuzz));
}
point jitter(point q; float amt) { return q + amt * (point cellnoise(q) - point(.5,.5,.5)); }
float jitter(float q; float amt) { return q + amt * (float cellnoise(q) - .5); }
void split(float x; output float i; output float f;)
{
    i = floor(x); f = x - i;
}
color ramp(float v) { uniform color c[4] = { color(0,0,0), color(1,0,0), color(1,1,0), color(1,1,1) };
    float i, f; split(clamp(v,0,.999)*3, i, f);
    return mix(c[i], c[i+1], f); }
surface functions(float fuzz = .05)
{
    float getv() { extern float s, t; return s*t; }
    void add(output color c; color by) { c += by; }
    color out = pattern(s*8, t*8, fuzz, color(1,0,0), color(0,0,1));
    add(out, ramp(getv()));
    add(out, .1*color jitter(P, .2));
    out *= jitter(s, .1);
    Ci = out; Oi = 1;
}

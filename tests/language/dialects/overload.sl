color pick(string s0) { return (s0 == "a") ? color(1,0,0) : color(0,0,1); }
float pick(string s0) { return (s0 == "a") ? 1 : 2; }
string pick(string s0) { return concat(s0, "_"); }
point pick(point p0; float k) { return p0 * k; }
vector pick(vector p0; float k) { return p0 + k; }
normal up() { return normal(0, 1, 0); }
vector up() { return vector(0, 0, 1); }
surface overload(string w = "a")
{
    float f = pick(w); color c = pick(w); string st = pick(w);
    point q = pick(P, 2); vector v0 = pick(I, 2); normal n0 = up(); vector v2 = up();
    c += color pick(st) + float pick("b");
    if (float noise(P) > .5 && pick("a") == 1) c *= 2;
    Ci = c * f * (n0 . v2) + color(v0 . v0) + length(q - P); Oi = Os;
}

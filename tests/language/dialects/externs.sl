/* extern in every place that people tried, prototypes, unnamed prototype parameters, default of functions' locals */
float outer(float x, float);
color shade(normal n; vector v; float r);
float outer(float x, float y) { extern uniform float gain; extern point P; return gain * x + y * length(P); }
color shade(normal n; vector v; float r)
{
    extern color Cs; extern varying color tint; extern string model;
    color c = 0;
    if (model == "lambert") c = diffuse(n);
    else if (model == "phong") c = diffuse(n) + phong(n, v, 1/r);
    else { extern float t, s; c = color(s, t, 0); }
    return c * Cs * tint;
}
surface externs(uniform float gain = 1; varying color tint = 1; string model = "phong")
{
    extern point P; extern vector I; extern color Ci, Oi; extern normal N;
    float local = 2;
    float inner(float z) { extern float local; extern float gain; return local * z * gain; }
    Ci = shade(normalize(N), -normalize(I), .1) * outer(1, inner(2));
    Oi = 1;
}

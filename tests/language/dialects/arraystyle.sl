/* arrays, tuples and functions of points */
#define RP(x) ((x)+0.5)
point rot(point p; float a) { return rotate(p, a, point "current" (0,0,0), point "current" (0,1,0)); }
float luma(color c) { return .3*comp(c,0)+.59*comp(c,1)+.11*comp(c,2); }
surface arraystyle(string lname = "x", pass = "beauty"; float array[5] = {1,2,3}; point pts[2] = {point(0,0,0), (1,1,1)};)
{
    uniform float n = arraylength(array), i;
    vector v[3]; color acc[2];
    acc[0] = color(0); acc[1] = acc[0];
    v[0] = vector(1,0,0); v[1] = v[0]; v[2] = -v[1];
    for (i=0; i<n; i+=1) { if (array[i] == 3) break; }
    if (pass == "beauty" && lname != "") Ci = luma(Cs);
    else if (pass == "shadow" || pass == "z") Ci = 0;
    float x = (P . P), y = (x > 0) ? sqrt(x) : 0;
    point q = rot(P, PI/3) * 2 / 3;
    vector w = (dPdu ^ dPdv) / 2;
    float k = w.N/length(w);
    Ci += acc[0] * k;
    Ci = max(Ci, color(0)); Ci = min(Ci, 1);
    Ci *= 1.0 - -0.5;
    if (u>.5 && v[1]==v[0]) { Ci = Cs; }
}

float sumof(float a[]) { uniform float i; float s0 = 0; for (i = 0; i < arraylength(a); i += 1) s0 += a[i]; return s0; }
void fill(output float a[]; float n; float v) { uniform float i; resize(a, 0); for (i = 0; i < n; i += 1) push(a, v * i); }
void fixed3(output color c[3]) { uniform float i; for (i = 0; i < 3; i += 1) c[i] = color(i / 3); }
surface arrays(float w[] = {1, 2, 3}; color pal[4] = {color(1,0,0), color(0,1,0), color(0,0,1)}; string tex[] = {"a.tx", "b.tx"};)
{
    float a[]; float b[5] = {1}; color c3[3]; float fromlist[] = {4, 5, 6, 7};
    uniform string names[2]; names[0] = "one"; names[1] = concat(names[0], "two");
    fill(a, 4, 2);
    fixed3(c3);
    reserve(a, 100);
    a[0] += pop(a);
    b = {9, 8, 7};
    float k = sumof(a) + sumof(w) + sumof(b) + sumof(fromlist) + capacity(a);
    color col = 0; uniform float i;
    for (i = 0; i < arraylength(tex); i += 1) if (tex[i] != "") col += color texture(tex[i], s, t);
    for (i = 0; i < 4; i += 1) col += pal[i];
    Ci = col * k + c3[2]; Oi = 1;
}

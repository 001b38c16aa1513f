surface large() {
    float a[16384], b[16384], c[16384], d[16384], e[16384], f[16384], g[16384], h[16384];
    uniform float i;
    for (i = 0; i < 16384; i += 1) { a[i] = s + i; h[16383 - i] = a[i] * t; }
    Oi = 1;
    Ci = color(a[5], h[7], b[0] + c[1] + d[2] + e[3] + f[4] + g[6]);
}

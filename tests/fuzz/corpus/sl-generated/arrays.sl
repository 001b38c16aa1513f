surface st() {
    matrix m[16384];
    uniform float i;
    for (i = 0; i < 16384; i += 1) m[i] = matrix s;
    Ci = comp(m[3], 0, 0);
}

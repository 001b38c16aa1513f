/* loops with levels, early returns, else chains, nested ternaries, empty statements */
float find(string key; uniform string keys[4]; uniform float values[4])
{
    uniform float i;
    for (i = 0; i < 4; i += 1) {
        if (keys[i] == key) return values[i];
        if (keys[i] == "") break;
    }
    return -1;
}
surface branches(string key = "b"; float n = 5)
{
    float a = 0, b = 0, i, j;
    for (i = 0; i < n; i += 1)
        for (j = 0; j < n; j += 1) {
            if (j > i) continue;
            if (i + j > 6) break 2;
            if (mod(i, 2) == 1) continue 2;
            a += 1;
        }
    while (true_ () > 0 && b < 3) b += 1;
    do { b -= 1; } while (b > 0);
    ;;
    { { } ; }
    if (a > 1) ; else b = 2;
    float v0 = find(key, {"a", "b", "c", ""}, {1, 2, 3, 4});
    color c = (v0 > 2) ? color(1, 0, 0) : (v0 > 1) ? color(0, 1, 0) : (v0 < 0) ? Cs : 0;
    if (a) c *= 2;
    if (!(a > 0) || (b <= 2 && v0 != 0)) c += 0.1;
    Ci = c; Oi = (a > b) ? Os : color(1);
}
float true_() { return 1; }

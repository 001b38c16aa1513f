/* warns: missing-extern missing-extern read-only-copy read-only-copy light-variable not-output semicolon-in-call expected-semicolon no-effect function-redefined stray-brace varying-to-uniform */
float half_(float x) { return x / 2; }
float half_(float x) { return x * scale; }
color tinted() { return tint * half_(2); }
surface sloppytwo(float scale = .5 color tint = 1; float k = 3;)
{
    I = normalize(I);
    u = max(u; v);
    k = k + xcomp(Ns);
    k == 3;
    Ci = tinted() * k;
    Oi = Os;
}
}

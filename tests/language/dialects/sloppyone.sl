/* warns: no-default untyped-parameter number-suffix cast-parentheses not-rsl not-rsl varying-to-uniform comma-statements stray-semicolon */
surface sloppyone(float Kd; float Ks = 1.0f; rough = .2);
{
    uniform float fu = u;
    float i, x = (float) Kd;
    for (i = 0; i < 3; i++) x += i % 2;
    x = 1, x *= 2;
    Ci = x * Ks * rough * fu; Oi = Os;
}

/* quilted: padding sewn down along two families of lines, with a button where they cross.
     cells    around u; half as many along v
     puff     how high the padding stands
     button   size of a button, as a part of a cell */
displacement quilted(float cells = 14, puff = .08, button = .12;)
{
    float a = u * cells + v * cells / 2, b = u * cells - v * cells / 2;
    float x = abs(sin(PI * a)), y = abs(sin(PI * b));
    float pad = pow(x * y, .4);
    float corner = sqrt(pow(mod(a + .5, 1) - .5, 2) + pow(mod(b + .5, 1) - .5, 2));
    float knob = 1 - smoothstep(button * .7, button, corner);
    P += puff * (pad + .4 * knob) * smoothstep(0, .08, v) * (1 - smoothstep(.92, 1, v)) * normalize(N);
    N = calculatenormal(P);
}

/* checker: squares of two colours, averaged where they are smaller than what a point covers.
     frequency   squares along s, and along t
     blackcolor  the other colour; the first is Cs */
surface checker(float frequency = 10, Ka = 1, Kd = .8; color blackcolor = color(.05, .05, .06);)
{
    /* The average of a square wave over an interval is a difference of its integral. */
    float wave(float x, w) {
        float integral(float y) { return .5 * floor(y) + min(.5, y - floor(y)); }
        float half = max(w, 1e-5) / 2;
        return (integral(x + half) - integral(x - half)) / (2 * half);
    }
    float ss = s * frequency / 2, tt = t * frequency / 2;
    float a = wave(ss, abs(Du(ss) * du) + abs(Dv(ss) * dv));
    float b = wave(tt, abs(Du(tt) * du) + abs(Dv(tt) * dv));
    float white = a * b + (1 - a) * (1 - b);
    Oi = Os;
    Ci = Os * mix(blackcolor, Cs, white) * (Ka * ambient() + Kd * diffuse(faceforward(normalize(N), I)));
}

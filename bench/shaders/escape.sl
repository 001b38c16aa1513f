// The Mandelbrot set: every point leaves its loop when it wants to, after at most 64 turns, with a branch inside.
surface escape(float turns = 64;)
{
    float a = 3.2 * u - 2.3, b = 2.6 * v - 1.3;
    float x = 0, y = 0, n = 0, least = 1000;
    while (n < turns) {
        float xx = x * x, yy = y * y;
        if (xx + yy > 4) break;
        y = 2 * x * y + b;
        x = xx - yy + a;
        if (y > 0) least = min(least, abs(x));
        else least = min(least, xx + yy);
        n += 1;
    }
    Ci = color(n / turns, sqrt(n / turns), least);
    Oi = 1;
}

// Eight rounds of sin cos pow exp log sqrt and atan, each depending on the one before.
surface transcendental()
{
    float x = 0.2 + 2 * u, y = 0.3 + 3 * v, z = 0, turn;
    for (turn = 0; turn < 8; turn += 1) {
        float a = sin(x - z), b = cos(y + a);
        float c = pow(0.3 + abs(b), 1.5 - 0.3 * a);
        float d = log(1.5 + exp(-c) * c);
        float e = sqrt(d + a * a);
        z = 0.3 * z + 0.6 * atan(e, 0.4 + y);
        x = 0.85 * x + 0.2 * e;
        y = 0.75 * y + 0.3 * z;
    }
    Ci = color(x, y, z);
    Oi = 1;
}

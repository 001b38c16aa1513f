// OSL: sine and cosine of an angle in radians.
void sincos(float angle; output float sine, cosine) {
    sine = sin(angle);
    cosine = cos(angle);
}

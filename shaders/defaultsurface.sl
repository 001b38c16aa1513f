/* defaultsurface: what a primitive without a surface shader shows under "hidden" and "raytrace": visible without any light. Ball: Color [.5 .7 .4] Surface "defaultsurface" */
surface defaultsurface(float Ka = 0.2, Kd = 0.8;) {
    float d = I . N;
    d = d * d / max((I . I) * (N . N), 1e-30);
    Oi = Os;
    Ci = Os * Cs * (Ka + Kd * d);
}

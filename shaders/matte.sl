/* matte: an ideal diffuse surface. RISpec standard shader. Ball: Color [.8 .6 .3] Surface "matte" */
surface matte(float Ka = 1, Kd = 1;) {
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Kd * diffuse(Nf));
}

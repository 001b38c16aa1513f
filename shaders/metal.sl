/* metal: a rough metal lit by highlights in its own colour. RISpec standard shader. Ball: Color [.9 .7 .3] Surface "metal" "float Ks" 1 */
surface metal(float Ka = 1, Ks = 1, roughness = 0.1;) {
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness));
}

/* shinymetal: metal that also mirrors an environment map, looked up in world space. RISpec standard shader. */
surface shinymetal(float Ka = 1, Ks = 1, Kr = 1, roughness = 0.1; string texturename = "";) {
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    vector V = -In;
    color mirrored = 0;
    if (texturename != "") {
        vector D = vtransform("world", reflect(In, Nf));
        mirrored = Kr * color environment(texturename, D);
    }
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness) + mirrored);
}

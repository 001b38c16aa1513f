/* bumpy: displaces along the normal by a texture. RISpec standard shader; Km is an old name of amplitude. */
displacement bumpy(float amplitude = 1, Km = 1; string texturename = "";) {
    if (texturename != "") {
        P += amplitude * Km * float texture(texturename) * normalize(N);
        N = calculatenormal(P);
    }
}

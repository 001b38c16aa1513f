/* ambientlight: the same light from everywhere. RISpec standard shader. */
light ambientlight(float intensity = 1; color lightcolor = 1;) {
    Cl = intensity * lightcolor;
}

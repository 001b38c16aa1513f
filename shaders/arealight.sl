/* arealight: the plainest emitter: intensity * lightcolor is the radiance that leaves the front of its surface. */
light arealight(float intensity = 1; color lightcolor = 1;) {
    illuminate(P, N, PI / 2)
        Cl = intensity * lightcolor;
}

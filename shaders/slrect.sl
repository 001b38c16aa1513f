/* slrect: SLProject's rectangular light: an area light of constant radiance, one-sided. Use with AreaLightSource on a rectangle. */
light slrect(float intensity = 1; color lightcolor = 1;) {
    illuminate(P, N, PI / 2)
        Cl = intensity * lightcolor;
}

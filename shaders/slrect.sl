/* slrect: SLProject's rectangular light: an area light of constant radiance, one-sided. Use with AreaLightSource on a rectangle. Lamp: AttributeBegin AreaLightSource "slrect" 1 "float intensity" 80 Surface "constant" Disk 0 .7 360 AttributeEnd Illuminate 1 1 */
light slrect(float intensity = 1; color lightcolor = 1;) {
    illuminate(P, N, PI / 2)
        Cl = intensity * lightcolor;
}

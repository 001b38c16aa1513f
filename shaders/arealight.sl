/* arealight: the emitter of old scenes, made for BMRT: intensity falls with the square of the distance, as pointlight's does, so numbers are
   of the order of that square. The renderer reads it as the radiance pi intensity / area of its surface; slrect takes the radiance itself.
   Lamp: AttributeBegin AreaLightSource "arealight" 1 "float intensity" 38 Surface "constant" Disk 0 .7 360 AttributeEnd Illuminate 1 1 */
light arealight(float intensity = 1; color lightcolor = 1;) {
    illuminate(P, N, PI / 2)
        Cl = intensity / (L . L) * lightcolor;
}

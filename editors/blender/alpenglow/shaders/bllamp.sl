/* A surface that emits to both sides: Blender's Emission on a mesh. */
light bllamp(color radiance = 1;) {
    illuminate(P, N, PI)
        Cl = radiance;
}

/* Blender's area light: one side of a flat shape. */
light blarea(color radiance = 1;) {
    illuminate(P, N, PI / 2)
        Cl = radiance;
}

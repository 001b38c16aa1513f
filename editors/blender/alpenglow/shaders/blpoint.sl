/* A point light of Blender without a radius. intensity: watts per steradian over pi. */
light blpoint(color intensity = 1;) {
    illuminate(point "shader" (0, 0, 0))
        Cl = intensity / (L . L);
}

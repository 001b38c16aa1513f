/* A spot light of Blender, along -z of "shader". edge: cosine of half the spot size; blend: part of the cone that is soft;
   falling 1: light falls
   with the cosine, too, as up to Blender 3.5. As an area light (on a sphere) intensity is radiance, at a point watts per
   steradian over pi. */
light blspot(color intensity = 1; float edge = .9, blend = .15, falling = 1, area = 0;) {
    vector axis = normalize(vtransform("shader", "current", vector(0, 0, -1)));
    float soft = (1 - edge) * blend;
    if (area == 1) {
        illuminate(P, N, PI / 2) {
            float c = normalize(L) . axis, k = (c <= edge) ? 0 : (soft <= 0) ? 1 : smoothstep(0, 1, (c - edge) / soft);
            Cl = intensity * k * ((falling == 1) ? c : 1);
        }
    } else {
        illuminate(point "shader" (0, 0, 0), axis, acos(edge)) {
            float c = normalize(L) . axis, k = (c <= edge) ? 0 : (soft <= 0) ? 1 : smoothstep(0, 1, (c - edge) / soft);
            Cl = intensity * k * ((falling == 1) ? c : 1) / (L . L);
        }
    }
}

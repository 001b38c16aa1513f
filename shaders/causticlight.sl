/* causticlight: light that mirrors and glass throw on a surface, from the photon map of Attribute "photon" "causticmap". Under "path" rays find that
   light without a map and without this light.
   Ball: LightSource "causticlight" 1 LightSource "pointlight" 2 "float intensity" 38 "point from" [-3 4 1] */
light causticlight(color filter = 1; output float __nonspecular = 1;) {
    vector n = normalize(faceforward(Ns, I, Ns));
    illuminate(Ps + n)
        Cl = filter * caustic(Ps, n);
}

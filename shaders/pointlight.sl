/* pointlight: light from one point, falling with the square of the distance. RISpec standard shader. Lamp: LightSource "pointlight" 1 "float intensity" 38 */
light pointlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);) {
    illuminate(from)
        Cl = intensity * lightcolor / (L . L);
}

/* sldirect: SLProject's directional light. docs/design/slproject.md. Lamp: LightSource "sldirect" 1 "float intensity" 3 */
light sldirect(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);) {
    solar(to - from, 0)
        Cl = intensity * lightcolor / PI;
}

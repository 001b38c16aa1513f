/* Blender's sun, along -z of "shader". irradiance: on a surface across it; half: half of its angle in the sky, radians. */
light blsun(color irradiance = 1; float half = 0;) {
    solar(vtransform("shader", "current", vector(0, 0, -1)), half)
        Cl = irradiance / PI;
}

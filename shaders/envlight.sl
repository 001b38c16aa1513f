/* envlight: a sky. Light from every direction that escapes the scene; seen by rays under "path".
   intensity * lightcolor is its radiance. */
light envlight(float intensity = 1; color lightcolor = 1;) {
    solar()
        Cl = intensity * lightcolor;
}

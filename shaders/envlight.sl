/* envlight: a sky. Light from every direction that escapes the scene; seen by rays under "path".
   intensity * lightcolor is its radiance, times that of the map, if there is one: of a latitude-longitude picture or a cube map, whose poles
   are the z axis of the space mapspace; blur widens its lookups, as a part of the map. Where the map is bright lights are sampled.
   Ball: LightSource "envlight" 1 "float intensity" 1 */
light envlight(float intensity = 1; color lightcolor = 1; string mapname = "", mapspace = "shader"; float blur = 0;) {
    solar() {
        Cl = intensity * lightcolor;
        if (mapname != "")
            Cl *= color environment(mapname, vtransform(mapspace, -L), "blur", blur);
    }
}

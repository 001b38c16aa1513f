/* indirect: what other surfaces send back, as diffuse light; the name under which BMRT's scenes ask for radiosity. Under "path" the renderer finds
   that light itself, so that this one gives nothing there. Elsewhere rays are sent over the hemisphere of the surface, as many as "samples" says, or
   where that is 0 Attribute "irradiance" "nsamples"; Option "trace" "maxdepth" says how many bounces.
   Ball: LightSource "indirect" 1 LightSource "pointlight" 2 "float intensity" 38 "point from" [-3 4 1] */
light indirect(float samples = 0; color filter = 1; output float __nonspecular = 1;) {
    uniform string hider = "hidden";
    option("Ri:Hider", hider);
    uniform float count = samples;
    if (count <= 0) {
        count = 0;
        attribute("irradiance:nsamples", count);
        if (count <= 0)
            count = 64;
    }
    vector n = normalize(faceforward(Ns, I, Ns));
    illuminate(Ps + n) {
        if (hider != "path")
            Cl = filter * trace(Ps, n, "type", "diffuse", "distribution", "cosine", "samplecone", PI / 2, "samples", count);
    }
}

/* deepsun: parallel light whose shadows are looked up in a deep shadow map: coloured behind glass, soft in fog. See
   examples/deepshadow.rib. */
light deepsun(string map = ""; float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
              point to = point "shader" (0, 0, 1); float bias = 0.02, samples = 64, blur = 0.002;)
{
    solar(to - from, 0) {
        Cl = intensity * lightcolor;
        if (map != "")
            Cl *= 1 - color shadow(map, Ps, "bias", bias, "samples", samples, "blur", blur);
    }
}

/* layered: a surface made of co-shaders. Every co-shader of the scene that is of category "layer" is a coat over those before it, in the order of
   their handles; each answers through its method shade(color, cover, shine, roughness). The mixture is lit once.
     only    a category expression: which layers are used
     Ka      of ambient light
   Ball: Shader "layer_paint" "a" Shader "layer_rust" "b" Shader "layer_dust" "c" Surface "layered" */
class layered(float Ka = 1; string only = "layer";)
{
    color tint = .5;
    float shine = 0, rough = .1;

    /* One more coat. */
    void coat(shader layer) {
        color c = 0;
        float cover = 0, ks = 0, r = .1;
        layer->shade(c, cover, ks, r);
        tint = mix(tint, c, cover);
        shine = mix(shine, ks, cover);
        rough = mix(rough, r, cover);
    }

    public void surface(output color Ci, Oi) {
        shader layers[] = getshaders("category", only);
        uniform float i;
        for (i = 0; i < arraylength(layers); i += 1) coat(layers[i]);
        normal Nf = faceforward(normalize(N), I);
        Oi = Os;
        Ci = Os * Cs * (tint * (Ka * ambient() + diffuse(Nf)) + shine * specular(Nf, -normalize(I), rough));
    }
}

/* layer_paint: a coat for "layered": glossy paint, whole, with streaks of the brush.
     paint    colour
     streaks  how much they show
   Ball: Shader "layer_paint" "a" Surface "layered" */
class layer_paint(color paint = color(.08, .3, .36); float streaks = .2, gloss = .5; string __category = "layer";)
{
    public void shade(output color c; output float cover; output float ks; output float r) {
        c = paint * (1 + streaks * (noise(u * 12, v * 160) - .5));
        cover = 1;
        ks = gloss;
        r = .06;
    }
}

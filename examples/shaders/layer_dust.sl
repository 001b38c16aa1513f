/* layer_dust: a coat for "layered": dust, lying on what points up in "world".
     up      the way up
     amount  how much
   Ball: Shader "layer_paint" "a" Shader "layer_dust" "c" "float amount" 1 Surface "layered" */
class layer_dust(vector up = vector "world" (0, 1, 0); float amount = .7; color dust = color(.62, .57, .48); string __category = "layer,weather";)
{
    public void shade(output color c; output float cover; output float ks; output float r) {
        extern point P;
        extern normal N;
        point Q = transform("shader", P);
        float flat = normalize(vector(N)) . normalize(up);
        cover = amount * smoothstep(.15, .75, flat + .35 * (noise(Q * 6) - .5) + .2 * (noise(Q * 25) - .5));
        c = dust * (.85 + .3 * noise(Q * 60));
        ks = 0;
        r = .6;
    }
}

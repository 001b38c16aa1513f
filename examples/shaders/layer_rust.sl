/* layer_rust: a coat for "layered": rust in patches, running down from them.
     amount   how much
     scale    patches in a unit of shader space
   Ball: Shader "layer_rust" "b" "float amount" .7 Surface "layered" */
#include "noises.h"

class layer_rust(float amount = .5, scale = 2.4; color oxide = color(.36, .13, .04); string __category = "layer,weather";)
{
    public void shade(output color c; output float cover; output float ks; output float r) {
        extern point P;
        point Q = transform("shader", P) * scale;
        float width = filterwidthp(Q);
        float patch = .5 + .8 * fBm(point(xcomp(Q), ycomp(Q), .55 * zcomp(Q)), width, 7, 2, .55);
        cover = smoothstep(.95 - amount, 1.05 - amount, patch);
        c = oxide * (1 + .8 * fBm(Q * 7, width * 7, 4, 2, .5));
        ks = 0;
        r = .5;
    }
}

/* mapblock: what a stack of slices has at P, in a box of object space from -1 to 1: cut the box open and the inside shows. */
#include "slproject.h"
surface mapblock(string stack = ""; float Kd = 1, Ka = .15;)
{
    normal Nf = faceforward(normalize(N), I);
    Ci = slTexture3D(stack, P, point(-1, -1, -1), point(1, 1, 1)) * (Ka + Kd * diffuse(Nf));
    Oi = 1;
}

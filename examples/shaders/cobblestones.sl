/* cobblestones: rounded stones with deep joints, in shader space. A displacement; the surface shader can ask for "height" and for "stone", the
   number of the stone, by displacement("height", h).
     scale     stones in a unit of shader space
     depth     of the joints */
#include "noises.h"

displacement cobblestones(float scale = 3.5, depth = .12; output varying float height = 0; output varying float stone = 0;)
{
    point Q = transform("shader", P) * scale;
    float f1, f2;
    point a, b;
    voronoi_f1f2_3d(Q, .75, f1, a, f2, b);
    stone = cellnoise(a * 3);
    height = sqrt(smoothstep(0, .7, f2 - f1)) * (.8 + .4 * stone) + .06 * snoise(Q * 6);
    P += depth * (height - .6) * normalize(N);
    N = calculatenormal(P);
}

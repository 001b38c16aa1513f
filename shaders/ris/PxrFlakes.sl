/* PxrFlakes: normals that lean from flake to flake, of RIS, for metallic paint: cells of a cellular pattern of flakeFreq, jittered, each leaning at random by flakeAmount; density is the part of them that is there (resultA 1),
   size the part of a cell that a flake fills; octaves of half the size join, each where those before it have none. Noises are this program's. */
#include "rispattern.h"
surface PxrFlakes(varying normal inputNormal = 0; varying float flakeAmount = .5, flakeFreq = 57.3, density = 1, size = 1; float octaves = 1; varying float jitter = .75; float validateNormals = 0; RIS_MANIFOLD;
                  output varying normal resultN = 0; output varying float resultA = 0) {
    RIS_PLACE(place);
    normal n = normalize((inputNormal . inputNormal > 0) ? inputNormal : N);
    resultN = n;
    float i, frequency = flakeFreq;
    for (i = 0; i < 4; i += 1) {
        if (i < octaves && resultA == 0) {
            point q = frequency * place, cell = point(floor(xcomp(q)) + .5, floor(ycomp(q)) + .5, floor(zcomp(q)) + .5), best = cell;
            float least = 1e9, x, y, z;
            for (x = -1; x <= 1; x += 1)
                for (y = -1; y <= 1; y += 1)
                    for (z = -1; z <= 1; z += 1) {
                        point c = cell + vector(x, y, z);
                        point f = c + jitter * (vector cellnoise(c) - vector(.5, .5, .5));
                        float d = distance(f, q);
                        if (d < least) {
                            least = d;
                            best = c;
                        }
                    }
            if (float cellnoise(best + vector(37, 0, 0)) < density && least <= .87 * size) {
                vector lean = 2 * (vector cellnoise(best + vector(0, 91, 0)) - vector(.5, .5, .5));
                resultN = normalize(n + flakeAmount * normal lean);
                if (validateNormals != 0 && resultN . I > 0) resultN = n;
                resultA = 1;
            }
        }
        frequency *= 2;
    }
}

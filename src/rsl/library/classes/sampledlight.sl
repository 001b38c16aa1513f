// A class light that sends its light through generateSamples() (PRMan; front/classlights.cpp): light() asks for the samples and
// puts each into one place of two outputs, from which loops over lights take a turn each (world/bindlights.cpp).
// PLACES: how many there are. PHOTONS: it has generatePhoton(), whose results are four more outputs, of which kernels are made
// only for photons. SHADOWED: the renderer traces the shadows of the samples. CASTS: the class does, in shadowSamples().
// ONLY: its own light() says zero, so the samples are all its light.
class sampledlight(output varying vector __sentL[PLACES] = {0}; output varying color __sentCl[PLACES] = {0};
#ifdef PHOTONS
                   output varying point __photonFrom = 0; output varying vector __photonWay = 0;
                   output varying color __photonPower = 0; output varying float __photonPdf = 0;
#endif
#ifdef SHADOWED
                   uniform float __sentShadows = 1;
#endif
#ifdef ONLY
                   uniform float __sentOnly = 1;
#endif
) {
    // A sample with radiance R and density pdf, one of n, adds R / (pi pdf n) to Cl, which is irradiance over pi. A density of 0
    // marks a place without a sample. Samples beyond PLACES share places: of two one is kept, with a probability proportional to
    // its luminance, and stands for both.
    public void light(output vector L; output color Cl) {
#ifdef PHOTONS
        generatePhoton(__photonFrom, __photonWay, __photonPower, __photonPdf);
#endif
        __radiancesample sent[];
        generateSamples("sphere", sent);
#ifdef CASTS
        shadowSamples(sent);
#endif
        uniform float i, n = arraylength(sent);
        float counted = 0;
        for (i = 0; i < n; i += 1)
            if (sent[i]->lightPdf != 0) counted += 1;
        color sum = 0;
        for (i = 0; i < n; i += 1) {
            uniform float place = mod(i, PLACES);
            if (sent[i]->lightPdf > 0) {
                color c = sent[i]->radiance / (PI * sent[i]->lightPdf * counted);
                vector way = -min(sent[i]->distance, 1e15) * normalize(sent[i]->direction);
                float had = luminance(__sentCl[place]), comes = luminance(c);
                if (i < PLACES || had <= 0) {
                    __sentL[place] = way;
                    __sentCl[place] = c;
                } else if (comes > 0) {
                    if (random() * (had + comes) < comes) {
                        __sentL[place] = way;
                        __sentCl[place] = c * ((had + comes) / comes);
                    } else {
                        __sentCl[place] *= (had + comes) / had;
                    }
                }
                sum += c;
            }
        }
        L = __sentL[0];
        Cl = sum;
    }
}

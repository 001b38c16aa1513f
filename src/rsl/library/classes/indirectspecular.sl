// indirectspecular(this, ...) of a class (PRMan): rays in the directions that generateSamples() draws, weighted by its densities
// (front/classlighting.cpp). The parameters are the tokens of the call, with the values that it has without them.
class indirectspecular() {
    // a class without this method draws no samples
    void generateSamples(string which; output __radiancesample samples[]) {}

    color __indirect(float bias = -1; float maxdist = 1e38; uniform string label = ""; uniform string subset = "";
                     uniform string hitmode = ""; uniform string hitsides = ""; point position = 1e38) {
        extern point P;
        point from = position[0] < 1e38 ? position : P;
        __radiancesample samples[];
        generateSamples("specular", samples);
        uniform float i, n = arraylength(samples);
        color sum = 0;
        for (i = 0; i < n; i += 1)
            if (samples[i]->materialPdf > 0)
                sum += trace(from, samples[i]->direction, "bias", bias, "maxdist", maxdist, "label", label, "subset", subset,
                             "hitmode", hitmode, "hitsides", hitsides)
                    * samples[i]->materialResponse / (n * samples[i]->materialPdf);
        return sum;
    }
}

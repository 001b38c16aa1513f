// PRMan: called behind each lobe of evaluateSamples(), it adds up the responses and densities of the lobes.
void accumulateMaterialResponse(output __radiancesample samples[]) {
    uniform float i, n = arraylength(samples);
    for (i = 0; i < n; i += 1) {
        samples[i]->summedResponse += samples[i]->materialResponse;
        samples[i]->summedPdf += samples[i]->materialPdf;
        samples[i]->materialResponse = samples[i]->summedResponse;
        samples[i]->materialPdf = samples[i]->summedPdf;
    }
}

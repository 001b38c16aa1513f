// PRMan: the samples are counts[0] of the first lobe, then counts[1] of the second, and so on. Loops over samples take one mean
// over all of them; the factor n / count makes each lobe count in full.
void normalizeMaterialResponse(output __radiancesample samples[]; uniform float counts[]) {
    uniform float lobes = arraylength(counts), n = arraylength(samples), first = 0, lobe, i;
    for (lobe = 0; lobe < lobes; lobe += 1) {
        uniform float last = min(n, first + counts[lobe]);
        for (i = first; i < last; i += 1) samples[i]->materialResponse *= n / counts[lobe];
        first = last;
    }
}

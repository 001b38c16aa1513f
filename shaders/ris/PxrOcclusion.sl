/* PxrOcclusion: what the integrator of that name shows of all surfaces, of RIS: how much of the hemisphere is open, as far as maxDistance (0: all the way). Not done: cosineSpread, falloff, useAlbedo. */
surface PxrOcclusion(float numSamples = 4, numBxdfSamples = 0, maxDistance = 0, cosineSpread = 1, falloffMode = 0, falloff = 0, useAlbedo = 0, distribution = 1) {
    normal n = faceforward(normalize(N), I);
    Oi = 1;
    Ci = 1 - occlusion(P, n, 0, "maxdist", (maxDistance > 0) ? maxDistance : 1e30, "samples", 1);
}

/* PxrVolumeGrid: what PxrVolume becomes inside of Volume "blobbydso:impl_openvdb": its extinction is the grid gridName of gridFile (OpenVDB, or what else texture3d() reads), over gridBound of its space, times densityFloat,
   densityColor and extinctionMultiplier. The way through it is marched in steps of stepSize, at most maxSteps of them, each at random within its part; at each the lights are asked. Unlike PxrVolume light scatters once, on its
   way to the eye: what scattered before is lost, and what lies between is marched in shadowSteps steps. diffuseColor, emitColor, contributionMultiplier, anisotropy, anisotropy2 and blendFactor are as there. */
volume PxrVolumeGrid(string gridFile = "", gridName = "density"; uniform float gridBound[6] = {-1, 1, -1, 1, -1, 1}; color diffuseColor = 1, emitColor = 0; float multiScatter = 0; vector velocity = 0;
                     float velocityMultiplier = 1; string densityFloatPrimVar = ""; float densityFloat = 1; string densityColorPrimVar = ""; color densityColor = 1; float maxDensity = -1, anisotropy = 0, anisotropy2 = 0, blendFactor = 0,
                     equiangularWeight = .5, minSamples = 4, maxSamples = 4, stepSize = .1, maxSteps = 256, shadowSteps = 8, multiScatterOpt = 0, extinctionMultiplier = 1, contributionMultiplier = 1;) {
    uniform color unit = densityFloat * densityColor * extinctionMultiplier, none = 0, all = 1;
    uniform color albedo = clamp(diffuseColor * contributionMultiplier, none, all);
    uniform float g = clamp(mix(anisotropy, anisotropy2, blendFactor), -.999, .999);
    uniform float wide = max(gridBound[1] - gridBound[0], 1e-12), high = max(gridBound[3] - gridBound[2], 1e-12), deep = max(gridBound[5] - gridBound[4], 1e-12);
    /* Extinction per densityFloat at a point of the grid's space. */
    float at(point q;) {
        float density = 0;
        texture3d(gridFile, point((xcomp(q) - gridBound[0]) / wide, (ycomp(q) - gridBound[2]) / high, (zcomp(q) - gridBound[4]) / deep), normal(0, 0, 0), "coordsystem", "current", gridName, density);
        return max(density, 0);
    }
    /* How far it is from x along d to the end of [low, top]. */
    float until(float x, d, low, top;) { return (d > 0) ? (top - x) / d : (d < 0) ? (low - x) / d : 1e30; }
    color kept(float thick;) { return color(exp(-comp(unit, 0) * thick), exp(-comp(unit, 1) * thick), exp(-comp(unit, 2) * thick)); }
    float way = length(I), steps = clamp(ceil(way / max(stepSize, 1e-6)), 1, clamp(maxSteps, 1, 4096)), step = way / steps, offset = random(), i;
    uniform float shadows = clamp(floor(shadowSteps), 0, 256);
    vector ahead = normalize(I);
    point start = P - I;
    color left = 1, glow = 0;
    for (i = 0; i < steps; i += 1) {
        point Q = start + (i + offset) * step * ahead, q = transform("shader", Q);
        float density = at(q);
        if (density > 0) {
            color lit = 0;
            illuminance(Q) {
                /* Light on its way to Q loses what the grid takes. */
                vector toward = vtransform("shader", normalize(L));
                float far = max(min(min(until(xcomp(q), xcomp(toward), gridBound[0], gridBound[1]), until(ycomp(q), ycomp(toward), gridBound[2], gridBound[3])),
                                    min(until(zcomp(q), zcomp(toward), gridBound[4], gridBound[5]), length(L))), 0);
                float thick = 0, k, turned = mod(offset + .618034 * i, 1);
                for (k = 0; k < shadows; k += 1) thick += at(q + (k + turned) / shadows * far * toward);
                if (shadows > 0) thick *= far / shadows;
                /* Henyey and Greenstein, of light in the units of illuminance: PI times the phase function. */
                lit += Cl * kept(thick) * (1 - g * g) / (4 * pow(max(1 + g * g - 2 * g * (normalize(L) . ahead), 1e-6), 1.5));
            }
            color through = kept(density * step);
            glow += left * (1 - through) * (albedo * lit + emitColor * contributionMultiplier);
            left *= through;
        }
    }
    Ci = Ci * left + glow;
    Oi = 1 - (1 - Oi) * left;
}

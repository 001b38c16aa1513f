/* PxrVolume: a homogeneous volume that absorbs, scatters and glows, of RIS, as a volume shader: for Interior. Parameters and defaults
   are those of Pixar's documentation.
     densityFloat, densityColor: extinction of a scene unit, multiplied; diffuseColor: part of it that scatters; emitColor: radiance
       that a unit of density adds. extinctionMultiplier multiplies densities, contributionMultiplier what scatters and glows
   Unlike there: one lobe of Henyey and Greenstein (anisotropy; anisotropy2 and blendFactor are blended into its mean); densities
   of primitive variables (density*PrimVar), velocity, and what chooses samples are not read. Light scatters any number of times. */
volume PxrVolume(color diffuseColor = 1, emitColor = 0; float multiScatter = 0; vector velocity = 0; float velocityMultiplier = 1;
                 string densityFloatPrimVar = ""; float densityFloat = 1; string densityColorPrimVar = ""; color densityColor = 1;
                 float maxDensity = -1, anisotropy = 0, anisotropy2 = 0, blendFactor = 0, equiangularWeight = .5, minSamples = 4,
                     maxSamples = 4, stepSize = .1, multiScatterOpt = 0, extinctionMultiplier = 1, contributionMultiplier = 1;
                 output color __absorption = 0, __scattering = 0, __emission = 0; output float __anisotropy = 0, __priority = 0;)
{
    uniform color extinction = densityFloat * densityColor * extinctionMultiplier, zero = 0, one = 1;
    __scattering = extinction * clamp(diffuseColor * contributionMultiplier, zero, one);
    __absorption = extinction - __scattering;
    __emission = extinction * emitColor * contributionMultiplier;
    __anisotropy = mix(anisotropy, anisotropy2, blendFactor);
    float way = length(I), k;
    color left = 1, glow = 0;
    for (k = 0; k < 3; k += 1) {
        float x = comp(extinction, k) * way;
        setcomp(left, k, exp(-x));
        setcomp(glow, k, comp(__emission, k) * way * ((x < .0001) ? 1 - x / 2 : (1 - exp(-x)) / x));
    }
    Ci = Ci * left + glow;
    Oi = 1 - (1 - Oi) * left;
}

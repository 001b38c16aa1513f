/* PxrAdjustNormal: a normal of a bump or map, weaker or stronger, of RIS: what it adds to the surface's normal times adjustAmount, then mixed with the surface's by surfaceNormalMix. */
surface PxrAdjustNormal(varying normal inputNormal = 0; varying float adjustAmount = 1, surfaceNormalMix = 0; output varying normal resultN = 0) {
    normal n = normalize(N), given = (inputNormal . inputNormal > 0) ? normalize(inputNormal) : n;
    if (given . n < 0) given = -given;
    given = normalize(n + adjustAmount * (given - n));
    resultN = normalize(mix(given, n, surfaceNormalMix));
}

/* PxrDisplace: moves the surface, of RIS: by dispAmount * dispScalar along its normal, and by dispAmount * dispVector in the space of the shader; modelDispVector likewise. enabled 0: not. Attribute "displacementbound" as for
   all displacement. */
displacement PxrDisplace(float enabled = 1, reallyEnabled = 1; varying float dispAmount = .1, dispScalar = 0; varying vector dispVector = 0, modelDispVector = 0) {
    if (enabled != 0) {
        P += dispAmount * dispScalar * vector normalize(N) + vtransform("shader", "current", dispAmount * (dispVector + modelDispVector));
        N = calculatenormal(P);
    }
}

/* PxrShadedSide: 1 where the front of the surface is shaded and 0 at its back, of RIS; invert 1: the other way round. The manual does not say which
   side is 1. */
surface PxrShadedSide(float invert = 0; output varying float resultF = 0, result = 0; output varying color resultRGB = 0) {
    resultF = (N . I < 0) ? 1 : 0;
    if (invert != 0) resultF = 1 - resultF;
    result = resultF;
    resultRGB = resultF;
}

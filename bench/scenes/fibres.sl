/* Hair, all four lobes, combed along v. */
surface fibres(color absorption = color(.3, .6, 1); float azimuthal = .3;) {
    float lobes[16] = {1, .035, .2, azimuthal, 1, .035, .2, azimuthal, 1, .035, .3, azimuthal, 1, .035, .3, azimuthal};
    Oi = 1;
    Ci = Cs * trace(P, normalize(dPdv), "distribution", "hair", "absorption", absorption, "lobeparameters", lobes, "wo", -normalize(I),
                    "samplearealights", 1, "type", "specular");
}

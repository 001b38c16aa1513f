/* clamptoalpha: no channel above alpha; a classic of the nineties. */
imager clamptoalpha() {
    Ci = clamp(Ci, color(0), color(alpha));
}

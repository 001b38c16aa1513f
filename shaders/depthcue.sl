/* depthcue: fades to a background colour with depth between the clipping planes. RISpec standard shader. Ball: Atmosphere "depthcue" "float mindistance" .00003 "float maxdistance" .0001 */
volume depthcue(float mindistance = 0, maxdistance = 1; color background = 0;) {
    float d = clamp((depth(P) - mindistance) / (maxdistance - mindistance), 0, 1);
    Ci = mix(Ci, background, color(d));
    Oi = mix(Oi, color(1), color(d));
}

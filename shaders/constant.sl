/* constant: the colour of the primitive, without light. RISpec standard shader. */
surface constant() {
    Oi = Os;
    Ci = Os * Cs;
}

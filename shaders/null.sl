/* null: draws nothing. */
surface null() {
    Ci = 0;
    Oi = 0;
}

/* PxrDot: the dot product of two vectors, of RIS. */
surface PxrDot(varying vector vector1 = 0, vector2 = 0; output varying float result = 0, resultF = 0) {
    result = vector1 . vector2;
    resultF = result;
}

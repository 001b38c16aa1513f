// A class that says by emit() in prelighting() what its surface sends (PRMan; front/classlights.cpp): light() sends the sum from
// the surface of a primitive, into the half space above it.
class emittinglight(uniform float __emits = 1;) {
    varying color __emitted = 0;

    public void light(output vector L; output color Cl) {
        color c = 0, o = 1;
        __emitted = 0;
        prelighting(c, o);
        illuminate(P, N, PI / 2) Cl = __emitted;
    }
}

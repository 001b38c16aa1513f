// A class light with a light() of its own and generatePhoton() (PRMan; front/classlights.cpp): what that gives is four outputs, of
// which kernels are made only for photons.
class photonlight(output varying point __photonFrom = 0; output varying vector __photonWay = 0;
                  output varying color __photonPower = 0; output varying float __photonPdf = 0;) {
    void __givePhoton() { generatePhoton(__photonFrom, __photonWay, __photonPower, __photonPdf); }
}

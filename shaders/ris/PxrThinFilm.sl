/* PxrThinFilm: the colours of a thin film in air, of RIS, on six bands of the spectrum (wavelengths of 425 to 675 nm, two for each channel): a band is times
   1 - cos(4 pi eta thickness cos(theta) / wavelength), theta in the film, whose mean is 1. thickness is in nanometres, times thicknessScale; eta varies by spread from
   red to blue. frontOnly 1: backs keep their colour. */
#include "rispattern.h"
surface PxrThinFilm(varying color inputRGB = 1; varying float eta = 1.5, spread = .01, thickness = 1896, thicknessScale = 1; float frontOnly = 0; RIS_RGB) {
    float band(float i, c;) {
        float n = eta + spread * (.5 - i / 5), inside = sqrt(max(0, 1 - (1 - c * c) / (n * n)));
        return 1 - cos(4 * PI * n * thickness * thicknessScale * inside / (425 + 50 * i));
    }
    float c = -normalize(I) . normalize(N);
    color film = color(band(4, c) + band(5, c), band(2, c) + band(3, c), band(0, c) + band(1, c)) / 2;
    resultRGB = (frontOnly != 0 && c < 0) ? inputRGB : inputRGB * film;
    RIS_CHANNELS
}

/* PxrHairColor: colours of natural hair by its melanin, of RIS. mode 0: a melanin of 0 (white) to 1 (black), which becomes absorption as d'Eon et al. (2011, An Energy-Conserving Hair Reflectance Model) mix
   eumelanin and pheomelanin; 1: color. Each hair (hairIndexPrimvar) has random parts of its own; strayDensity of them are strays. dye multiplies; resultDiff and resultTRT are for light that crosses the hair twice, resultTT for once.
   Not done: colorSpace, darkenRoots, random dye. */
#include "rispattern.h"
surface PxrHairColor(float mode = 0, colorSpace = 0; varying float melanin = .2; varying color color_ = color(0, .3, .1); varying float randomMelanin = .05; varying color randomColor = .05;
                     varying float darkenRoots = 0, darkenSlope = 1, darkenEndPosition = .5, strayDensity = .1, strayMelanin = .05; varying color strayColor = .05; varying float strayRandomMelanin = 0; varying color strayRandomColor = 0;
                     varying color dye = 1; varying float randomDyeHue = 0, randomDyeSaturation = 0; string hairIndexPrimvar = ""; float randPivot = .5, randSeed = 0, viewIndexRandom = 0;
                     output varying color resultDiff = 0, resultTT = 0, resultTRT = 0) {
    float hair = 0;
    if (hairIndexPrimvar != "") getvar(null, hairIndexPrimvar, hair);
    hair += 17.3 * randSeed;
    float stray = (hairIndexPrimvar != "" && risRandom(hair, 1) < strayDensity) ? 1 : 0, shift = (hairIndexPrimvar == "") ? 0 : risRandom(hair, 2) - randPivot;
    color c;
    if (mode == 0) {
        float m = clamp(mix(melanin, strayMelanin, stray) + shift * 2 * mix(randomMelanin, strayRandomMelanin, stray), 0, .999);
        float quantity = -log(max(1 - m, 1e-4));
        color absorbed = quantity * color(.419, .697, 1.37);
        c = color(exp(-comp(absorbed, 0)), exp(-comp(absorbed, 1)), exp(-comp(absorbed, 2)));
    } else {
        c = clamp(mix(color_, strayColor, color(stray)) + 2 * shift * mix(randomColor, strayRandomColor, color(stray)), color(0), color(1));
    }
    c *= dye;
    if (viewIndexRandom != 0) c = color(risRandom(hair, 3), risRandom(hair, 4), risRandom(hair, 5));
    resultDiff = c;
    resultTT = risPower(c, color(.5));
    resultTRT = c;
}

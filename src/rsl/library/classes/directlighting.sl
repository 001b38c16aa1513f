// directlighting(this, ...) of a class (PRMan): a loop over the lights that asks evaluateSamples() what the material makes of each
// (front/classlighting.cpp). A light at a point or far away sends Cl as for diffuse(): a white surface that it stands straight
// over gives Cl. Materials answer per steradian, hence the factor of pi. With LIGHTS the call names the lights.
// LOOP: the category of these loops; HANDLES: the most lights of a list.
#ifdef LIGHTS
#define METHOD __directof
#else
#define METHOD __direct
#endif
class directlighting() {
    // where the outputs go that a call does not ask for
    varying color __diffuseresult = 0, __specularresult = 0, __unshadoweddiffuseresult = 0, __unshadowedspecularresult = 0;

    // a class without this method has a material that returns no light
    void evaluateSamples(string which; output __radiancesample samples[]) {}

    // part: 0 all, 1 the diffuse part, 2 the specular part. angle: of the cone about the normal, in radians.
    color METHOD(uniform float part; uniform float angle;
#ifdef LIGHTS
                 shader lights[];
#endif
                 output color diffuseresult; output color specularresult; output color unshadoweddiffuseresult;
                 output color unshadowedspecularresult) {
        extern point P;
        extern normal N;
        diffuseresult = 0;
        specularresult = 0;
        illuminance(LOOP, P, shadingnormal(N), angle) {
            float asked = 1;
#ifdef LIGHTS
            uniform float k, count = arraylength(lights);
            // a list that is full need not name all lights
            if (count < HANDLES) asked = 0;
            for (k = 0; k < count && asked == 0; k += 1) if (lights[k] == light) asked = 1;
#endif
            if (asked != 0) {
                __radiancesample one[1];
                one[0]->direction = normalize(L);
                one[0]->distance = length(L);
                one[0]->radiance = Cl;
                one[0]->lightPdf = 1;
                evaluateSamples("diffuse", one);
                diffuseresult += PI * Cl * one[0]->materialResponse;
                one[0]->materialResponse = 0;
                one[0]->materialPdf = 0;
                one[0]->summedResponse = 0;
                one[0]->summedPdf = 0;
                evaluateSamples("specular", one);
                specularresult += PI * Cl * one[0]->materialResponse;
            }
        }
        unshadoweddiffuseresult = diffuseresult;
        unshadowedspecularresult = specularresult;
        return (part == 1) ? diffuseresult : (part == 2) ? specularresult : diffuseresult + specularresult;
    }
}

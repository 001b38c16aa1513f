/* PxrStdAreaLight: the primitives that follow in its attribute block shine, on everything: of PRMan 19 and 20.
   Radiance is lightColor * intensity * 2^exposure, tinted by temperature where enableTemperature is 1. It is divided by the area unless areaNormalize is 0, so
   that the size does not change the power. emissionFocus, coneAngle and coneSoftness shape the beam.
   enableShadows 0: what is in the way lets its light pass.
   Not done: other shadow parameters, thinShadow and traceLightPaths. Lamp: Light "PxrStdAreaLight" "l" "float intensity" 5 */
#include "rislight.h"
light PxrStdAreaLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500;
         float areaNormalize = 1, emissionFocus = 0, emissionFocusNormalize = 0; color emissionFocusTint = 0;
         float coneAngle = 90, coneSoftness = 0, specular = 1, diffuse = 1; string rman__Shape = "", rman__LightName = "";
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    vector X = vtransform("shader", "current", vector(1, 0, 0)), Y = vtransform("shader", "current", vector(0, 1, 0)),
           Z = vtransform("shader", "current", vector(0, 0, 1));
    uniform float area = 1;
    if (areaNormalize != 0) attribute("light:area", area);
    color radiance = risRadiance(intensity, exposure, lightColor, enableTemperature, temperature);
    if (areaNormalize != 0) radiance /= area;
    if (emissionFocusNormalize != 0) radiance *= (2 + emissionFocus) / 2;
    illuminate(P, N, PI / 2) {
        float cosine = normalize(L) . normalize(N);
        Cl = radiance * risShape(cosine, emissionFocus, emissionFocusTint, coneAngle, coneSoftness);
        Cl = risFiltered(Cl * risProfile(lightProfile, iesProfileScale, vtransform("shader", L)), lightFilters, lightFilterMaps, lightFilterLinks, P, Ps);
    }
}

/* PxrDiskLight: a disk, 1 across, that shines along +z, of RIS.
   Radiance is lightColor * intensity * 2^exposure, tinted by temperature where enableTemperature is 1; areaNormalize divides it by the
   area, so that the size does not change the power. emissionFocus, coneAngle and coneSoftness shape the beam.
   enableShadows 0: what is in the way lets its light pass.
   Not done: other shadow parameters, thinShadow and traceLightPaths. Lamp: Light "PxrDiskLight" "l" "float intensity" 5 */
#include "rislight.h"
light PxrDiskLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500;
         float areaNormalize = 0, emissionFocus = 0, emissionFocusNormalize = 0; color emissionFocusTint = 0;
         float coneAngle = 90, coneSoftness = 0, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    vector X = vtransform("shader", "current", vector(1, 0, 0)), Y = vtransform("shader", "current", vector(0, 1, 0)),
           Z = vtransform("shader", "current", vector(0, 0, 1));
    float area = PI / 4 * length(X ^ Y);
    color radiance = risRadiance(intensity, exposure, lightColor, enableTemperature, temperature);
    if (areaNormalize != 0) radiance /= area;
    if (emissionFocusNormalize != 0) radiance *= (2 + emissionFocus) / 2;
    illuminate(P, N, PI / 2) {
        float cosine = normalize(L) . normalize(N);
        Cl = radiance * risShape(cosine, emissionFocus, emissionFocusTint, coneAngle, coneSoftness);
        Cl = risFiltered(Cl * risProfile(lightProfile, iesProfileScale, vtransform("shader", L)), lightFilters, lightFilterMaps, lightFilterLinks, P, Ps);
    }
}

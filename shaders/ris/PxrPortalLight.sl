/* PxrPortalLight: a window, 1 across in x and y, that lets the light of a dome in along +z, of RIS. Its radiance is what the dome's map domeColorMap
   has behind it, by the matrix portalToDome or the dome's space domeSpace ("world", turned so that z is up, when neither is given), times
   intensity * 2^exposure * tint; so a portal is its part of the dome, which need not be there. Not done: portalName and inheriting from a dome by name. Lamp: Light "PxrPortalLight" "l" "float intensity" 5 */
#include "rislight.h"
light PxrPortalLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500; color tint = 1; float intensityMult = 1;
         string domeColorMap = "", domeSpace = "", portalName = ""; matrix portalToDome = 1;
         color colorMapGamma = 1; float colorMapSaturation = 1, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    color radiance = intensityMult * tint * risRadiance(intensity, exposure, lightColor, enableTemperature, temperature);
    float there = risMap(domeColorMap);
    float turned = (comp(portalToDome, 0, 0) != 1 || comp(portalToDome, 1, 1) != 1 || comp(portalToDome, 2, 2) != 1) ? 1 : 0;
    illuminate(P, N, PI / 2) {
        Cl = radiance;
        if (there != 0) {
            vector w;
            if (turned != 0) w = vtransform(portalToDome, vtransform("shader", -L));
            else if (domeSpace != "") w = vtransform(domeSpace, -L);
            else {
                vector v = vtransform("world", -L);
                w = vector(xcomp(v), -zcomp(v), ycomp(v));
            }
            Cl *= risMapped(color environment(domeColorMap, risLatLong(w)), colorMapGamma, colorMapSaturation);
        }
        Cl = risFiltered(Cl, lightFilters, lightFilterMaps, lightFilterLinks, P, Ps);
    }
}

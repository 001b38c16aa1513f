/* PxrPortalLight: a window, 1 across in x and y, that lets the light of a dome in along +z, of RIS. Its radiance is what the dome's map domeColorMap
   has behind it, by the map's space domeSpace ("world", turned so that z is up, when not given), times intensity * 2^exposure * tint; so a portal is its
   part of the dome, which need not be there. Not done: portalName and inheriting from a dome by name. Lamp: Light "PxrPortalLight" "l" "float intensity" 5 */
#include "rislight.h"
light PxrPortalLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500; color tint = 1; float intensityMult = 1;
         string domeColorMap = "", domeSpace = "", portalToDome = "", portalName = "";
         color colorMapGamma = 1; float colorMapSaturation = 1, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = "") {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    color radiance = intensityMult * tint * risRadiance(intensity, exposure, lightColor, enableTemperature, temperature);
    illuminate(P, N, PI / 2) {
        Cl = radiance;
        if (domeColorMap != "") {
            vector w = vtransform((domeSpace == "") ? "world" : domeSpace, -L);
            if (domeSpace == "") w = vector(xcomp(w), -zcomp(w), ycomp(w));
            Cl *= color environment(domeColorMap, w);
        }
    }
}

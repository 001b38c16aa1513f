/* PxrStdEnvMapLight: a sky all around, of PRMan 19 and 20. Radiance is lightColor * intensity * 2^exposure times that of the map,
   tinted by temperature where enableTemperature is 1. The map is of latitudes and longitudes (or a cube map); its top is +z of the
   light's space, its middle -x, a quarter from its left edge -y. colorMapGamma and colorMapSaturation are applied to it; where it cannot
   be read there is none. Under "path" where it is bright lights are sampled. Not done: shadow parameters, portals
  . Ball: Light "PxrStdEnvMapLight" "l" "float intensity" 1 */
#include "rislight.h"
light PxrStdEnvMapLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500; color envtint = 1;
         string lightColorMap = "", rman__EnvMap = "", rman__LightName = ""; color colorMapGamma = 1; float colorMapSaturation = 1, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    color radiance = risRadiance(intensity, exposure, lightColor, enableTemperature, temperature) * envtint;
    string map = (rman__EnvMap != "") ? rman__EnvMap : lightColorMap;
    float there = risMap(map);
    solar() {
        Cl = radiance;
        if (there != 0) Cl *= risMapped(color environment(map, risLatLong(vtransform("shader", -L))), colorMapGamma, colorMapSaturation);
        Cl = risFiltered(Cl, lightFilters, lightFilterMaps, lightFilterLinks, Ps - 1e5 * normalize(L), Ps);
    }
}

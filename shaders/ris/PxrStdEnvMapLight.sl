/* PxrStdEnvMapLight: a sky all around, of PRMan 19 and 20. Radiance is lightColor * intensity * 2^exposure times that of the map,
   tinted by temperature where enableTemperature is 1. The map is of latitudes and longitudes (or a cube map) about the z axis of the light's space;
   colorMapGamma is applied to it. Under "path" where it is bright lights are sampled. Not done: colorMapSaturation, shadow parameters, portals
   and light filters. Ball: Light "PxrStdEnvMapLight" "l" "float intensity" 1 */
#include "rislight.h"
light PxrStdEnvMapLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500; color envtint = 1;
         string lightColorMap = "", rman__EnvMap = "", rman__LightName = ""; color colorMapGamma = 1; float colorMapSaturation = 1, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = "") {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    color radiance = risRadiance(intensity, exposure, lightColor, enableTemperature, temperature) * envtint;
    string map = (rman__EnvMap != "") ? rman__EnvMap : lightColorMap;
    solar() {
        Cl = radiance;
        if (map != "") {
            color seen = environment(map, vtransform("shader", -L));
            Cl *= color(pow(max(0, comp(seen, 0)), 1 / comp(colorMapGamma, 0)), pow(max(0, comp(seen, 1)), 1 / comp(colorMapGamma, 1)),
                        pow(max(0, comp(seen, 2)), 1 / comp(colorMapGamma, 2)));
        }
    }
}

/* PxrDistantLight: a far disk, angleExtent degrees across, that shines along +z, of RIS. Its radiance is lightColor * intensity * 2^exposure (that of the sun is
   some 50000); with areaNormalize that is its irradiance across the direction instead. An extent of 0 counts as .53. enableShadows 0: what is in the way lets its light pass. Not done:
   distance and other shadow parameters. Lamp: Light "PxrDistantLight" "l" "float intensity" 50000 */
#include "rislight.h"
light PxrDistantLight(float intensity = 1, exposure = 0; color lightColor = 1; float enableTemperature = 0, temperature = 6500; float angleExtent = .53, areaNormalize = 0, distance = 10000, specular = 1, diffuse = 1;
         output float __nondiffuse = 0; output float __nonspecular = 0; string __group = "", lightGroup = ""; RIS_SHAPED) {
    __nondiffuse = 1 - diffuse;
    __nonspecular = 1 - specular;
    float extent = (angleExtent > 0) ? min(angleExtent, 179) : .53, half = radians(extent / 2), low = sin(half / 2);
    color radiance = risRadiance(intensity, exposure, lightColor, enableTemperature, temperature);
    if (areaNormalize != 0) radiance /= PI * sin(half) * sin(half);
    solar(vector "shader" (0, 0, 1), half)
        Cl = risFiltered(4 * low * low * radiance, lightFilters, lightFilterMaps, lightFilterLinks, Ps - 1e5 * normalize(L), Ps); /* 2 (1 - cos half): a cone's Cl is what all of it brings, over pi */
}

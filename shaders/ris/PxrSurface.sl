/* PxrSurface: diffuse light, two reflections, clear coat, iridescence, fuzz, subsurface, single scattering, glass and glow, added up,
   of RIS. Parameters and defaults are those of Pixar's documentation.
     *FresnelMode 0: from FaceColor to EdgeColor by FresnelShape; else EdgeColor times Fresnel's law of Ior and ExtinctionCoeff
     *ModelType 0: Beckmann, 1: GGX; the width of slopes is the squared roughness. specularEnergyCompensation and
       clearcoatEnergyCompensation, 0 as there, are the part of what a layer reflects that it takes from those below
     unitLength: scene units in a millimetre, of subsurfaceDmfp and its like
     refractionGain replaces diffuse and subsurface light by light that comes through
   Unlike there: both sides are shaded (DoubleSided is not read); iridescence is that of mode 0; single scattering and all
   types of subsurface are random walks; fuzz is diffuse light weighted by what a sheen reflects in all; ssAlbedo, extinction and g
   of the inside are not read (Interior "medium"); mw*, shadowMode, userColor, inputMaterial neither.
   Ball: Surface "ris/PxrSurface" "color diffuseColor" [.5 .1 .05] "color specularFaceColor" [.1 .1 .1] "color specularEdgeColor" [1 1 1] */
#include "rislobes.h"
surface PxrSurface
#include "pxrsurface.h"

/* PxrBakeTexture: hands its colour (or number, resultF) on, of RIS. Pictures need no more; nothing is baked: bake() and bake3d() of RSL make textures here. */
#include "rispattern.h"
surface PxrBakeTexture(varying color inputRGB = 0; varying float inputF = 0; string filename = ""; float atlasStyle = 0, bakeMode = 1, renderMode = 0; string display = "texture", displayFormat = "openexr", displayType = "half", displayCompression = "zip"; float resolutionX = 512, resolutionY = 512; string primVar = "st", primVar2 = "", activeUdim = "";
            RIS_RGB; output varying float resultF = 0) {
    resultRGB = inputRGB;
    resultF = inputF;
    RIS_CHANNELS
}

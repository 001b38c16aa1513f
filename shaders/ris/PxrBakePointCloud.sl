/* PxrBakePointCloud: hands its colour (or number, resultF) on, of RIS. Pictures need no more; nothing is baked: bake() and bake3d() of RSL make point clouds here. */
#include "rispattern.h"
surface PxrBakePointCloud(varying color inputRGB = 0; varying float inputF = 0; string filename = ""; float bakeMode = 1; string display = "pointcloud"; float density = 10; string coordsys = "object";
            RIS_RGB; output varying float resultF = 0) {
    resultRGB = inputRGB;
    resultF = inputF;
    RIS_CHANNELS
}

// Small pictures of micropolygons: 32 x 32 pixels of a square of 2 x 2, seen along z, so a pixel is 1/16 wide.
#pragma once
#include "integrator/floorscene.h"

namespace alpenglow::integrator::testing {

inline constexpr int kSide = 32;
inline constexpr float kPixel = 2.f / kSide;
/// Steps of lattices are rounded to quarters of an octave.
inline constexpr float kRounding = 1.0906f;

inline Settings bySettings(bool micropolygons, Hider hider = Hider::Hidden) {
    Settings s = withShaders(hider);
    s.micropolygons = micropolygons;
    return s;
}
inline std::string gridPicture(const std::string& inside, const std::string& options = "") {
    return "Format 32 32 1\nScreenWindow -1 1 -1 1\nProjection \"orthographic\"\n" + options + "WorldBegin\n" + inside +
           "\nWorldEnd\n";
}
/// Fills the picture.
inline const std::string kSquare = "Polygon \"P\" [-1 -1 5  -1 1 5  1 1 5  1 -1 5]\n";

/// side x side samples of each pixel, in the middles of its cells.
inline std::vector<CameraRay> samplesOf(int side) {
    std::vector<CameraRay> rays;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (int k = 0; k < side * side; ++k) {
                const float at[2] = {float(x) + (float(k % side) + .5f) / float(side),
                                     float(y) + (float(k / side) + .5f) / float(side)};
                CameraRay r = rayTo({-1 + kPixel * at[0], 1 - kPixel * at[1], 0}, {-1 + kPixel * at[0], 1 - kPixel * at[1], 1});
                r.width = kPixel / 2;
                r.px = x, r.py = y, r.sample = uint32_t(k);
                rays.push_back(r);
            }
    return rays;
}

/// One of every kind, which the picture shows.
inline const std::vector<std::string> kShapes = {
    "Translate 0 0 5\nSphere .9 -.9 .9 360\n",
    "Translate 0 0 5\nSphere .9 -.5 .7 200\n",
    "Translate 0 0 5\nRotate 60 1 1 0\nTorus .6 .25 0 360 360\n",
    "Translate 0 0 5\nRotate 80 1 .3 0\nCylinder .6 -.8 .8 360\n",
    "Translate 0 0 5\nRotate 80 1 .3 0\nCone 1 .7 360\n",
    "Translate 0 0 5\nDisk 0 .9 360\n",
    "Scale 1 1 2\nPatch \"bicubic\" \"Pz\" [2.5 2 3 2.5  2.5 2 3 2.5  2.5 2 3 2.5  2.5 2 3 2.5]\n",
    std::string("SubdivisionMesh \"catmull-clark\" [4 4] [0 1 2 3 3 2 4 5] [\"interpolateboundary\"] [0 0] [] []") +
        " \"P\" [-1 -1 5 0 -1 4 0 1 5 -1 1 5 1 1 5 1 -1 4]\n",
    "Curves \"cubic\" [4] \"nonperiodic\" \"P\" [-.9 -.9 5 -.3 .9 5 .3 -.9 5 .9 .9 5] \"constantwidth\" [.4]\n",
    "Points \"P\" [-.5 -.5 5 .5 .5 5] \"constantwidth\" [.7]\n",
    "Blobby 1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1] [\"\"]\n",
    "ObjectBegin 1\nSphere .4 -.4 .4 360\nObjectEnd\nTranslate -.5 0 5\nObjectInstance 1\nTranslate 1 0 0\nObjectInstance 1",
};

} // namespace alpenglow::integrator::testing

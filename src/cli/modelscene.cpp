#include "cli/modelscene.h"
#include "cli/ribtext.h"
#include "ri/models/model.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace alpenglow::cli {

namespace {} // namespace

std::string modelScene(const std::string& file) {
    Vec3d lo(INFINITY), hi(-INFINITY);
    for (const scene::Primitive& p : ri::readModelFile(file, [](auto&&...) {}, nullptr))
        for (const scene::Param& v : p.params)
            if (v.name == "P")
                for (size_t i = 0; i + 2 < v.numbers.size(); i += 3)
                    for (int k = 0; k < 3; ++k) {
                        lo[k] = std::min(lo[k], double(v.numbers[i + size_t(k)]));
                        hi[k] = std::max(hi[k], double(v.numbers[i + size_t(k)]));
                    }
    if (!(lo.x <= hi.x)) lo = Vec3d(-1.0), hi = Vec3d(1.0); // nothing to see: the scene will say so
    const Vec3d middle = (lo + hi) * 0.5;
    double radius = 0.5 * length(hi - lo);
    if (!(radius > 0)) radius = 1;
    constexpr double kFov = 30, kRoom = 1.03; // degrees; of the ball around the model
    const double away = kRoom * radius / std::sin(kFov * 0.5 * 3.14159265358979 / 180), floor = 60 * radius;
    const std::filesystem::path path(file);
    // The model's space is right-handed, the camera's left-handed: z is turned round between them.
    return fmt::format("Display {} \"png\" \"rgb\"\n"
                       "Format 640 480 1\n"
                       "Projection \"perspective\" \"fov\" {}\n"
                       "Hider \"path\"\n"
                       "Translate 0 0 {:.9g}\nRotate -18 1 0 0\nRotate 28 0 1 0\nScale 1 1 -1\nTranslate {:.9g} {:.9g} {:.9g}\n"
                       "WorldBegin\n"
                       "LightSource \"envlight\" \"sky\" \"float intensity\" .8 \"color lightcolor\" [.78 .87 1]\n"
                       "LightSource \"distantlight\" \"sun\" \"float intensity\" .8 \"color lightcolor\" [1 .93 .82] \"point "
                       "from\" [-2 5 3] \"point to\" [0 0 0]\n"
                       "AttributeBegin\nSurface \"matte\"\nColor [.5 .49 .47]\n"
                       "Polygon \"P\" [{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}]\n"
                       "AttributeEnd\n"
                       "Surface \"paintedplastic\" \"Kd\" .8 \"Ks\" .12 \"roughness\" .15\nColor [.75 .73 .7]\n"
                       "Geometry {} \"string filename\" {}\n"
                       "WorldEnd\n",
                       ribString(path.stem().string() + ".png"), kFov, away, -middle.x, -middle.y, -middle.z, middle.x - floor,
                       lo.y, middle.z - floor, middle.x - floor, lo.y, middle.z + floor, middle.x + floor, lo.y, middle.z + floor,
                       middle.x + floor, lo.y, middle.z - floor,
                       path.extension() == ".obj" || path.extension() == ".OBJ" ? "\"obj\"" : "\"ply\"",
                       ribString(path.filename().string()));
}

} // namespace alpenglow::cli

// Volume: a region of space that a volume shader fills. It is drawn as a closed surface that is not seen itself, with the shader
// as its Interior, so that all that insides of surfaces do holds for it.
#include "ri/interpreter.h"
#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <string_view>

namespace alpenglow::ri {
namespace {

using scene::Class;

/// The shapes in the cube of -1 to 1, their normals outward.
const std::map<std::string, std::string>& shapes() {
    static const std::map<std::string, std::string> kShapes = {
        {"box", ""}, // of its own corners, so that it can move by them
        {"ellipsoid", "Sphere 1 -1 1 360\n"},
        {"cylinder", "Cylinder 1 -1 1 360\nDisk 1 1 360\nReverseOrientation\nDisk -1 1 360\n"},
        {"cone", "Translate 0 0 -1\nCone 2 1 360\nReverseOrientation\nDisk 0 1 360\n"}};
    return kShapes;
}

scene::Primitive boxOf(const std::vector<float>& b) {
    scene::Primitive p;
    p.kind = "PointsPolygons";
    p.ints.assign(6, 4);
    p.ints2 = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    scene::Param P;
    P.name = "P";
    P.cls = Class::Vertex;
    P.type = scene::Type::Point;
    P.declared = true;
    for (size_t k = 0; k < 8; ++k) P.numbers.insert(P.numbers.end(), {b[k & 1 ? 1 : 0], b[k & 2 ? 3 : 2], b[k & 4 ? 5 : 4]});
    p.params.push_back(std::move(P));
    return p;
}

constexpr std::string_view kPlugIn = "blobbydso:", kGrids = "blobbydso:impl_openvdb";

scene::Param constant(const char* name, scene::Type type, const SourcePlace& place) {
    scene::Param p;
    p.name = name;
    p.cls = Class::Constant;
    p.type = type;
    p.place = place;
    return p;
}

/// What shaders/ris/PxrVolumeGrid.sl, or a shader of the scene's own, needs to know of a file of grids: constants of the region.
/// Nothing if no file is named.
scene::ParamList gridOf(const scene::ParamList& given, const std::vector<float>& bound, const scene::ShaderCall* interior,
                        const SourcePlace& place) {
    const scene::Param* const texts = scene::find(given, "blobbydso:stringargs");
    if (!texts || texts->strings.empty() || texts->strings[0].empty()) return {};
    scene::Param file = constant("gridFile", scene::Type::String, place), name = constant("gridName", scene::Type::String, place);
    file.strings = {texts->strings[0]};
    name.strings = {texts->strings.size() > 1 && !texts->strings[1].empty() ? texts->strings[1] : "density"};
    if (interior) // the shader may want another grid than the one that the plug-in takes for the whole
        if (const scene::Param* p = scene::find(interior->params, "densityFloatPrimVar"); p && !p->strings.empty())
            if (!p->strings[0].empty()) name.strings = p->strings;
    scene::Param box = constant("gridBound", scene::Type::Float, place);
    box.arrayLength = 6;
    box.numbers = bound;
    return {std::move(file), std::move(name), std::move(box)};
}

} // namespace

/// False when the arguments make no region: reported.
bool Interpreter::regionOf(const Call& c, std::vector<float>& bound) {
    const std::string& type = c.text(0);
    if (type.starts_with(kPlugIn) && type != kGrids) {
        reporter.error(Rie::Incapable, c.place,
                       "Volume: plug-ins of volumes (blobbydso) are those of another renderer; it is left out",
                       "\"blobbydso:impl_openvdb\" reads grids of OpenVDB");
        return false;
    }
    if (type != kGrids && !shapes().count(type)) {
        reporter.error(Rie::BadToken, c.place, fmt::format("Volume: \"{}\" is not known", type),
                       "box, ellipsoid, cylinder or cone");
        return false;
    }
    bound = c.reals(1);
    if (!(bound[0] < bound[1] && bound[2] < bound[3] && bound[4] < bound[5])) {
        reporter.error(Rie::Range, c.place, "Volume: its bound holds nothing", "xmin xmax ymin ymax zmin zmax");
        return false;
    }
    const std::vector<int> d = c.ints(2);
    if (d.size() != 3 || std::any_of(d.begin(), d.end(), [](int n) { return n < 0; })) {
        reporter.error(Rie::Consistency, c.place, "Volume: its dimensions are three numbers of voxels, 0 for none");
        return false;
    }
    return true;
}

void Interpreter::volume(const Call& c) {
    std::vector<float> b;
    if (!regionOf(c, b)) return;
    const bool grids = c.text(0) == kGrids, box = grids || c.text(0) == "box";
    if (!box && gatheringMotion()) {
        reporter.error(Rie::BadMotion, c.place, fmt::format("Volume \"{}\" moves by its transformation only", c.text(0)),
                       "MotionBegin of transformations before it; boxes move by their bounds, too");
        return;
    }
    scene::ParamList everywhere;
    for (scene::Param& p : bind(c, Use::Primitive)) {
        if (p.cls == Class::Constant || p.cls == Class::Uniform || !p.declared) {
            p.cls = Class::Constant;
            everywhere.push_back(std::move(p));
        } else if (!grids || !p.numbers.empty()) { // empty ones name grids
            incapable(c, "variables of the voxels of a Volume are left out: its shader has the numbers of the whole region, and "
                         "its own function of P");
        }
    }
    if (!begin(BlockKind::Attribute, c)) return;
    scene::Attributes& a = attributes();
    if (!a.interior) a.interior = std::move(a.atmosphere), a.atmosphere = nullptr; // Atmosphere is "interior" in later renderers
    if (grids) {
        scene::ParamList grid = gridOf(everywhere, b, a.interior.get(), c.place);
        if (grid.empty())
            reporter.error(Rie::MissingData, c.place, "Volume \"blobbydso:impl_openvdb\" names no file; it is empty",
                           "\"constant string[2] blobbydso:stringargs\" [\"smoke.vdb\" \"density\"]");
        std::erase_if(everywhere, [](const scene::Param& p) { return p.name.starts_with(kPlugIn); });
        everywhere.insert(everywhere.end(), std::make_move_iterator(grid.begin()), std::make_move_iterator(grid.end()));
        if (a.interior && a.interior->name == "PxrVolume") {
            auto marched = std::make_shared<scene::ShaderCall>(*a.interior);
            marched->name = "PxrVolumeGrid";
            marched->toWorld = state.ctm; // the grid lies in the space of the region
            a.interior = std::move(marched);
        }
    }
    if (!a.interior)
        reporter.once("ri:emptyvolume", Severity::Warning, Rie::Incapable, c.place,
                      "a Volume without Interior or Atmosphere is empty",
                      "Interior \"medium\" \"color scattering\" [1 1 1], for example");
    auto unseen = std::make_shared<scene::ShaderCall>();
    unseen->name = "null";
    unseen->toWorld = state.ctm;
    unseen->place = c.place;
    a.surface = std::move(unseen);
    a.displacement = nullptr;
    a.areaLight = -1;
    a.sides = 2;
    a.absoluteHandedness = a.inside = false;
    if (box) {
        everywhere_.swap(everywhere);
        emit(boxOf(b), c);
        everywhere_.swap(everywhere);
    } else {
        Matrix m = scaleMatrix(0.5 * (double(b[1]) - b[0]), 0.5 * (double(b[3]) - b[2]), 0.5 * (double(b[5]) - b[4]));
        for (size_t i = 0; i < 3; ++i) m.m[3][i] = 0.5 * (double(b[2 * i]) + b[2 * i + 1]);
        concat(scene::Transform(m), c);
        expand(shapes().at(c.text(0)), c, std::move(everywhere));
    }
    end(BlockKind::Attribute, c);
}

} // namespace alpenglow::ri

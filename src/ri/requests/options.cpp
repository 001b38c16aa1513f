// Camera, display and other options (RISpec 3.2, 4.1).
#include "base/filternames.h"
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/motion.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace alpenglow::ri {

bool within(Interpreter& in, const Call& c, bool good, const char* what) {
    if (!good) in.reporter.error(Rie::Range, c.place, fmt::format("{}: {}", c.request->name, what));
    return good;
}

namespace {

constexpr unsigned kOptions = kBase | kFrame;

void format(Interpreter& in, const Call& c) {
    const scene::Options standard;
    int x = c.integer(0), y = c.integer(1);
    if (x > limits::kImageSide || y > limits::kImageSide) {
        in.reporter.error(Rie::Limit, c.place,
                          fmt::format("Format: {} x {} is more than {} pixels a side", x, y, limits::kImageSide));
        return;
    }
    // Zero and negative numbers mean the default (docs/design/ri.md, "Reading").
    in.options.xres = x > 0 ? x : standard.xres;
    in.options.yres = y > 0 ? y : standard.yres;
    constexpr double kMost = 1e6; // OpenEXR writes no others
    const double aspect = c.number(2) > 0 ? c.number(2) : 1;
    const bool written = within(in, c, aspect >= 1 / kMost && aspect <= kMost, "a pixel's aspect lies between 1e-6 and 1e6");
    in.options.pixelAspect = written ? float(aspect) : 1;
    in.options.formatSet = true;
}

void projection(Interpreter& in, const Call& c) {
    scene::ParamList params = in.bind(c, Use::Other);
    // PRMan 22's plug-ins: of the camera with a tilt, distortion and the like the perspective alone.
    static constexpr std::pair<std::string_view, const char*> kOthers[] = {
        {"PxrPerspective", "perspective"}, {"PxrCamera", "perspective"}, {"PxrOrthographic", "orthographic"}};
    std::string name = c.text(0);
    for (const auto& [other, same] : kOthers)
        if (name == other) {
            name = same;
            for (const scene::Param& p : params)
                if (p.name != "fov")
                    in.incapable(c, fmt::format("\"{}\" of {} is not done by this version: it has no effect", p.name, other));
        }
    if (name != "perspective" && name != "orthographic" && name != "stereo" && name != "null" && !name.empty()) {
        in.reporter.error(Rie::Incapable, c.place, fmt::format("projection \"{}\" is not known: the one before stays", name),
                          "perspective, stereo or orthographic");
        return;
    }
    const bool perspective = name == "perspective" || name == "stereo";
    in.options.projection = perspective ? "perspective" : "orthographic";
    in.options.fov = 90;
    if (const scene::Param* fov = scene::find(params, "fov"); fov && !fov->numbers.empty() && perspective)
        if (within(in, c, fov->numbers[0] > 0 && fov->numbers[0] < 180, "the field of view must lie between 0 and 180 degrees"))
            in.options.fov = fov->numbers[0];
    if (name == "stereo" && !scene::find(params, "stereo")) { // a pair by its name
        scene::Param& p = params.emplace_back();
        p.name = "stereo";
        p.type = scene::Type::String;
        p.strings = {"sidebyside"};
        p.place = c.place;
    }
    in.options.projectionParams = std::move(params);
}

void clippingPlane(Interpreter& in, const Call& c) {
    // Given in current space; kept in camera space. CTM leads to camera before the world, where this request belongs.
    Vec3d p(c.number(0), c.number(1), c.number(2)), n(c.number(3), c.number(4), c.number(5));
    if (!within(in, c, dot(n, n) > 0, "the normal is zero")) return;
    Matrix m = in.state.ctm.first();
    if (in.inWorld()) m = m * inverse(in.namedSystem("camera")->first());
    in.options.clippingPlanes.emplace_back(transformPoint(m, p), normalize(transformNormal(m, n)));
}

void depthOfField(Interpreter& in, const Call& c) {
    in.options.fstop = 1e38f;
    in.options.focalLength = in.options.focalDistance = 0;
    if (!c.given(0)) return;
    if (!within(in, c, c.number(0, 0) > 0, "the f-stop must be positive")) return;
    in.options.fstop = c.real(0, 0);
    in.options.focalLength = c.real(0, 1);
    in.options.focalDistance = c.real(0, 2);
}

void screenWindow(Interpreter& in, const Call& c) {
    if (within(in, c, c.number(0, 0) != c.number(0, 1) && c.number(0, 2) != c.number(0, 3), "the window is empty"))
        in.options.screenWindow = c.reals(0);
}

void cropWindow(Interpreter& in, const Call& c) {
    std::vector<float> w = c.reals(0);
    bool good = true;
    for (float f : w) good = good && f >= 0 && f <= 1;
    if (within(in, c, good && w[0] < w[1] && w[2] < w[3], "the window must be xmin < xmax, ymin < ymax within 0 and 1"))
        std::copy(w.begin(), w.end(), in.options.crop);
}

void pixelFilter(Interpreter& in, const Call& c) {
    static const std::vector<std::string> kFilters = {
        "box",  "triangle", "catmull-rom",           "b-spline",        "gaussian", "sinc", "bessel",
        "disk", "mitchell", "separable-catmull-rom", "blackman-harris", "lanczos"};
    const std::string name = filterNameOf(c.text(0));
    if (std::find(kFilters.begin(), kFilters.end(), name) == kFilters.end()) {
        std::string near = nearestName(c.text(0), kFilters);
        in.reporter.error(Rie::BadToken, c.place, fmt::format("PixelFilter: \"{}\" is not known", c.text(0)),
                          near.empty() ? "" : "did you mean " + near + "?");
        return;
    }
    if (within(in, c, c.number(1) > 0 && c.number(2) > 0, "the widths must be positive"))
        in.options.filter = {name, c.real(1), c.real(2)};
}

void quantize(Interpreter& in, const Call& c) {
    scene::Quantize q{c.real(1), c.real(2), c.real(3), c.real(4), true};
    if (c.text(0) == "rgba" || c.text(0) == "rgb" || c.text(0) == "a") in.options.quantizeRgba = q;
    else if (c.text(0) == "z") in.options.quantizeZ = q;
    else // PRMan takes any variable; here a Display of it has "quantize"
        in.reporter.report(Severity::Warning, Rie::BadToken, c.place, fmt::format("Quantize: \"{}\" is not known", c.text(0)),
                           "rgba or z; a Display of its own takes \"quantize\"");
}

void display(Interpreter& in, const Call& c) {
    scene::Display d;
    bool add = c.text(0).starts_with("+");
    d.name = c.text(0).substr(add ? 1 : 0);
    d.type = c.text(1);
    d.mode = c.text(2);
    d.params = in.bind(c, Use::Display);
    d.place = c.place;
    if (!add) in.options.displays.clear();
    in.options.displays.push_back(std::move(d));
}

void displayChannel(Interpreter& in, const Call& c) {
    Resolved r = in.declarations.resolve(c.text(0), "");
    if (r.malformed) {
        in.reporter.error(Rie::Syntax, c.place, fmt::format("DisplayChannel: \"{}\" is not a declaration", c.text(0)),
                          declarationHint(c.text(0), true, "class type name"));
        return;
    }
    scene::Param p;
    p.name = r.name;
    p.declared = r.declaration.has_value();
    if (r.declaration) {
        p.cls = r.declaration->cls;
        p.type = r.declaration->type;
        p.arrayLength = r.declaration->arrayLength;
    }
    p.place = c.place;
    in.options.displayChannels[r.name] = p;
    in.options.displayChannelParams[r.name] = in.bind(c, Use::Other);
}

/// A further call of the same hider keeps what it does not give anew: exporters set one parameter by each call.
void hider(Interpreter& in, const Call& c) {
    scene::ParamList given = in.bind(c, Use::Hider);
    if (in.options.hider == c.text(0))
        for (const scene::Param& p : in.options.hiderParams)
            if (!scene::find(given, p.name)) given.push_back(p);
    in.options.hider = c.text(0);
    in.options.hiderPlace = c.place;
    in.options.hiderParams = std::move(given);
}

void colorSamples(Interpreter& in, const Call& c) {
    const std::vector<double>& n = c.numbers(0);
    const std::vector<double>& back = c.numbers(1);
    if (!within(in, c, !n.empty() && n.size() % 3 == 0 && back.size() == n.size(), "both arrays need 3 numbers for each sample"))
        return;
    in.options.colorSamples = int(n.size() / 3);
    const std::vector<double> identity = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    in.nRGB = n == identity ? std::vector<double>() : n;
}

/// "~" at the start of a folder and $NAME or ${NAME} anywhere, as shells have them; variables that are not set are kept as text.
std::string withEnvironment(const std::string& path) {
    std::string out;
    auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    auto put = [&](const std::string& name, const std::string& otherwise) {
        const char* value = std::getenv(name.c_str());
        out += value ? std::string(value).substr(0, limits::kTokenBytes) : otherwise;
    };
    for (size_t i = 0; i < path.size() && out.size() <= limits::kTokenBytes; ++i) {
        bool first = i == 0 || path[i - 1] == ':' || path[i - 1] == ';';
        bool last = i + 1 == path.size() || path[i + 1] == '/' || path[i + 1] == ':' || path[i + 1] == ';';
        if (path[i] == '~' && first && last) {
            put("HOME", "~");
        } else if (path[i] == '$') {
            bool braces = i + 1 < path.size() && path[i + 1] == '{';
            size_t a = i + (braces ? 2 : 1), b = a;
            while (b < path.size() && letter(path[b])) ++b;
            bool whole = b > a && (!braces || (b < path.size() && path[b] == '}'));
            size_t end = b + (braces && whole ? 1 : 0);
            if (whole) put(path.substr(a, b - a), path.substr(i, end - i));
            else out += path.substr(i, end - i);
            i = end - 1;
        } else {
            out += path[i];
        }
    }
    return out;
}

void option(Interpreter& in, const Call& c) {
    const std::string& category = c.text(0);
    for (scene::Param& p : in.bind(c, Use::Option, category)) {
        std::string key = category + ":" + p.name;
        if (category == "searchpath" && !p.strings.empty()) { // "&" stands for the value so far
            std::string before, now;
            if (auto i = in.options.values.find(key); i != in.options.values.end() && !i->second.strings.empty())
                before = i->second.strings[0];
            // An array of folders is the same as one text with ':' between them.
            for (size_t k = 1; k < p.strings.size(); ++k) p.strings[0] += ":" + p.strings[k];
            p.strings.resize(1);
            p.arrayLength = 0;
            for (char ch : withEnvironment(p.strings[0])) {
                if (now.size() > limits::kTokenBytes) break;
                if (ch == '&') now += before;
                else now += ch;
            }
            if (now.size() > limits::kTokenBytes) {
                in.reporter.error(Rie::Limit, c.place, "the search path is too long");
                continue;
            }
            p.strings[0] = now;
        }
        if (key == "rib:varsubst") in.options.values["ribparse:varsubst"] = p; // ricpp's name for it
        if ((key == "ribparse:varsubst" || key == "rib:varsubst") && !p.strings.empty()) in.lookForVariables();
        in.options.values[key] = std::move(p);
    }
}

std::vector<Request> cameraRequests() {
    const Kind k = Kind::Option;
    return {
        {"Format", "int xres; int yres; number pixelaspect", k, kOptions, false,
         "Resolution in pixels and the width of a pixel over its height. --format overrides it.", "640 480 1", format},
        {"FrameAspectRatio", "number ratio", k, kOptions, false, "Width over height of the frame.", "1.333",
         [](Interpreter& in, const Call& c) {
             if (within(in, c, c.number(0) > 0, "the ratio must be positive")) in.options.frameAspect = c.real(0);
         }},
        {"ScreenWindow", "number[4] window", k, kOptions, false, "left right bottom top of the screen, in screen space.",
         "-1 1 -1 1", screenWindow},
        {"CropWindow", "number[4] window", k, kOptions, false, "xmin xmax ymin ymax of the part that is rendered, 0 to 1.",
         "[0 .5 .25 1]", cropWindow},
        {"Projection", "string name; ..", k, kOptions, true,
         "\"perspective\" (\"fov\", degrees), \"stereo\" (also \"eyeseparation\", \"focaldistance\"; \"stereo\" sidebyside, "
         "topbottom, left, right) or \"orthographic\".",
         "\"perspective\" \"fov\" [30]", projection},
        {"Clipping", "number near; number far", k, kOptions, false,
         "Distances along z between which things are seen. Camera rays begin at near; rays see what lies behind far.", "0.1 1000",
         [](Interpreter& in, const Call& c) {
             if (!within(in, c, c.number(0) < c.number(1), "near must be less than far")) return;
             in.options.clipNear = c.real(0);
             in.options.clipFar = c.real(1);
         }},
        {"ClippingPlane", "number x; number y; number z; number nx; number ny; number nz", k, kOptions, false,
         "Hides the half space that the normal points into from the camera.", "0 0 5 0 0 1", clippingPlane},
        {"DepthOfField", "number[3] lens?", k, kOptions, false, "fstop focallength focaldistance; none = a pinhole.", "2.8 .05 3",
         depthOfField},
        {"Shutter", "number open; number close", k, kOptions, false, "Times between which the shutter is open.", "0 1",
         [](Interpreter& in, const Call& c) {
             if (!within(in, c, c.number(0) <= c.number(1), "it closes before it opens")) return;
             in.options.shutterOpen = c.real(0);
             in.options.shutterClose = c.real(1);
         }},
        {"PixelVariance", "number variance", k, kOptions, false,
         "Variance of pixel values that is good enough. Kept for shaders; --noise is the way here.", ".01",
         [](Interpreter& in, const Call& c) {
             if (within(in, c, c.number(0) >= 0, "it must not be negative")) in.options.pixelVariance = c.real(0);
         }},
        {"PixelSamples", "number x; number y", k, kOptions, false,
         "Samples a pixel in x and y; under path their product. --spp overrides it.", "4 4",
         [](Interpreter& in, const Call& c) {
             if (!within(in, c, c.number(0) > 0 && c.number(1) > 0, "there must be at least one sample")) return;
             in.options.pixelSamplesX = std::max(c.real(0), 1.f);
             in.options.pixelSamplesY = std::max(c.real(1), 1.f);
             in.options.pixelSamplesSet = true;
         }},
    };
}

std::vector<Request> pictureRequests() {
    const Kind k = Kind::Option;
    return {
        {"PixelFilter", "string name; number xwidth; number ywidth", k, kOptions, false,
         "Reconstruction filter and its full widths in pixels.", "\"gaussian\" 2 2", pixelFilter},
        {"Exposure", "number gain; number gamma", k, kOptions, false, "Output = (gain * value) ^ (1 / gamma).", "1 2.2",
         [](Interpreter& in, const Call& c) {
             if (!within(in, c, c.number(1) > 0, "gamma must be positive")) return;
             in.options.exposureSet = true;
             in.options.gain = c.real(0);
             in.options.gamma = c.real(1);
         }},
        {"Imager", "string name; ..", k, kOptions, false, "Shader that works on the finished pixels.",
         "\"background\" \"bgcolor\" [0 0 .2]",
         [](Interpreter& in, const Call& c) {
             in.options.imager = c.text(0).empty() || c.text(0) == "null" ? nullptr : in.shader(c);
         }},
        {"Quantize", "string type; number one; number min; number max; number dither", k, kOptions, false,
         "How \"rgba\" or \"z\" values become integers; one = 0: they stay floats.", "\"rgba\" 255 0 255 .5", quantize},
        {"Display", "string name; string type; string mode; ..", k, kOptions, false,
         "Where the picture goes; a name with + adds another one. Types and parameters: docs/options.md.",
         "\"a.tif\" \"tiff\" \"rgba\" \"quantize\" [0 255 0 255]", display},
        {"DisplayChannel", "string channel; ..", k, kOptions, false, "Declares an output for use in a Display's mode.",
         "\"varying color diffuse\" \"string filter\" \"box\"", displayChannel},
        {"Hider", "string name; ..", k, kOptions, false,
         "How the picture is made: \"hidden\", \"raytrace\" or \"path\" (docs/options.md). --hider overrides it. A further call "
         "for the same hider keeps the parameters that it does not give.",
         "\"hidden\" \"jitter\" [1]", hider},
        {"ColorSamples", "number[] nRGB; number[] RGBn", k, kOptions, false, "Colours of n samples, and how they become RGB.",
         "[1 1 1] [.3 .3 .4]", colorSamples},
        {"RelativeDetail", "number factor", k, kOptions, false, "Scales the size that chooses levels of detail.", "1",
         [](Interpreter& in, const Call& c) {
             if (within(in, c, c.number(0) >= 0, "it must not be negative")) in.options.relativeDetail = c.real(0);
         }},
        {"Option", "string class; ..", k, kOptions, false, "Options of this renderer, by class and name (docs/options.md).",
         "\"searchpath\" \"shader\" [\"shaders:@\"]", option},
        {"Camera", "string name; string handle?; ..", k, kOptions, false, "Names a further camera; not used.", "\"side\"",
         [](Interpreter& in, const Call& c) { in.incapable(c, "named cameras are not used"); }},
    };
}

} // namespace

std::vector<Request> optionRequests() {
    std::vector<Request> all = cameraRequests();
    for (Request& r : pictureRequests()) all.push_back(std::move(r));
    return all;
}

} // namespace alpenglow::ri

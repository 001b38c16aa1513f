#include "ri/requests/header.h"
#include "ri/requests/manual.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <vector>

namespace alpenglow::ri {
namespace {

/// A call whose arguments in C do not follow from the signature: counts that a file has in its brackets, names for the numbers of
/// a group, types of the binding (RISpec 3.2, appendix A), or fewer arguments.
struct Binding {
    std::string_view request, arguments;
    std::string_view result = "RtVoid";
};

constexpr Binding kBindings[] = {
    {"ArchiveBegin", "RtToken name", "RtArchiveHandle"},
    {"ArchiveRecord", "RtToken type, RtToken format, ..."},
    {"AreaLightSource", "RtToken name", "RtLightHandle"},
    {"Attribute", "RtToken name"},
    {"Basis", "RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep"},
    {"Blobby", "RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[]"},
    {"Clipping", "RtFloat hither, RtFloat yon"},
    {"Color", "RtColor color"},
    {"ColorSamples", "RtInt n, RtFloat nRGB[], RtFloat RGBn[]"},
    {"CropWindow", "RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax"},
    {"Curves", "RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap"},
    {"Declare", "RtToken name, RtToken declaration", "RtToken"},
    {"DepthOfField", "RtFloat fstop, RtFloat focallength, RtFloat focaldistance"},
    {"DetailRange", "RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition, RtFloat maxvisible"},
    {"EnableLightFilter", "RtToken light, RtToken filter, RtBoolean on"},
    {"GeneralPolygon", "RtInt nloops, RtInt nverts[]"},
    {"HierarchicalSubdivisionMesh", "RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], "
                                    "RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtToken stringargs[]"},
    {"Illuminate", "RtLightHandle light, RtBoolean on"},
    {"LightSource", "RtToken name", "RtLightHandle"},
    {"MakeBump",
     "RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth, RtFloat twidth"},
    {"MakeCubeFaceEnvironment", "RtToken px, RtToken nx, RtToken py, RtToken ny, RtToken pz, RtToken nz, RtToken texture, "
                                "RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth"},
    {"MakeLatLongEnvironment", "RtToken picture, RtToken texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth"},
    {"MakeTexture",
     "RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth, RtFloat twidth"},
    {"Matte", "RtBoolean on"},
    {"MotionBegin", "RtInt n, ..."},
    {"NuPatch", "RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder, RtFloat vknot[], "
                "RtFloat vmin, RtFloat vmax"},
    {"ObjectBegin", "", "RtObjectHandle"},
    {"ObjectInstance", "RtObjectHandle handle"},
    {"Opacity", "RtColor color"},
    {"Option", "RtToken name"},
    {"PixelFilter", "RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth"},
    {"Points", "RtInt npoints"},
    {"PointsGeneralPolygons", "RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[]"},
    {"PointsPolygons", "RtInt npolys, RtInt nverts[], RtInt verts[]"},
    {"Polygon", "RtInt nvertices"},
    {"Procedural", "RtPointer data, RtBound bound, RtProcSubdivFunc subdivide, RtProcFreeFunc free"},
    {"Quantize", "RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither"},
    {"ReadArchive", "RtToken name, RtArchiveCallback callback"},
    {"Rotate", "RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz"},
    {"Scale", "RtFloat sx, RtFloat sy, RtFloat sz"},
    {"ScreenWindow", "RtFloat left, RtFloat right, RtFloat bottom, RtFloat top"},
    {"Skew", "RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2"},
    {"SubdivisionMesh",
     "RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[], "
     "RtInt intargs[], RtFloat floatargs[]"},
    {"TextureCoordinates", "RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3, RtFloat s4, RtFloat t4"},
    {"Translate", "RtFloat dx, RtFloat dy, RtFloat dz"},
    {"TrimCurve", "RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[], RtInt n[], "
                  "RtFloat u[], RtFloat v[], RtFloat w[]"},
    {"Volume", "RtToken type, RtBound bound, RtInt dimensions[]"},
};

/// What follows from an entry of the signature.
std::string argumentsOf(const ArgSpec& a) {
    const std::string type = a.form == ArgSpec::Form::Int ? "RtInt " : a.form == ArgSpec::Form::Number ? "RtFloat " : "RtToken ";
    if (a.array) return "RtInt n" + a.name + ", " + (type == "RtToken " ? "RtString " : type) + a.name + "[]";
    if (a.count == 16) return "RtMatrix " + a.name;
    if (a.count == 6) return "RtBound " + a.name;
    return type + a.name;
}

std::string argumentsOf(const Request& r) {
    std::string all;
    for (const ArgSpec& a : r.args)
        if (!a.optional) all += (all.empty() ? "" : ", ") + argumentsOf(a);
    return all;
}

/// A declaration in lines of at most 130 columns, broken behind commas.
std::string declaration(std::string_view result, const std::string& name, std::string arguments) {
    constexpr size_t kColumns = 130;
    std::string out, line = std::string(result) + " " + name + "(";
    const size_t indent = line.size();
    if (arguments.empty()) arguments = "void";
    for (size_t at = 0; at < arguments.size();) {
        const size_t comma = arguments.find(", ", at), end = comma == arguments.npos ? arguments.size() : comma + 1;
        const std::string one = arguments.substr(at, end - at);
        const bool fresh = line.size() == indent, last = end == arguments.size();
        if (!fresh && line.size() + 1 + one.size() + (last ? 2 : 0) > kColumns) {
            out += line + "\n";
            line.assign(indent, ' ');
        } else if (!fresh) line += ' ';
        line += one;
        at = last ? end : end + 1;
    }
    return out + line + ");\n";
}

std::string prototypes(const Request& r) {
    const auto* own =
        std::find_if(std::begin(kBindings), std::end(kBindings), [&](const Binding& b) { return b.request == r.name; });
    const bool differs = own != std::end(kBindings);
    const std::string name = "Ri" + std::string(r.name), arguments = !r.c.empty() ? std::string(r.c)
                                                                     : differs    ? std::string(own->arguments)
                                                                                  : argumentsOf(r);
    const std::string_view result = differs ? own->result : "RtVoid";
    if (r.name == "MotionBegin")
        return declaration(result, name, arguments) + declaration(result, name + "V", "RtInt n, RtFloat times[]");
    if (!r.parameters || hasOneForm(r.name)) return declaration(result, name, arguments);
    return declaration(result, name, arguments + ", ...") +
           declaration(result, name + "V", arguments + ", RtInt n, RtToken tokens[], RtPointer values[]");
}

} // namespace

bool withoutCall(std::string_view request) {
    static constexpr std::string_view kOfFiles[] = {
        "version",        "teapot",       "EditBegin",          "EditEnd",
        "EditWorldBegin", "EditWorldEnd", "EditAttributeBegin", "EditAttributeEnd",
        "ShaderLayer",    "Procedural2",  "ErrorHandler",       "ConnectShaderLayers"};
    return std::find(std::begin(kOfFiles), std::end(kOfFiles), request) != std::end(kOfFiles);
}

bool hasOneForm(std::string_view request) {
    return request == "ArchiveRecord" || request == "Procedural" || request == "ObjectInstance";
}

std::string callPrototypes() {
    std::string out;
    for (const Kind k : kManualOrder) {
        out += "\n/* " + std::string(titleOf(k)) + " */\n";
        for (const Request& r : requestTable())
            if (r.kind == k && !withoutCall(r.name)) out += prototypes(r);
    }
    return out.substr(1);
}

} // namespace alpenglow::ri

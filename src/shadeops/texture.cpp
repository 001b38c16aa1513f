// Texture mapping: 3Delight manual, 6.4.6. The renderer answers; `name` may carry a channel, name[channel].
#include "shadeops/describe.h"
#include <algorithm>
#include <utility>

namespace alpenglow::shadeops {
namespace {

std::vector<OptionalParameter> filterParameters() {
    return {{kS, "filter", false, "\"gaussian\"",
             "a pixel filter: box, triangle, gaussian, disk, catmull-rom, mitchell, sinc, bessel, ..."},
            {kF, "width", false, "1", "multiplies the filter size in s and t"},
            {kF, "swidth", false, "1", "multiplies the filter size in s"},
            {kF, "twidth", false, "1", "multiplies the filter size in t"},
            {kF, "blur", false, "0", "added to the filter size, fraction of the map"},
            {kF, "sblur", false, "0", "as blur, in s"},
            {kF, "tblur", false, "0", "as blur, in t"},
            {kF, "fill", false, "0", "value of channels that the file does not have"},
            {kF, "lerp", false, "0", "1 interpolates between map levels"},
            {kF, "samples", false, "4", "of rays: how many (\"raytrace\")"},
            {kF, "bias", false, "-1", "of rays: as for trace(); negative: the attribute's"},
            {kF, "ignoreabove", false, "1e38", "accepted and ignored"},
            {kF, "minwidth", false, "0", "accepted and ignored"},
            {kF, "expand", false, "0", "accepted and ignored"},
            {kF, "maxdist", false, "1e38", "of rays: no intersections beyond (\"raytrace\"), as for trace()"},
            {kF, "samplecone", false, "0", "of rays: half angle of the cone, radians (\"raytrace\"), as for trace()"},
            {kF, "minsamples", false, "samples", "of rays (\"raytrace\"): accepted and ignored"},
            {kS, "label", false, "\"\"", "of rays (\"raytrace\"), as for trace()"},
            {kS, "subset", false, "\"\"", "of rays: groups of objects (\"raytrace\"), as for trace()"},
            {kS, "excludesubset", false, "\"\"", "of rays: groups left out (\"raytrace\"), as for trace()"},
            {kS, "hitmode", false, "\"default\"", "of rays: primitive, shader or default (\"raytrace\"), as for trace()"},
            {kS, "hitsides", false, "\"both\"", "of rays: front, back, both or reversed (\"raytrace\"), as for trace()"}};
}

/// What maps of depth take beyond the filters. A source of light that is no point: PRMan wrote four points behind "source"; the
/// checker names each.
std::vector<OptionalParameter> shadowParameters() {
    std::vector<OptionalParameter> list = filterParameters();
    for (OptionalParameter& o : list) {
        if (o.name == "samples")
            o.defaultText = "Option \"shadow\" \"sample\", else 16",
            o.doc = "comparisons with the map, a square number of them, at most 1024; of rays: how many, 4 where it is missing";
        if (o.name == "bias")
            o.doc = "how far before the map's surfaces a point is lit, world units; negative: Attribute or Option \"shadow\" "
                    "\"bias\", else 0.225";
    }
    list.push_back({kF, "bias0", false, "-1",
                    "with bias1: the comparisons spread their bias between the two; negative: those of the attribute or option"});
    list.push_back({kF, "bias1", false, "-1", "see bias0"});
    for (const char* name : {"source", "source2", "source3", "source4"})
        list.push_back(
            {kP, name, false, "none",
             "shadow of an area light about the eye of the map: its corners, four points behind \"source\", in order around it"});
    list.push_back({kF, "gapbias", false, "0", "of a source: how thick the map's surfaces are at least, world units"});
    for (const char* name : {"resbias", "noiserobust"}) list.push_back({kF, name, false, "0", "accepted and ignored"});
    return list;
}

/// What trace() takes besides, of environment("raytrace").
std::vector<OptionalParameter> environmentParameters() {
    std::vector<OptionalParameter> list = filterParameters();
    for (const Shadeop& op : raytracingShadeops()) {
        if (op.name != "trace") continue;
        for (OptionalParameter o : op.optional) {
            if (std::any_of(list.begin(), list.end(), [&](const OptionalParameter& k) { return k.name == o.name; })) continue;
            o.doc = "of rays (\"raytrace\"), as for trace()";
            list.push_back(std::move(o));
        }
    }
    return list;
}

/// Sets the footprints of lookups.
std::vector<Shadeop> withFootprints(std::vector<Shadeop> list) {
    const std::pair<std::string_view, Footprint> kOf[] = {
        {"texture", {Footprint::Of::Surface, 1}},
        {"environment", {Footprint::Of::Space, 1, 2, true}},
        {"shadow", {Footprint::Of::Space, 1, 2, true}},
        {"texture3d", {Footprint::Of::Space, 1, 3}},
        {"ptexture", {.of = Footprint::Of::Surface, .first = 3, .marks = true}}};
    for (Shadeop& op : list)
        for (const auto& [name, footprint] : kOf)
            if (op.name == name) op.footprint = footprint;
    return list;
}

/// Adds a shadeop with the optional parameters of filters.
Shadeop& addLookup(std::vector<Shadeop>& list, const char* name, std::vector<Signature> signatures, Lowering lowering,
                   const char* doc) {
    Shadeop op;
    op.section = "Texture";
    op.source = "3Delight manual, 6.4.6";
    op.name = name;
    op.signatures = std::move(signatures);
    op.lowering = lowering;
    op.derivative = DerivativeRule::ZeroWarn;
    op.bias = Bias::Biased;
    op.biasReason = "values are filtered over the footprint before they are used";
    op.doc = doc;
    op.optional = filterParameters();
    list.push_back(std::move(op));
    return list.back();
}

/// Lookups in maps of colours.
void addPictures(std::vector<Shadeop>& list) {
    const std::string quad = "float s1, float t1, float s2, float t2, float s3, float t3, float s4, float t4; pairs)";
    addLookup(
        list, "texture",
        each("float color", "$ texture(string name; pairs)") +
            each("float color", "$ texture(string name; float s, float t; pairs)") +
            each("float color", "$ texture(string name; " + quad),
        Lowering::Service,
        "Filtered lookup at s, t (default: those of the sample), or over an explicit quadrilateral; the same point four times: "
        "no filter. Float: one "
        "channel, color: three, from the channel in brackets. Linear colours. Derivatives (calculatenormal(P + N * "
        "texture(...)), Du(texture(...))) go through: the "
        "slopes of the map at the level that is looked up, differences over a texel of it, times the derivatives of s and t, or "
        "of the mean of four "
        "corners. So bump maps tilt normals, smoothly across texels, and fade with distance.")
        .derivative = DerivativeRule::Gradient;
    list.back().examples = {{"color texture(\"wood.tex\", s, t)", "0.5 0.3 0.1", "", "the map has this colour everywhere"}};
    addLookup(
        list, "environment",
        each("float color", "$ environment(string name; vector v; pairs)") +
            each("float color", "$ environment(string name; vector v1, vector v2, vector v3, vector v4; pairs)"),
        Lowering::Service,
        "Lookup of an environment map (latitude-longitude, or cube faces) in direction v. The name \"raytrace\" sends rays from "
        "P, as trace() does: \"samples\" of them, with its other "
        "parameters; \"blur\" is the part of all directions over which they spread (half angle blur * PI), and four vectors span "
        "a cone. Filters are those of maps. "
        "Derivatives go through, as for texture().")
        .derivative = DerivativeRule::Gradient;
    list.back().optional = environmentParameters();
    list.back().examples = {{"color environment(\"sky.env\", N)", "0.5 0.7 1", "", "the map has this colour everywhere"}};
    Shadeop& shadow = addLookup(
        list, "shadow",
        each("float color", "$ shadow(string name; point p; pairs)") +
            each("float color", "$ shadow(string name; point p1, point p2, point p3, point p4; pairs)"),
        Lowering::Service,
        "The part of p's surroundings, 0 to 1, that a depth map puts in shadow: its comparisons with the map, not its "
        "depths, are filtered over the footprint of p, or over that "
        "of four points. Of a deep map (Display \"deepshad\"), what its surfaces take of each colour; the float form is "
        "their mean. 0 where the map does not look. In light shaders under path maps are not read: lights trace their "
        "shadows there. \"raytrace\" sends the rays of transmission() from p to the light: "
        "where L comes from, in a light's own shader or in illuminance(); far away in solar(). The float form of it is the "
        "mean of the channels.");
    list.back().examples = {{"shadow(\"light.shd\", P)", "0"}};
    shadow.contexts = kSurface | kVolume | kLight;
    shadow.optional = shadowParameters();
    addLookup(
        list, "ptexture",
        each("float color", "$ ptexture(string name; uniform float channel; float face; pairs)") +
            each("float color", "$ ptexture(string name; uniform float channel; float face, float s, float t; pairs)") +
            each("float color", "$ ptexture(string name; uniform float channel; float face; " + quad),
        Lowering::Service,
        "Lookup in a Ptex file, which has a picture for each face of a mesh, at s, t of a face (0 to 1 from its first corner to "
        "the second and to the last), or over a quadrilateral. "
        "Without coordinates those of the face at the hit: of triangles and quadrilaterals of polygon meshes, of subdivision "
        "surfaces u and v; of other faces s and t. Filters go across the edges of "
        "faces, from picture to picture. Float: the channel of this number, color: three from it on. Values are linear and "
        "multiplied with alpha. A shader parameter \"float __faceindex\" that the primitive "
        "has no variable for gets the number of the face.");
    for (OptionalParameter& o : list.back().optional)
        if (o.name == "filter") o.doc = "gaussian, triangle, box or point";
    list.back().examples = {{"ptexture(\"none.ptx\", 0, 0)", "0"}};
}

/// What writes files.
void addBaking(std::vector<Shadeop>& list) {
    Shadeop& bake =
        addLookup(list, "bake", each("float color point", "void bake(string file; float s, float t; $ value)"), Lowering::Service,
                  "Writes (s, t, value) to a file, which maketx or MakeTexture turn into a texture. Readable text, one "
                  "line a point: s, t and the numbers of value; binary when the name ends with \"&binary\", which is no "
                  "part of the name. Before the frame is rendered, "
                  "each primitive is shaded once at which a surface, displacement, light or Atmosphere shader bakes, at "
                  "every corner of micropolygons of the size that ShadingRate says, seen or not, in their order; under "
                  "path as often as a pixel has samples, and the mean is written. "
                  "Curves, points and other primitives without a grid are baked where camera rays meet them, but not by "
                  "lights. These bake for each point that asks for their light. docs/pointclouds.md has the format.");
    list.back().examples = {{"x", "7", "float x = 7; bake(\"none.bake\", s, t, x);"}};
    bake.pure = false;
    bake.optional.clear();
    bake.bias = Bias::Unbiased;
    bake.biasReason.clear();
    bake.contexts = kSurface | kDisplacement | kVolume | kLight;
    Shadeop& bake3d = addLookup(
        list, "bake3d", sigs({{"float bake3d(string file, string channels; point p; normal n; pairs)"}}), Lowering::Service,
        "Writes p, n, a radius and values, given as pairs, to a point cloud: .ply where the name says so, else of "
        "docs/pointclouds.md. 1 on success, 0 without a scene. The points are "
        "those of bake(). Points, vectors, normals and matrices among the values go to the space of the file, too. \"_area\" "
        "is the part of the surface that the point "
        "stands for (missing: of its micropolygon), \"_radiosity\" the light that it sends. \"channels\" is not read. Calls "
        "in imagers write nothing.");
    list.back().examples = {{"bake3d(\"light.ptc\", \"\", P, N, \"light\", Cs)", "0"}};
    bake3d.pure = false;
    bake3d.bias = Bias::Unbiased;
    bake3d.biasReason.clear();
    bake3d.contexts = kAnyContext; // 3Delight bakes irradiance from lights
    bake3d.optional = {
        {kS, "coordsystem", false, "\"world\"", "space of the file"},
        {kF, "radius", false, "from the grid", "radius of the disk, or of the ball where n is 0; in the space of the file"},
        {kF, "radiusscale", false, "1", "multiplies the radius"},
        {kF, "interpolate", false, "0", "1 writes the middles of micropolygons instead of their corners"}};
}

void addTexture3d(std::vector<Shadeop>& list) {
    addLookup(
        list, "texture3d", sigs({{"float texture3d(string file; point p; normal n; pairs)"}}), Lowering::Service,
        "Reads values, named as output pairs, from a point cloud, brick map or volume (docs/maps.md): means of the points about "
        "p whose normals fit n (0: all do). 1 on success; 0 where "
        "there is nothing, and the variables stay as they are. What the file has no channel for is 0, and said once.")
        .optional = {
        {kS, "coordsystem", false, "\"world\"", "space of the file"},
        {kF, "filterradius", false, "half the step of p from sample to sample", "radius of the filter; in the space of the file"},
        {kF, "filterscale", false, "1", "multiplies the radius"},
        {kF, "maxdepth", false, "deepest",
         "the finest level that is read, 0 the coarsest: each halves the cells of the cube about the points"}};
    list.back().examples = {{"texture3d(\"none.ptc\", P, N, \"light\", x)", "0", "float x = 3;"}};
}

} // namespace

std::vector<Shadeop> textureShadeops() {
    std::vector<Shadeop> list;
    addPictures(list);
    addBaking(list);
    addTexture3d(list);
    return withFootprints(std::move(list));
}

} // namespace alpenglow::shadeops

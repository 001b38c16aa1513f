// What ri/ writes and everyone else reads: a frame's options, lights, primitives. Append-only once rendering has begun.
// Space conventions: "object" is where a primitive is given; "world" at WorldBegin; "camera" is left-handed, eye at the
// origin, +z into the scene (ri.md section 5). Matrices are row-vector (base/matrix.h).
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include "scene/lightset.h"
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::scene {

enum class Class { Constant, Uniform, Varying, Vertex, FaceVarying, FaceVertex };
enum class Type { Float, Integer, String, Color, Point, Vector, Normal, HPoint, Matrix };
/// Floats per element: Float/Integer/String 1, tuples 3, HPoint 4, Matrix 16.
int componentCount(Type);

/// One parameter of a request: a primitive variable, a shader parameter, an option or attribute value.
struct Param {
    std::string name;
    Class cls = Class::Uniform;
    Type type = Type::Float;
    int arrayLength = 0;              ///< 0 = not an array
    bool declared = true;             ///< false: type guessed from the values; a shader's own declaration decides (wild.md)
    std::vector<float> numbers;       ///< all numeric types, flattened (integers too)
    std::vector<std::string> strings; ///< Type::String
    SourcePlace place;
};
using ParamList = std::vector<Param>;
const Param* find(const ParamList&, std::string_view name);

/// A value that may move: keys[i] at times[i], in shutter units, times increasing. One key when static. Between keys interpolate
/// linearly, element by element; outside hold the end. (A moving Rotate comes with keys close enough for that.)
template <class T> struct Moving {
    std::vector<float> times{0};
    std::vector<T> keys{T{}};
    Moving() = default;
    Moving(T v) : keys{std::move(v)} {}
    const T& first() const { return keys.front(); }
    bool moves() const { return keys.size() > 1; }
};
using Transform = Moving<Matrix>;

/// A shader call: Surface "plastic" "Kd" .5
struct ShaderCall {
    std::string name;
    ParamList params;
    Transform toWorld; ///< "shader" space to world: the CTM at the call
    SourcePlace place;
};
using ShaderRef = std::shared_ptr<const ShaderCall>;

/// Rows as in ri.md 8.3: value at t = (t^3 t^2 t 1) * m * (P0 P1 P2 P3). Bezier by default.
struct Basis {
    double m[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    int step = 3;
    std::string name = "bezier"; ///< "" for a matrix of the file's own
};

/// The attribute state, an immutable snapshot shared by the primitives that were made under it.
struct Attributes {
    Color color{1}, opacity{1};
    ShaderRef surface, displacement, atmosphere, interior, exterior; ///< null = none (surface: the default surface)
    LightSet lights;    ///< indices into Frame::lights that are on, in order of declaration
    int areaLight = -1; ///< index into Frame::lights when primitives made now are its geometry
    float shadingRate = 1;
    bool smoothShading = false; ///< ShadingInterpolation "smooth"
    bool matte = false;
    int sides = 2;
    bool inside = false;             ///< Orientation flag relative to the CTM's handedness ("inside", ReverseOrientation)
    bool absoluteHandedness = false; ///< Orientation "lh"/"rh" was given: then `rightHanded` decides, whatever the CTM
    bool rightHanded = false;
    float textureCoordinates[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    Basis ubasis, vbasis;
    std::optional<std::vector<float>> bound, detail; ///< six numbers, object space
    float detailRange[4] = {0, 0, 1e38f, 1e38f};
    Matrix detailSpace; ///< of `detail`: object space at the request, to world (in an Object: to its own space)
    /// Attribute "class" "name" value, keyed "class:name" (also "user:x");
    /// GeometricApproximation as "GeometricApproximation:motionfactor".
    std::map<std::string, Param> values;
    std::map<std::string, ShaderRef> coshaders;
    /// The nine arrays of TrimCurve as params named ncurves, order, knot, min, max, n, u, v, w.
    std::shared_ptr<const ParamList> trimCurve;
    const Param* value(const std::string& key) const {
        auto i = values.find(key);
        return i == values.end() ? nullptr : &i->second;
    }
};
using AttributesRef = std::shared_ptr<const Attributes>;

/// A geometric primitive as the file gave it. `kind` is the request's name: "Sphere", "PatchMesh", ...
/// Arguments that are not parameters:
///   quadrics: numbers in RIB order ("Sphere": radius zmin zmax thetamax)
///   Polygon: none.  GeneralPolygon: ints = nverts.  PointsPolygons: ints = nverts, ints2 = verts.
///   PointsGeneralPolygons: ints = nloops, ints2 = nverts, ints3 = verts.
///   Patch: strings[0] = type.  PatchMesh: strings = {type, uwrap, vwrap} with wraps "periodic"/"nonperiodic", ints = {nu, nv}.
///   NuPatch: ints = {nu, uorder, nv, vorder}, knots in params "uknot" "vknot", numbers = {umin, umax, vmin, vmax}.
///   Curves: strings = {type, wrap}, ints = nvertices.
///   SubdivisionMesh: strings = {scheme, tags...}, ints = nverts, ints2 = verts, ints3 = nargs, params
///   "intargs" "floatargs".  Procedural and others: strings, numbers as given.
///   HierarchicalSubdivisionMesh: as SubdivisionMesh, nargs in threes, param "stringargs".  Points: none.
///   Blobby: ints = {nleaf}, ints2 = code, numbers = floats, strings = strings.  Geometry: strings[0] = name.
///   Volume: strings[0] = type, numbers = bound, ints = dimensions.
/// Moving primitives hold one Primitive per key in `motionKeys` after the first, with times in motionTimes.
///
/// What ri/ guarantees, so that nobody need look again (scene/counts.h has the counts, ri.md 7.1):
/// - The arguments agree with each other: sums of counts match index arrays, indices are not negative, knots do not decrease,
///   meshes fit the steps of their bases. Numbers are finite. PatchMesh and Patch types are "bilinear" or "bicubic".
/// - Polygons, meshes, patches, curves and points have exactly one of "P", "Pw" (HPoint), "Pz" (Float; patches only), class
///   Vertex, of exactly counts.vertex elements (unused points at the end of a mesh are cut off).
/// - Every other variable has exactly counts.of(cls) * max(arrayLength, 1) * componentCount(type) numbers, all finite (or that
///   many strings). Names are unique. A variable with declared == false has the class and arrayLength its length fits best.
///   The argument params named above ("uknot", "intargs" ...) have class Constant and any length.
/// - Keys of a moving primitive have the same kind, arguments that are counts, and variables of the same names, classes and
///   sizes. motionTimes (one per key, the first included) increase.
struct Primitive {
    std::string kind;
    std::vector<float> numbers;
    std::vector<int> ints, ints2, ints3;
    std::vector<std::string> strings;
    ParamList params;
    AttributesRef attributes;
    Transform toWorld; ///< object to world; for primitives inside an Object: object to the object's own space
    std::vector<float> motionTimes;
    std::vector<std::shared_ptr<Primitive>> motionKeys;
    SourcePlace place;
    /// Inside an Object only: attributes were set between ObjectBegin and here, so they hold in every instance.
    /// Otherwise an instance's own attributes count (ri.md 9.2). Never null either way.
    bool attributesInside = false;
    AttributesRef attributesBefore; ///< with attributesInside: those at ObjectBegin. What differs from them was set inside
};
using PrimitiveRef = std::shared_ptr<const Primitive>;

struct Light {
    ShaderRef shader; ///< the light shader call
    std::string handle;
    /// AreaLightSource: its geometry is the primitives with attributes->areaLight == this light's index.
    bool area = false;
    AttributesRef attributes; ///< at the request (light samples, strategy, visibility)
};

/// ObjectBegin..ObjectEnd, or what an instance shares.
struct Object {
    std::string handle;
    std::vector<PrimitiveRef> primitives;
};
struct Instance {
    int object = -1;
    Transform toWorld;
    AttributesRef attributes;
    SourcePlace place;
};

struct PixelFilter {
    std::string name = "gaussian";
    float xwidth = 2, ywidth = 2;
};
struct Quantize {
    float one = 0, min = 0, max = 0, dither = 0;
    bool set = false;
};

struct Display {
    std::string name = "ri.pic", type = "file", mode = "rgba";
    ParamList params; ///< "quantize", "exposure", "filter", "filterwidth", "dither" etc.
    SourcePlace place;
    bool read = false; ///< a Make request of the scene reads its file
};

/// Frozen at WorldBegin.
struct Options {
    int xres = 640, yres = 480;
    float pixelAspect = 1;
    bool formatSet = false;
    std::optional<float> frameAspect;
    std::optional<std::vector<float>> screenWindow; ///< left right bottom top
    float crop[4] = {0, 1, 0, 1};
    std::string projection = "orthographic";
    ParamList projectionParams;
    float fov = 90;
    float clipNear = 1e-10f, clipFar = 1e38f;
    std::vector<std::pair<Vec3d, Vec3d>> clippingPlanes; ///< camera space point, normal; the side the normal points to is removed
    float fstop = 1e38f, focalLength = 0, focalDistance = 0;
    float shutterOpen = 0, shutterClose = 0;
    float pixelSamplesX = 2, pixelSamplesY = 2;
    bool pixelSamplesSet = false;
    float pixelVariance = -1; ///< < 0: unset
    PixelFilter filter;
    float gain = 1, gamma = 1;
    bool exposureSet = false; ///< Exposure was called, also with 1 1
    ShaderRef imager;
    AttributesRef attributes; ///< those at WorldBegin: what the imager sees. Null where no stream was read
    Quantize quantizeRgba{255, 0, 255, 0.5f, false}, quantizeZ{0, 0, 0, 0, false};
    std::vector<Display> displays;                         ///< empty: ri.pic
    std::map<std::string, Param> displayChannels;          ///< by name: the declaration, no values
    std::map<std::string, ParamList> displayChannelParams; ///< by name: "quantize", "filter" etc. of that channel
    std::string hider = "hidden";
    SourcePlace hiderPlace;
    ParamList hiderParams;
    float relativeDetail = 1;
    int colorSamples = 3;
    std::map<std::string, Param> values; ///< Option "class" "name", keyed "class:name"
    int frameNumber = 0;
    bool inFrame = false; ///< between FrameBegin and FrameEnd
    Transform worldToCamera;
    /// Named coordinate systems: name -> matrix from that space to camera.
    std::map<std::string, Transform> cameraSpaces;
};

/// One WorldBegin..WorldEnd, complete.
struct Frame {
    Options options;
    std::vector<Light> lights;
    std::vector<PrimitiveRef> primitives;
    std::vector<Object> objects;
    std::vector<Instance> instances;
    /// CoordinateSystem names, to world.
    std::map<std::string, Transform> coordinateSystems;
};

/// What a RIB stream does; ri/ calls it, render/ implements it.
class FrameConsumer {
public:
    virtual ~FrameConsumer() = default;
    /// WorldEnd. The frame is complete; the call returns when it is rendered (or refused).
    virtual void render(std::shared_ptr<const Frame>) = 0;
    /// MakeTexture and its kin, in stream order. kind = request name.
    virtual void makeTexture(const std::string& kind, const std::vector<std::string>& files, const ParamList& args,
                             const SourcePlace&) = 0;
    /// A world, or a Make request, of a frame that is not wanted: nothing is made.
    virtual void passOver(const Options&) {}
    virtual void passOverTexture(const std::vector<std::string>& /*files*/) {}
};

} // namespace alpenglow::scene

// Primitives as a file gives them, and the attributes that hold for them.
// Space conventions: "object" is where a primitive is given; "world" at WorldBegin; "camera" is left-handed, eye at the
// origin, +z into the scene (RISpec 3.2, 4.3). Matrices are row-vector (base/matrix.h).
#pragma once
#include "scene/lightset.h"
#include "scene/param.h"
#include "scene/solidstep.h"
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::scene {

/// The attribute state, an immutable snapshot shared by the primitives that were made under it.
struct Attributes {
    Color color{1}, opacity{1};                                      ///< linear
    ShaderRef surface, displacement, atmosphere, interior, exterior; ///< null = none (surface: the default surface)
    LightSet lights;                 ///< indices into Frame::lights that are on, in order of declaration
    int areaLight = -1;              ///< index into Frame::lights when primitives made now are its geometry
    float shadingRate = 1;           ///< pixels, area of a micropolygon
    bool smoothShading = false;      ///< ShadingInterpolation "smooth"
    bool matte = false;              ///< Matte: a hole in the picture
    int sides = 2;                   ///< 1 or 2
    bool inside = false;             ///< Orientation flag relative to the CTM's handedness ("inside", ReverseOrientation)
    bool absoluteHandedness = false; ///< Orientation "lh"/"rh" was given: then `rightHanded` decides, whatever the CTM
    bool rightHanded = false;        ///< "rh" was given
    float textureCoordinates[8] = {0, 0, 1, 0, 0, 1, 1, 1}; ///< s and t at the corners of a patch (RISpec 3.2, 4.2)
    Basis ubasis, vbasis;                                   ///< of patches and curves, along u and v
    std::optional<std::vector<float>> bound, detail;        ///< six numbers, object space
    float detailRange[4] = {0, 0, 1e38f, 1e38f}; ///< minvisible lowertransition uppertransition maxvisible: pixels, area
    Matrix detailSpace; ///< of `detail`: object space at the request, to world (in an Object: to its own space)
    /// Attribute "class" "name" value, keyed "class:name" (also "user:x");
    /// GeometricApproximation as "GeometricApproximation:motionfactor".
    std::map<std::string, Param> values;
    std::map<std::string, ShaderRef> coshaders;
    /// The nine arrays of TrimCurve as params named ncurves, order, knot, min, max, n, u, v, w.
    std::shared_ptr<const ParamList> trimCurve;
    // State of the renderer, which no request names.
    std::vector<SolidStep> solid; ///< the open blocks of SolidBegin, from the outermost (scene/solids.h)
    int solidChildren = 0;        ///< blocks and parts that the innermost of them has had
    std::string part;             ///< scene::partOf() (scene/deferred.h)
    /// Between levels of detail: what is made is there for samples whose own number in [0, 1) is at least the first and below
    /// the second. Nothing: for all.
    std::optional<std::array<float, 2>> level;
    /// The value of an attribute, "class:name"; null if it is not set.
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
/// What ri/ guarantees, so that no other code has to check it (scene/counts.h has the counts, docs/design/ri.md):
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
    AttributesRef attributes; ///< never null
    Transform toWorld;        ///< object to world; for primitives inside an Object: object to the object's own space
    std::vector<float> motionTimes;
    std::vector<std::shared_ptr<Primitive>> motionKeys;
    SourcePlace place; ///< of the request
    /// Inside an Object only: attributes were set between ObjectBegin and here, so they hold in every instance.
    /// Otherwise an instance's own attributes count (RISpec 3.2, 5.10). Never null either way.
    bool attributesInside = false;
    AttributesRef attributesBefore; ///< with attributesInside: those at ObjectBegin. What differs from them was set inside
};
using PrimitiveRef = std::shared_ptr<const Primitive>;

/// LightSource or AreaLightSource.
struct Light {
    ShaderRef shader;   ///< the light shader call
    std::string handle; ///< of the request, for Illuminate; may be ""
    /// AreaLightSource: its geometry is the primitives with attributes->areaLight == this light's index.
    bool area = false;
    AttributesRef attributes; ///< at the request (light samples, strategy, visibility)
};

} // namespace alpenglow::scene

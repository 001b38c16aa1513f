// Models and scenes of other programs: what modules read (glTF 2.0 by tinygltf, FBX and many more by assimp) in one form, which
// becomes RIB (rib.h). Spaces are right-handed, y up; matrices are those of base/matrix.h (row vectors); (0, 0) of texture
// coordinates is the upper left corner of a picture; colours are light, angles radians, times seconds.
// Source of the meanings: glTF 2.0 and its ratified extensions KHR_* (registry.khronos.org/glTF).
#pragma once
#include "base/matrix.h"
#include <cstdint>
#include <string>
#include <vector>

namespace alpenglow::models {

inline constexpr int kNone = -1; ///< no such element

/// A picture as it was encoded: a file that can be opened, or the bytes of one.
struct Image {
    std::string name;
    std::string file;           ///< "": the bytes count
    std::vector<uint8_t> bytes; ///< PNG, JPEG, ...
};

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

/// A use of a picture. Its coordinates are those of the set, scaled, turned and moved (KHR_texture_transform).
struct Texture {
    int32_t image = kNone, set = 0;
    Wrap s = Wrap::Repeat, t = Wrap::Repeat;
    double scale[2] = {1, 1}, offset[2] = {0, 0}, rotation = 0;
    bool used() const { return image != kNone; }
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// glTF's material: factors multiply their textures.
struct Material {
    std::string name;
    bool unlit = false;
    AlphaMode alphaMode = AlphaMode::Opaque;
    double baseColor[4] = {1, 1, 1, 1}, alphaCutoff = 0.5;
    double metalness = 1, roughness = 1, normalScale = 1, ior = 1.5;
    double emission[3] = {0, 0, 0}; ///< with its strength: luminance in cd/m2, which is radiance here
    double specular = 1, specularColor[3] = {1, 1, 1};
    double coat = 0, coatRoughness = 0;
    double transmission = 0, thickness = 0; ///< thickness 0: a sheet
    double attenuationDistance = 0;         ///< 0: nothing is absorbed
    double attenuationColor[3] = {1, 1, 1};
    double sheenColor[3] = {0, 0, 0}, sheenRoughness = 0;
    Texture baseColorMap;  ///< sRGB, alpha
    Texture metalRoughMap; ///< roughness in g, metalness in b
    Texture normalMap, emissionMap, coatMap, coatRoughnessMap, transmissionMap, specularMap, specularColorMap, sheenColorMap,
        sheenRoughnessMap;
};

/// What a shape of a mesh adds to its vertices.
struct MorphTarget {
    std::vector<float> P, N; ///< 3 a vertex, or none
};

enum class PartKind : uint8_t { Polygons, Points, Lines };

/// Faces, points or lines of one material.
struct Part {
    PartKind kind = PartKind::Polygons;
    int32_t material = kNone;
    std::vector<int32_t> counts;        ///< corners of a face, vertices of a line; Polygons without: triangles
    std::vector<int32_t> corners;       ///< vertices of the corners; Points without: all
    std::vector<float> P;               ///< 3 a vertex
    std::vector<float> N;               ///< 3 a vertex, or none
    std::vector<float> color;           ///< 4 a vertex, or none
    std::vector<std::vector<float>> st; ///< sets: 2 a vertex each
    int32_t influences = 0;             ///< joints that move a vertex
    std::vector<int32_t> joints;        ///< of the skin, `influences` a vertex
    std::vector<float> weights;         ///< likewise; need not add up to 1
    std::vector<MorphTarget> targets;
    size_t vertices() const { return P.size() / 3; }
};

struct Mesh {
    std::string name;
    std::vector<Part> parts;
    std::vector<double> weights; ///< of the targets, where no node has any
    int32_t skin = kNone;        ///< where no node has one
};

struct Skin {
    std::vector<int32_t> joints;  ///< nodes
    std::vector<Matrix> bindings; ///< from the mesh to the joint as it was bound; fewer: identity
};

struct Camera {
    std::string name;
    bool perspective = true;
    double yfov = 0.8, aspect = 0; ///< aspect: width by height, 0: not given
    double halfHeight = 1;         ///< orthographic
    double near = 0, far = 0;      ///< 0: not given. It looks along -z, y is up
};

enum class LightKind : uint8_t { Point, Spot, Sun };

/// Shines along -z.
struct Light {
    std::string name;
    LightKind kind = LightKind::Point;
    double color[3] = {1, 1, 1};
    double intensity = 1;                        ///< candela; Sun: lux
    double inner = 0, outer = 0.785398163397448; ///< of a cone, from its axis
};

/// Place below the parent: the matrix, or where that is not given or the node is animated scale, then rotation, then translation.
struct Node {
    std::string name;
    int32_t parent = kNone;
    bool hasMatrix = false;
    Matrix matrix;
    double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1}; ///< rotation: a quaternion, x y z w
    std::vector<int32_t> meshes;
    int32_t skin = kNone, camera = kNone, light = kNone;
    std::vector<double> weights; ///< of the targets of its meshes
};

enum class Path : uint8_t { Translation, Rotation, Scale, Weights };
enum class Interpolation : uint8_t { Linear, Step, Cubic };

struct Channel {
    int32_t node = kNone;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< growing
    std::vector<float> values; ///< a key: 3, 4 or as many as there are targets; Cubic: tangent, value, tangent
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
};

/// Something that was left out or read in another way.
struct Note {
    bool error = false; ///< else a warning
    std::string text;
};

struct Model {
    std::string generator; ///< who wrote the file; may be ""
    std::vector<Image> images;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<Node> nodes;
    std::vector<int32_t> roots; ///< what is drawn: these nodes and what is below them
    std::vector<Animation> animations;
    std::vector<Note> notes;
};

} // namespace alpenglow::models

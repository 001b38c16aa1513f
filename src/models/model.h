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
    std::string name;           ///< for names of maps and messages; may be ""
    std::string file;           ///< "": the bytes count
    std::vector<uint8_t> bytes; ///< PNG, JPEG, ...
};

/// Texture coordinates outside 0 to 1.
enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

/// A use of a picture. Its coordinates are those of the set, scaled, turned and moved (KHR_texture_transform).
struct Texture {
    int32_t image = kNone, set = 0;                             ///< index of the picture; index of the set of coordinates
    Wrap s = Wrap::Repeat, t = Wrap::Repeat;                    ///< along the two coordinates
    double scale[2] = {1, 1}, offset[2] = {0, 0}, rotation = 0; ///< applied in this order: scale, rotation, offset
    /// There is a picture.
    bool used() const { return image != kNone; }
};

/// What opacity means. Mask: opaque from Material::alphaCutoff on, else absent.
enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// glTF's material: factors multiply their textures.
struct Material {
    std::string name;                                      ///< as in the file; may be ""
    bool unlit = false;                                    ///< shows its colour without light
    AlphaMode alphaMode = AlphaMode::Opaque;               ///< of baseColor's fourth number times that of its map
    double baseColor[4] = {1, 1, 1, 1}, alphaCutoff = 0.5; ///< linear; the fourth number is opacity
    /// Metalness and roughness 0 to 1; roughness is the square root of GGX's alpha.
    double metalness = 1, roughness = 1, normalScale = 1, ior = 1.5;
    double emission[3] = {0, 0, 0}; ///< with its strength: luminance in cd/m2, which is radiance here
    /// Of dielectrics: factor and tint of the reflection at normal incidence.
    double specular = 1, specularColor[3] = {1, 1, 1};
    double coat = 0, coatRoughness = 0;                   ///< clear coat, both 0 to 1
    double transmission = 0, thickness = 0;               ///< thickness 0: a sheet
    double attenuationDistance = 0;                       ///< 0: nothing is absorbed
    double attenuationColor[3] = {1, 1, 1};               ///< what is left after attenuationDistance, linear
    double sheenColor[3] = {0, 0, 0}, sheenRoughness = 0; ///< linear; roughness 0 to 1
    Texture baseColorMap;                                 ///< sRGB, alpha
    Texture metalRoughMap;                                ///< roughness in g, metalness in b
    /// Channels as in glTF: normals in tangent space, emission and tints sRGB; coat and transmission in r, roughness of coat in
    /// g, specular and roughness of sheen in alpha.
    Texture normalMap, emissionMap, coatMap, coatRoughnessMap, transmissionMap, specularMap, specularColorMap, sheenColorMap,
        sheenRoughnessMap;
};

/// What a shape of a mesh adds to its vertices.
struct MorphTarget {
    std::vector<float> P, N; ///< 3 a vertex, or none
};

/// What the corners of a part form.
enum class PartKind : uint8_t { Polygons, Points, Lines };

/// Faces, points or lines of one material.
struct Part {
    PartKind kind = PartKind::Polygons; ///< what P holds
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
    std::vector<MorphTarget> targets;   ///< by weight of the node or mesh
    /// Number of vertices.
    size_t vertices() const { return P.size() / 3; }
};

/// Parts that share a place, a skin and weights.
struct Mesh {
    std::string name;            ///< as in the file; may be ""
    std::vector<Part> parts;     ///< one for each material
    std::vector<double> weights; ///< of the targets, where no node has any
    int32_t skin = kNone;        ///< where no node has one
};

/// Joints that move the vertices of a mesh.
struct Skin {
    std::vector<int32_t> joints;  ///< nodes
    std::vector<Matrix> bindings; ///< from the mesh to the joint as it was bound; fewer: identity
};

/// A view of the scene.
struct Camera {
    std::string name;              ///< as in the file; may be ""
    bool perspective = true;       ///< else orthographic
    double yfov = 0.8, aspect = 0; ///< aspect: width by height, 0: not given
    double halfHeight = 1;         ///< orthographic
    double near = 0, far = 0;      ///< 0: not given. It looks along -z, y is up
};

/// Spot is a cone; Sun has parallel rays.
enum class LightKind : uint8_t { Point, Spot, Sun };

/// Shines along -z.
struct Light {
    std::string name;                            ///< as in the file; may be ""
    LightKind kind = LightKind::Point;           ///< how it emits
    double color[3] = {1, 1, 1};                 ///< linear
    double intensity = 1;                        ///< candela; Sun: lux
    double inner = 0, outer = 0.785398163397448; ///< of a cone, from its axis
};

/// Place below the parent: the matrix, or where that is not given or the node is animated scale, then rotation, then translation.
struct Node {
    std::string name; ///< as in the file; may be ""
    int32_t parent = kNone;
    bool hasMatrix = false; ///< else the three values below count
    Matrix matrix;
    double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1}; ///< rotation: a quaternion, x y z w
    std::vector<int32_t> meshes;                                                         ///< indices
    int32_t skin = kNone, camera = kNone, light = kNone;                                 ///< indices; kNone: it has none
    std::vector<double> weights;                                                         ///< of the targets of its meshes
};

/// What of a node an animation changes.
enum class Path : uint8_t { Translation, Rotation, Scale, Weights };
/// How values between keys are found. Cubic: Hermite splines (glTF 2.0, appendix C).
enum class Interpolation : uint8_t { Linear, Step, Cubic };

/// The keys of one value of one node.
struct Channel {
    int32_t node = kNone;                                ///< index
    Path path = Path::Translation;                       ///< which value
    Interpolation interpolation = Interpolation::Linear; ///< between keys
    std::vector<float> times;                            ///< growing
    std::vector<float> values; ///< a key: 3, 4 or as many as there are targets; Cubic: tangent, value, tangent
};

/// Channels that run together.
struct Animation {
    std::string name;              ///< as in the file; may be ""
    std::vector<Channel> channels; ///< at most one for each value of a node
};

/// Something that was left out or read in another way.
struct Note {
    bool error = false; ///< else a warning
    std::string text;   ///< for the user
};

/// All of a file. Indices in it are checked by check.h before it is used.
struct Model {
    std::string generator; ///< who wrote the file; may be ""
    /// Numbered by the indices of the other members.
    std::vector<Image> images;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<Node> nodes;
    std::vector<int32_t> roots;        ///< what is drawn: these nodes and what is below them
    std::vector<Animation> animations; ///< those of the file; RibOptions::animation selects
    std::vector<Note> notes;           ///< to report
};

} // namespace alpenglow::models

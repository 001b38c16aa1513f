// Names of attribute() and option() (3Delight manual, 6.4.8), and the values they have when the scene does not say.
#pragma once
#include "world/impl.h"
#include <optional>

namespace alpenglow::transport {

/// Numbers, or texts: one, or those of an array.
struct Information {
    std::vector<float> numbers;
    std::vector<std::string> texts;
    bool isText = false;
};

/// An attribute of Table 6.20 (seed), "user:..." or any "class:name" of the scene. `point` and `binding` may be null: then what
/// belongs to a point or its shaders is not known. Nothing for a name that nobody has.
std::optional<Information> attributeOf(const WorldImpl&, const scene::Attributes&, const std::string& name,
                                       const shading::ShadePoint* point, const SurfaceBinding* binding);
/// Whether an attribute of this name differs from point to point of a primitive.
bool ofPoint(const std::string& name);
/// An option of the frame (Table 6.21, "user:..." or "class:name").
std::optional<Information> optionOf(const WorldImpl&, const std::string& name);
/// What rendererinfo() knows by that name.
std::optional<Information> rendererInfoOf(const std::string& name);
/// What rayinfo() knows by that name of the ray that found the point. Null: there is none, as where shapes are diced or light
/// leaves.
std::optional<Information> rayInfoOf(const std::string& name, const shading::PathRay*, const shading::ShadePoint&);
/// The matrix between two spaces that are known only now, at a point. "object" and "shader" are the point's own.
Matrix spaceAt(const WorldImpl&, const std::string& from, const std::string& to, const shading::ShadePoint&,
               const SurfaceBinding*);

} // namespace alpenglow::transport

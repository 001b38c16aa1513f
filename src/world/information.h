// Values of attribute(), option() and their kin (3Delight manual, 6.4.8), with defaults.
#pragma once
#include "world/impl.h"
#include <optional>

namespace alpenglow::world {

/// Numbers or strings: one, or an array.
struct Information {
    std::vector<float> numbers;     ///< of numbers
    std::vector<std::string> texts; ///< of texts
    bool isText = false;            ///< `texts` counts
};

/// An attribute (3Delight manual, Table 6.20), "user:..." or any "class:name" of the scene. `point` and `binding` may be null;
/// values that depend on them are then unknown. Returns nothing for unknown names.
std::optional<Information> attributeOf(const WorldImpl&, const scene::Attributes&, const std::string& name,
                                       const shading::ShadePoint* point, const SurfaceBinding* binding);
/// Whether this attribute varies over a primitive.
bool ofPoint(const std::string& name);
/// An option of the frame (Table 6.21, "user:..." or "class:name").
std::optional<Information> optionOf(const WorldImpl&, const std::string& name);
/// A value of rendererinfo().
std::optional<Information> rendererInfoOf(const std::string& name);
/// A value of rayinfo() for the ray that found the point. Null ray: none, as at dicing or at light samples.
std::optional<Information> rayInfoOf(const std::string& name, const shading::PathRay*, const shading::ShadePoint&);
/// The matrix between two spaces whose names are known only at run time, at a point. "object" and "shader" are the point's.
Matrix spaceAt(const WorldImpl&, const std::string& from, const std::string& to, const shading::ShadePoint&,
               const SurfaceBinding*);

} // namespace alpenglow::world

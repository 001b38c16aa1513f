#pragma once
#include <string>

namespace alpenglow::ri {

/// The requests that draw Geometry "teapot" under the current transformation and attributes: four bicubic patch meshes in an
/// attribute block of their own, normals (dP/du x dP/dv) to the outside.
const std::string& teapotRequests();

} // namespace alpenglow::ri

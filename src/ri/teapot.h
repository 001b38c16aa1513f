#pragma once
#include <string>

namespace alpenglow::ri {

/// The requests that draw Geometry "teapot" under the current transformation and attributes: four bicubic patch meshes in an
/// attribute block of their own, normals (dP/du x dP/dv) to the outside.
const std::string& teapotRequests();
/// The same for Geometry "cube", from -1/2 to 1/2 on every axis, and for Geometry "sphere", of radius 1.
const std::string& cubeRequests();
const std::string& sphereRequests();

} // namespace alpenglow::ri

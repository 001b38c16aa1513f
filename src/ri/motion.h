// Arithmetic of moving transforms.
#pragma once
#include "scene/motion.h"

namespace alpenglow::ri {

using scene::at;
using scene::compose;
/// Key by key; *singular as for the matrix (any key).
scene::Transform inverse(const scene::Transform& m, bool* singular = nullptr);
bool finite(const Matrix& m);
/// Keys from one rotation to another by interpolated angle, close enough (7.5 degrees) that linear interpolation between them
/// shrinks a radius by at most 1 - cos(3.75 deg) = 0.2 %. Angles in degrees about one axis; at most 96 keys.
void addRotationKeys(scene::Transform& out, double t0, double angle0, double t1, double angle1, double x, double y, double z);

} // namespace alpenglow::ri

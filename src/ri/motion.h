// Arithmetic of moving transforms.
#pragma once
#include "scene/motion.h"

namespace alpenglow::ri {

using scene::at;
using scene::compose;
/// Key by key; *singular as for the matrix (any key).
scene::Transform inverse(const scene::Transform& m, bool* singular = nullptr);
/// Whether all elements are finite.
bool finite(const Matrix& m);
/// Keys from one rotation to another by interpolated angle, close enough (2.5 degrees) that linear interpolation between them
/// shrinks a radius by at most 1 - cos(1.25 deg) = 0.024 %. Angles in degrees about one axis; at most 360 keys.
void addRotationKeys(scene::Transform& out, double t0, double angle0, double t1, double angle1, double x, double y, double z);

/// Keys from one matrix to another: the rotation in them (by the polar decomposition) turns about one axis in keys as close as
/// above, stretch and translation go linearly. Linear altogether where there is a perspective, no inverse, another handedness, or
/// half a turn, whose axis is not known. The first key is added only to an empty `out`.
void addMatrixKeys(scene::Transform& out, double t0, const Matrix& m0, double t1, const Matrix& m1);

} // namespace alpenglow::ri

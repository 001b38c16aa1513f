// What a picture lacks, said once a frame: channels that nothing gives, a camera that sees nothing, surfaces that nothing lights.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// A warning for each variable of a display that no shader of the frame and no predefined variable gives: its channels are 0.
void sayMissingOutputs(const OutputPlan&, const transport::World&, Diagnostics&);

/// A warning when the frame is done: no camera ray met a surface or light, or surfaces were met and all of them are black.
/// Nothing of pictures without colour, of parts of a picture, and of what was interrupted.
void sayEmptyPicture(const Job&, const scene::Frame&, Diagnostics&);

/// A warning when the frame is done for each call of occlusion(), indirectdiffuse() and gather() that makes whole primitives
/// black as its normals are turned.
void sayTurnedAway(const Job&, Diagnostics&);

/// A warning when the frame is done for each point cloud in which texture3d() found nothing at any point. Nothing of parts of a
/// picture and of what was interrupted.
void sayEmptyClouds(const Job&, Diagnostics&);

} // namespace alpenglow::render

// Warnings about empty results, once a frame: channels without a source, a camera that sees nothing, surfaces without light.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Warns for each display variable that is neither a shader output of the frame nor predefined: its channels are 0.
void sayMissingOutputs(const OutputPlan&, const world::World&, Diagnostics&);

/// After the frame: warns if no camera ray hit a surface or light, or if all surfaces are black. Says nothing about pictures
/// without colour, parts of a picture, and interrupted frames.
void sayEmptyPicture(const Job&, const scene::Frame&, Diagnostics&);

/// After the frame: warns about each call of occlusion(), indirectdiffuse() and gather() that renders complete primitives black
/// because its normals are flipped.
void sayTurnedAway(const Job&, Diagnostics&);

/// After the frame: warns about each point cloud in which no texture3d() found anything. Says nothing about parts of a picture
/// and interrupted frames.
void sayEmptyClouds(const Job&, Diagnostics&);

/// After the frame: warns about each scattering medium out of which a noticeable part of its rays goes without a surface.
void sayOpenMedia(const Job&, const integrator::Counters&, Diagnostics&);

} // namespace alpenglow::render

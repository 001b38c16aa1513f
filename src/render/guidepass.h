// The caustic guide of a frame under path, built from photons before the first sample (docs/light.md). Internal to render/.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Removes what these functions have learned: guides, and the bound of small light samples.
void forgetLearned(Job&);
/// Builds the guide unless the options disable it or photons find no caustics. The guide is equal for all parts, samples and
/// threads of a picture. Returns false if stopped.
bool learnCaustics(Job&);
/// The same for lights that no ray meets: finds where searches for their light by mirrors and glass begin (world/causticseeds.h).
bool learnSeeds(Job&);
/// Builds the guides of light samples, likewise.
bool learnLights(Job&);
/// Learns how bright the picture is, so that light samples that bring little of it can be left out at random
/// (world::PhotonStore::leastLight). Returns false if stopped.
bool learnBrightness(Job&);

} // namespace alpenglow::render

// Structures that the language has of itself. They are written in it, and read before a text that speaks of them.
#pragma once
#include "rsl/front/preprocessor.h"

namespace alpenglow::rsl::front {

/// Puts the definitions of the built-in structures that the text names before it (RSL 2: filterregion, __radiancesample).
void addPrelude(SourceSet&, Preprocessed&);

/// Gives classes that call directlighting() and have a method evaluateSamples(), or indirectspecular() and generateSamples(),
/// methods that do it, which they call instead.
void addDirectLighting(SourceSet&, Preprocessed&);

/// Gives class lights of PRMan that send their light through generateSamples() a method light() that takes it from there.
void addSampledLights(SourceSet&, Preprocessed&);

/// Gives light shaders Ps for P (dialectLitPoint()).
void readLitPoints(Preprocessed&);

using Tokens = std::vector<Token>;
/// Behind the bracket that closes the one at `open`; the end of the text if there is none.
size_t behind(const Tokens&, size_t open);

} // namespace alpenglow::rsl::front

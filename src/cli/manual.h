// The manual of the shadeops, from their descriptors: as plain text, as JSON, and as Markdown (docs/shadeops.md, the hovers of
// the language server).
#pragma once
#include "shadeops/descriptor.h"
#include <nlohmann/json.hpp>
#include <string>

namespace alpenglow::cli {

/// "surface, volume"; "any shader" for all kinds.
std::string contextText(uint32_t contexts);

/// The descriptor as text, as `alpenglow info --shadeops NAME` prints it.
std::string manualText(const shadeops::Shadeop&);
/// The same for programs.
nlohmann::ordered_json manualJson(const shadeops::Shadeop&);
/// Without a heading. `first` (may be null) is the signature to be shown before the others.
std::string manualMarkdown(const shadeops::Shadeop&, const shadeops::Signature* first = nullptr);
/// The whole page docs/shadeops.md: by section, every shadeop that a shader may name.
std::string manualPage();

} // namespace alpenglow::cli

// A model as bytes, which a module in its child process sends and the program takes (modelfile.h). Both are built from the same
// sources; what arrives is looked at as a stranger's file is, because the module may have been led astray by one.
#pragma once
#include "models/model.h"
#include <optional>
#include <span>

namespace alpenglow::models {

/// Bytes for fromBytes().
std::vector<uint8_t> toBytes(const Model&);
/// Nothing: the bytes are not what toBytes() makes. Numbers are not looked at: check.h.
std::optional<Model> fromBytes(std::span<const uint8_t>);

} // namespace alpenglow::models

// What is wrong with a model, before anyone uses it.
#pragma once
#include "models/model.h"

namespace alpenglow::models {

/// Afterwards every index leads to an element or is kNone, nodes form trees, every array is as long as it must be, all numbers
/// are finite, no face has fewer than three corners. What was not so is left out, each kind with a Note added to m.notes.
void check(Model& m);

/// The nodes that are drawn, parents before children.
std::vector<int> drawnNodes(const Model&);

} // namespace alpenglow::models

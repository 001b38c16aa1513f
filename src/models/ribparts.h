// Parts of meshes as requests of RIB.
#pragma once
#include "models/model.h"
#include <functional>
#include <string_view>

namespace alpenglow::models {

/// PointsPolygons, Points or Curves with the variables P, N, st (of this set of coordinates), Cs and Os. Vertices that nobody
/// uses are left out. P and N take the place of the part's own.
void partText(const Part&, const std::vector<float>& P, const std::vector<float>& N, int set,
              const std::function<void(std::string_view)>& out);

/// "[...]"
std::string matrixText(const Matrix&);

} // namespace alpenglow::models

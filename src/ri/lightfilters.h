// Light filters and light profiles of RIS as numbers that the shaders of lights read (shaders/include/rislight.h).
#pragma once
#include "base/matrix.h"
#include "scene/param.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// One LightFilter: a row of kFilterRow numbers (the layout stands in lightfilters.cpp and rislight.h), and the name of its map.
struct LightFilter {
    std::vector<float> row;
    std::string map;
    std::string handle, groups; ///< "linkingGroups"
};
inline constexpr size_t kFilterRow = 128, kFilterKnots = 16;

/// The filters that lights get which are named from here on; null: none.
using LightFilters = std::shared_ptr<const std::vector<LightFilter>>;

/// A LightFilter of that name with its parameters. toFilter: from world space. Nothing: there is none of that name here.
std::optional<LightFilter> lightFilter(const std::string& name, const scene::ParamList& given, const Matrix& toFilter);

/// The candelas of a profile of IES LM-63 (1986 to 2019), divided by the largest, as numbers: how many angles from the axis, how
/// many around it, those angles in degrees, and the values, those of one plane after the other. Types A and B are no photometry
/// of lamps: they are refused, as is what cannot be read; `why` then says what is wrong.
std::optional<std::vector<float>> lightProfile(const std::string& text, std::string& why);

} // namespace alpenglow::ri

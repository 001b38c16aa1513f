// A second evaluator of the language, slow and simple: it walks the checked tree at one point, statement by statement, as a
// reader of the text would. It shares the front end with the renderer and nothing behind it: no IR, no passes, no lanes, no
// masks.
#pragma once
#include "rsl/front/ast.h"
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// A number, a tuple, a matrix (row by row) or a string. Truth values are 0 and 1.
struct Walked {
    Base base = Base::Float;
    std::array<float, 16> n{};
    std::string s;
};

/// Component of a predefined variable at the point.
using WalkerInput = std::function<float(const std::string& name, int component)>;

/// The lights of illuminance: L, Cl and Ol one after the other, and whether a cone holds a light.
struct WalkedLights {
    std::vector<std::array<float, 9>> all;
    std::function<bool(const float* L, const float* axis, float angle)> lit;
};

/// Runs a shader whose parameters have their defaults; the final values of its output parameters by name. Throws
/// std::runtime_error at what it does not know (lights where none are given, rays, named spaces, derivatives) and after too many
/// steps.
std::map<std::string, Walked> walk(const Shader&, const WalkerInput&, const WalkedLights& = {});

/// A pure shadeop by its definition over single floats (walker_shadeops.cpp); output arguments change in place. Elementary
/// functions, noise, colour spaces and the inverse of a matrix come from the shadeop's own code at one point, which
/// tests/shadeops holds against double precision and closed forms. Throws for others.
Walked walkShadeop(const Shadeop&, const Signature&, std::vector<Walked>& arguments);

/// Product and the rules by which points, vectors and normals transform; row vectors.
Walked walkedProduct(const Walked& a, const Walked& b);

} // namespace alpenglow::rsl

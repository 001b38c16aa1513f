// Helpers for writing descriptors, and the list of the sections. Host only: nothing here goes into the bitcode.
#pragma once
#include "shadeops/descriptor.h"
#include <initializer_list>
#include <string>
#include <vector>

namespace alpenglow::shadeops {

/// Types of parameters; a length of -1 is an array of any length.
inline constexpr Type kF{Base::Float, 0}, kS{Base::String, 0}, kC{Base::Color, 0}, kP{Base::Point, 0}, kV{Base::Vector, 0},
    kFs{Base::Float, -1}, kCs{Base::Color, -1};

/// A signature as it is written in lists.
struct SignatureText {
    const char* text;        ///< "float noise(point p)"
    const char* symbol = ""; ///< Signature::symbol
};

/// Parses each text.
std::vector<Signature> sigs(std::initializer_list<SignatureText> texts);

/// One signature per type in `types` (separated by spaces): every '$' in the pattern becomes the type's name. Floats take the
/// symbol `symbol` + "_f", tuples `symbol` + "_t"; an empty symbol stays empty.
std::vector<Signature> each(const std::string& types, const std::string& pattern, const std::string& symbol = {});

/// Both lists, a first.
std::vector<Signature> operator+(std::vector<Signature> a, const std::vector<Signature>& b);
std::vector<OptionalParameter> operator+(std::vector<OptionalParameter> a, const std::vector<OptionalParameter>& b);

/// Types for each().
inline constexpr const char* kTuples = "color point vector normal";
inline constexpr const char* kFloatAndTuples = "float color point vector normal";
inline constexpr const char* kAllTypes = "float color point vector normal matrix string";

/// Parameters of the distributions of trace() and bsdf() (3Delight manual, 6.4.5.2).
std::vector<OptionalParameter> distributionParameters();

/// The shadeops of one section; shadeops() joins them.
std::vector<Shadeop> mathematicsShadeops();
std::vector<Shadeop> noiseShadeops();
std::vector<Shadeop> geometryShadeops();
std::vector<Shadeop> matrixShadeops();
std::vector<Shadeop> colourShadeops();
std::vector<Shadeop> splineShadeops();
std::vector<Shadeop> derivativeShadeops();
std::vector<Shadeop> lightingShadeops();
std::vector<Shadeop> bsdfShadeops();
std::vector<Shadeop> messageShadeops();
std::vector<Shadeop> stringShadeops();
std::vector<Shadeop> arrayShadeops();
std::vector<Shadeop> textureShadeops();
std::vector<Shadeop> raytracingShadeops();
std::vector<Shadeop> rayTestShadeops();
std::vector<Shadeop> compatibilityShadeops();
std::vector<Shadeop> facetShadeops();
std::vector<Shadeop> radianceSampleShadeops();

/// What must be there besides the point of `alpenglow eval` (Example::when), where several shadeops need the same.
inline constexpr const char* kOneLight = "one light with Cl = 1 stands straight over N";
inline constexpr const char* kWhite = "all rays meet a surface with Ci = 1";
inline constexpr const char* kNothing = "nothing stands there";

} // namespace alpenglow::shadeops

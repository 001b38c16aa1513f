// One call of a service while a kernel runs: which points ask, what they give, and where their answers go.
#pragma once
#include "wave/engine.h"
#include "world/information.h"
#include <bit>
#include <optional>

namespace alpenglow::transport {

/// What somebody is told: the value of a parameter, of a primitive variable, of an attribute.
struct Told {
    /// Of an element; none: as many numbers or texts as there are, for a variable of that size.
    std::optional<rsl::ir::Kind> kind;
    int elements = 0;                  ///< 0: no array. Not used where the kind is not known
    bool varying = false;              ///< does not fit a uniform variable
    std::vector<float> numbers;
    std::vector<std::string> texts;
    Told() = default;
    explicit Told(const Information&);
    /// Of a type of the shading language, still without a value.
    explicit Told(const rsl::Type& type, int length) : kind(kindOf(type.base)), elements(type.array ? length : 0) {}
    static rsl::ir::Kind kindOf(rsl::Base);
};

/// What lightsource() asks of a light.
struct LightParameter {
    std::optional<Told> told; ///< as the light was given it; nothing: it has none of that name
    struct Part {
        int from, components;
        size_t to;
    };
    std::vector<Part> written; ///< by its kernel: where they lie in BoundLight::values, and in the answer
};

/// Answers that do not depend on the point, so that no name is compared twice. Names are interned. One an engine: no lock.
struct AnswerMemo {
    std::map<std::pair<int32_t, int>, LightParameter> ofLights;                         ///< by name and light
    std::map<std::pair<int32_t, const ShaderInstance*>, std::optional<Told>> ofShaders; ///< toldBy()
    std::map<std::tuple<int32_t, int, const scene::Attributes*, const SurfaceBinding*>, std::optional<Told>> attributes;
    std::unordered_map<int32_t, std::optional<Told>> options;
    std::unordered_map<int32_t, bool> pointAttributes; ///< ofPoint() of a name
};

/// Rows are floats, one a lane. Those of the results begin at zero. A query has 1 or 0, whether the answer came and fits, in row 0; then
/// the answer, component by component, element by element. For an array that can change its length that stands before it.
class ServiceCall {
public:
    ServiceCall(BatchContext&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    template <class Body> void each(Body&& body) const {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane, c.points[size_t(first + lane)]);
    }
    float at(int row, int lane) const { return in[size_t(row) * lanes + lane]; }
    void put(int row, int lane, float v) const { out[size_t(row) * lanes + lane] = v; }
    void putText(int row, int lane, const std::string& s) const { put(row, lane, std::bit_cast<float>(rsl::internString(s))); }
    /// The first string of the call, where each point may have its own.
    std::string name(int lane) const;
    /// The same, interned.
    int32_t nameId(int lane) const;
    SourcePlace place() const;
    /// Answers, where that fits the variable that waits for it.
    void answer(int lane, const Told&) const;
    /// What the point of a lane is bound to; for a light's kernel the surface that it lights. Null where there is no primitive.
    const SurfaceBinding* binding(const WorldImpl&, int lane) const;

    BatchContext& c;
    const SiteInfo& s;
    const rsl::ir::Site& d;
    const int site, first, lanes;
    const uint64_t mask;
    const float* const in;
    float* const out;
};

/// A parameter of a shader as the scene gave it; nothing when it has none of that name.
std::optional<Told> toldBy(const ShaderInstance&, const std::string& parameter);
/// A primitive variable at a point of the shape; nothing when it has none of that name.
std::optional<Told> primitiveVariable(const geometry::Shape&, const geometry::SurfacePoint&, const std::string& name);

// maps.cpp: texture() and environment(); textureinfo().
void answerTexture(Engine&, const ServiceCall&);
void answerTextureInfo(Engine&, const ServiceCall&);
// messages.cpp: surface() and its kin, lightsource(), attribute(), shadername(), getvar() of the primitive.
void answerMessage(Engine&, const ServiceCall&);
void answerLightSource(Engine&, const ServiceCall&);
void answerAttribute(Engine&, const ServiceCall&);
void answerShaderName(Engine&, const ServiceCall&);
void answerPrimitiveVariable(const ServiceCall&);

} // namespace alpenglow::transport

// illuminance: what a loop over lights remembers between its turns, and what is kept for the next loop of the same points.
#pragma once
#include "transport/world.h"
#include <functional>
#include <unordered_map>

namespace alpenglow::transport {

/// What a light may ask about the surface that it lights. Indices are those of the queries of evaluateLight().
struct LitSurface {
    std::function<const SurfaceBinding*(int query)> binding;
    /// Value of an output parameter as it is now; false: ask the instance.
    std::function<bool(int query, const std::string& name, std::vector<float>&)> output;
    /// The run of its displacement shader and the point there; null: ask the instance.
    std::function<const struct BatchContext*(int query, int& point)> displaced;
};

/// One run of a light's kernel: what differs from the light as it is bound.
struct LightCall {
    const shading::ParameterBlock* parameters = nullptr; ///< instead of the instance's: with values that a surface has sent
    const BoundKernel* kernel = nullptr;                 ///< for the strings that it has sent
    const LitSurface* lit = nullptr;
    const std::vector<char>* inMedium = nullptr;         ///< by query: a medium lies before the emitter, and not its atmosphere
    std::vector<float>* values = nullptr;                ///< gets BoundLight::values: valueWidth numbers a query
};

/// State of the loop of one strip. A strip that waits for rays in the middle of its loop keeps it while others run theirs.
struct LightLoop {
    int first = -1;                               ///< the strip's first point; -1: unused
    std::vector<std::pair<int, int>> lights;      ///< (light, sample) by turn
    std::vector<float> rows;                      ///< P, axis, angle: seven rows
    std::string category;
    bool refresh = false;                         ///< "lightcache" "refresh"
    // What the setup before the loop gave; setup < 0: none.
    int setup = -1;                               ///< its call site
    bool fresh = false;                           ///< it belongs to the loop that begins now
    std::vector<float> given;                     ///< its arguments
    std::vector<uint64_t> givenHash;              ///< by lane, over what lights can see of them
    // The turn that runs now.
    int light = -1;
    std::vector<float> values;                    ///< by lane, the light's BoundLight::values

    /// Results of one light sample for the points of the strip.
    struct Kept {
        uint64_t have = 0, lit = 0, ran = 0;      ///< ran: of a light with many samples, where some may be lit
        std::vector<float> key;                   ///< the seven rows
        std::vector<uint64_t> hash;
        std::vector<float> out, values;           ///< L, Cl, Ol: nine rows; values by lane
        std::vector<float> distance;
    };
    std::unordered_map<uint64_t, Kept> kept;      ///< by light and sample

    void reset(int strip) {
        first = strip;
        setup = light = -1;
        fresh = false;
        lights.clear();
        kept.clear();
    }
};

/// The words of a light's __category.
std::string categoriesOf(const BoundLight&);

/// The length of a parameter of the light that is an array of numbers; 0 when there is none.
int elementsOf(const BoundLight&, const std::string& parameter);

/// The strings that a loop sends, as one key of BoundLight::variants: "name\1value\2" of each; "" for none.
std::string sentStrings(const SiteInfo&);

} // namespace alpenglow::transport

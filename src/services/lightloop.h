// illuminance loops: state during iterations, and caches for later loops at the same points.
#pragma once
#include "services/names.h"
#include "world/impl.h"
#include <deque>
#include <functional>
#include <unordered_map>

namespace alpenglow::services {

/// Queries of a light to the surface that it lights. Indices are those of the queries of evaluateLight().
struct LitSurface {
    /// The binding of the lit surface; null: none.
    std::function<const SurfaceBinding*(int query)> binding;
    /// Current value of an output parameter; returns false to use the instance's.
    std::function<bool(int query, const std::string& name, std::vector<float>&)> output;
    /// The run of its displacement shader and the index of the point; null: use the instance.
    std::function<const struct KernelRun*(int query, int& point)> displaced;
};

/// A run of a light's kernel: differences from the bound light.
struct LightCall {
    const shading::ParameterBlock* parameters = nullptr; ///< replaces the instance's: with values sent by a surface
    const BoundKernel* kernel = nullptr;                 ///< for sent strings; for a LightGroup, its own
    std::span<const BoundLight* const> of; ///< by query: lights of one LightGroup, sorted; empty: all queries are to one light
    const LitSurface* lit = nullptr;       ///< the lit points; null: unknown
    const std::vector<char>* inMedium = nullptr; ///< by query: a medium, not its atmosphere, is before the emitter
    std::vector<float>* values = nullptr;        ///< receives BoundLight::values: valueWidth numbers for each query
    std::span<const int> more;                   ///< further outputs of `kernel`,
    std::vector<float>* moreValues = nullptr;    ///< their values, by query
};

/// Distance of shadow rays to a light sample, and radius of the disk that they end on; 0: a point.
struct ShadowReach {
    float distance = 1e38f, radius = 0; ///< camera space
};

/// Results of the setup before a loop.
struct LightSetup {
    int setup = -1;                  ///< its call site; -1: none
    std::vector<float> given;        ///< its arguments
    std::vector<uint64_t> givenHash; ///< by lane: hash of those visible to lights
};

/// A running loop and its current iteration.
struct LightIterations : LightSetup {
    std::vector<std::pair<int, int>> lights; ///< (light, sample) by iteration
    std::vector<float> rows;                 ///< P, axis, angle: seven rows
    bool refresh = false;                    ///< "lightcache" "refresh"
    // The current iteration.
    int light = -1;                 ///< -1: no loop runs
    std::vector<float> values;      ///< by lane, the light's BoundLight::values
    std::vector<ShadowReach> reach; ///< by lane: KernelRun::lightReach
};

/// State of the loops of one strip: of the innermost running one. A strip that waits for rays within a loop keeps it while others
/// run theirs.
struct LightLoop : LightIterations {
    int first = -1;                     ///< first point of the strip; -1: unused
    int depth = 0;                      ///< number of nested running loops
    std::deque<LightIterations> around; ///< outer loops, outermost first; entries beyond are spare memory
    LightSetup next;                    ///< of the loop that starts next

    /// Results of one light sample for the points of the strip.
    struct Kept {
        uint64_t have = 0, lit = 0, ran = 0; ///< ran: for a light with many samples, evaluated even where not lit
        std::vector<float> key;              ///< the seven rows
        std::vector<uint64_t> hash;          ///< of the key, by lane
        std::vector<float> out, values;      ///< L, Cl, Ol: nine rows; values by lane
        std::vector<ShadowReach> reach;      ///< by lane
    };
    std::unordered_map<uint64_t, Kept> kept; ///< by keptName()

    /// Forgets everything, for a strip that begins at this point of the batch.
    void reset(int strip) {
        first = strip;
        setup = light = next.setup = -1;
        depth = 0;
        lights.clear();
        kept.clear();
    }
};

/// A light sample for all points of a batch: for loops at the surface's P that send no values.
struct LightSheet {
    bool made = false, refused = false; ///< refused: too few points ask for it, so each strip samples for itself
    int size = 0;                       ///< points
    std::vector<float> out;             ///< L, Cl, Ol: nine rows of `size`
    std::vector<ShadowReach> reach;     ///< by point: KernelRun::lightReach
    std::vector<float> values;          ///< by point: BoundLight::values
    std::vector<char> lit;              ///< by point
};

/// Whether each nesting depth of loops has light samples of its own, so that products of outer and inner loops have the right
/// mean.
bool sampledAnew(const BoundLight&, bool path);
/// Occurrence of the random numbers for an iteration.
uint32_t drawOf(const LightLoop&);
/// Cache key of an iteration of a light.
uint64_t keptName(const LightLoop&, const BoundLight&, int light, int turn, bool path);

/// Whether a light may be evaluated for points that do not request it: it has no side effects.
bool hasSheets(const BoundLight&);

/// The words of a light's __category.
std::string categoriesOf(const BoundLight&);

/// Length of an array parameter of the light with numbers; 0 if there is none.
int elementsOf(const BoundLight&, const std::string& parameter);

/// Random numbers for the direction of a solar() with an angle: distance from its axis (0: along it), and azimuth.
Color coneNumbers(Vec2 random);

} // namespace alpenglow::services

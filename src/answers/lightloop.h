// illuminance: what a loop over lights remembers between its turns, and what is kept for the next loop of the same points.
#pragma once
#include "world/impl.h"
#include <deque>
#include <functional>
#include <unordered_map>

namespace alpenglow::transport {

/// What a light may ask about the surface that it lights. Indices are those of the queries of evaluateLight().
struct LitSurface {
    std::function<const SurfaceBinding*(int query)> binding;
    /// Value of an output parameter as it is now; false: ask the instance.
    std::function<bool(int query, const std::string& name, std::vector<float>&)> output;
    /// The run of its displacement shader and the point there; null: ask the instance.
    std::function<const struct KernelRun*(int query, int& point)> displaced;
};

/// One run of a light's kernel: what differs from the light as it is bound.
struct LightCall {
    const shading::ParameterBlock* parameters = nullptr; ///< instead of the instance's: with values that a surface has sent
    const BoundKernel* kernel = nullptr;                 ///< for the strings that it has sent; of a LightGroup, its own
    std::span<const BoundLight* const> of; ///< by query, lights of one LightGroup, equal ones side by side; empty: all are of one
    const LitSurface* lit = nullptr;
    const std::vector<char>* inMedium = nullptr; ///< by query: a medium lies before the emitter, and not its atmosphere
    std::vector<float>* values = nullptr;        ///< gets BoundLight::values: valueWidth numbers a query
    std::span<const int> more;                   ///< further outputs of `kernel`,
    std::vector<float>* moreValues = nullptr;    ///< and their numbers, query by query
};

/// How far shadow rays go to a light sample, and the radius of the disk there that they go to; 0: to a point.
struct ShadowReach {
    float distance = 1e38f, radius = 0;
};

/// What the setup before a loop gave.
struct LightSetup {
    int setup = -1;                  ///< its call site; -1: none
    std::vector<float> given;        ///< its arguments
    std::vector<uint64_t> givenHash; ///< by lane, over what lights can see of them
};

/// One loop that runs, and its turn.
struct LightTurns : LightSetup {
    std::vector<std::pair<int, int>> lights; ///< (light, sample) by turn
    std::vector<float> rows;                 ///< P, axis, angle: seven rows
    bool refresh = false;                    ///< "lightcache" "refresh"
    // The turn that runs now.
    int light = -1;                 ///< -1: no loop runs
    std::vector<float> values;      ///< by lane, the light's BoundLight::values
    std::vector<ShadowReach> reach; ///< by lane: KernelRun::lightReach
};

/// State of the loops of one strip: of the innermost that runs. A strip that waits for rays in the middle of its loop keeps it
/// while others run theirs.
struct LightLoop : LightTurns {
    int first = -1;                ///< the strip's first point; -1: unused
    int depth = 0;                 ///< how many loops run, one in the block of the other
    std::deque<LightTurns> around; ///< of those the outer ones, outermost first; behind them is memory for others
    LightSetup next;               ///< of the loop that begins next

    /// Results of one light sample for the points of the strip.
    struct Kept {
        uint64_t have = 0, lit = 0, ran = 0; ///< ran: of a light with many samples, where some may be lit
        std::vector<float> key;              ///< the seven rows
        std::vector<uint64_t> hash;
        std::vector<float> out, values; ///< L, Cl, Ol: nine rows; values by lane
        std::vector<ShadowReach> reach;
    };
    std::unordered_map<uint64_t, Kept> kept; ///< by keptName()

    void reset(int strip) {
        first = strip;
        setup = light = next.setup = -1;
        depth = 0;
        lights.clear();
        kept.clear();
    }
};

/// One sample of a light for all points of a batch: what loops find whose P is that of the surface, and that send nothing.
struct LightSheet {
    bool made = false, refused = false;
    int size = 0;                   ///< points
    std::vector<float> out;         ///< L, Cl, Ol: nine rows of `size`
    std::vector<ShadowReach> reach; ///< by point: KernelRun::lightReach
    std::vector<float> values;      ///< by point: BoundLight::values
    std::vector<char> lit;          ///< by point
};

/// Lights that are sampled give every depth of loops samples of its own: the product of an outer and of an inner loop has the
/// mean that it should have.
bool sampledAnew(const BoundLight&, bool path);
/// The occurrence of random numbers for a turn of a light.
uint32_t drawOf(const LightLoop&);
/// The name of what is kept of a turn of a light.
uint64_t keptName(const LightLoop&, const BoundLight&, int light, int turn, bool path);

/// Whether its samples may be taken for points that do not ask: nothing comes of it but light.
bool hasSheets(const BoundLight&);

/// The words of a light's __category.
std::string categoriesOf(const BoundLight&);

/// The length of a parameter of the light that is an array of numbers; 0 when there is none.
int elementsOf(const BoundLight&, const std::string& parameter);

/// The numbers that a solar() with an angle makes a direction of: how far from its axis (0: along it), and the turn about it.
Color coneNumbers(Vec2 random);

} // namespace alpenglow::transport

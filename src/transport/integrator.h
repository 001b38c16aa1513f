// The light transport engine: one frame made ready (World), and what arrives along camera rays (Integrator). Under "hidden" and
// "raytrace" shaders mean what they meant; under "path" their lobes are estimated with all light (design decisions 1 to 4).
#pragma once
#include "base/diagnostics.h"
#include "base/file.h"
#include "base/readlog.h"
#include "base/stopflag.h"
#include "scene/scene.h"
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::transport {

/// Attribute of a primitive that fades between levels of detail: two numbers. Only samples see it whose own number, from 0 to 1, is at
/// least the first and below the second.
inline constexpr const char* kLevelAttribute = "detail:__level";

enum class Hider { Hidden, Raytrace, Path };

struct Settings {
    Hider hider = Hider::Hidden;
    uint64_t seed = 0;
    int lanes = 16;                 ///< 4, 8, 16
    int maxDepth = -1;              ///< bounces; -1: Option "trace" "maxdepth", else 32 under path and 4 otherwise
    float sampleClamp = 0;          ///< 0 = off (pathtracer.md 6)
    bool direct = true, indirect = true; ///< --no-direct, --no-indirect: the latter stops diffuse continuation only
    bool unbiased = false;          ///< no scaling of indirect weights above 1
    bool localRoulette = false;     ///< the seed's rule (--preset slproject) instead of throughput
    bool roulette = true;
    bool suspend = false;           ///< force suspending kernels where affine ones exist (tests)
    bool mixedOnly = false;         ///< build V everywhere (tests: it has the same bits as S)
    bool bsdfOnly = false;          ///< no light sampling, emission counts in full (tests, T6)
    bool lightOnly = false;         ///< light sampling only: emission met by lobe sampling does not count (tests, T6)
    std::vector<std::string> shaderPaths, texturePaths;
    ReadPolicy read{};              ///< where the names of maps may lead
    std::shared_ptr<ReadLog> reads; ///< gets every shader and map that is read or missed; may be null
    bool allowExec = false;         ///< shaders may load plug-ins
    std::vector<std::string> pluginPaths; ///< where those are looked for
    std::string dialect;            ///< whose macros the shaders see: rsl::FrontOptions::dialect
    std::string cacheDirectory;     ///< "" = default
    std::vector<std::string> outputs; ///< AOVs: names of output shader parameters ("list[1]": an element) or predefined variables, in order
    const StopFlag* stop = nullptr; ///< polled while the world is made (dicing, displacement); set: build() gives up. May be null
    std::vector<int> outputWidths; ///< floats of each where a display declares it; 0 or missing: the shaders decide
};

/// Counts of one integrator thread; added up by the renderer.
struct Counters {
    uint64_t camera = 0, diffuse = 0, specular = 0, transmission = 0, shadow = 0;
    uint64_t points = 0, batches = 0, lanesUsed = 0, lanesRun = 0;
    uint64_t nonFinite = 0, overLimit = 0, depthCap = 0;
    uint64_t depthSum = 0, paths = 0;
    int depthMax = 0;
    size_t peakFrameBytes = 0; ///< suspended kernel frames at one time, the largest of all threads
    void operator+=(const Counters&);
};

/// A frame ready to be traced: shapes diced, accelerated, shaders compiled, lights bound. Immutable and shared by threads.
class World {
public:
    /// Null when nothing can be rendered (an error was reported); missing shaders fall back with an error.
    static std::shared_ptr<const World> build(std::shared_ptr<const scene::Frame>, const Settings&, Diagnostics&);
    virtual ~World() = default;
    virtual const scene::Frame& frame() const = 0;
    virtual const Settings& settings() const = 0;
    struct Facts {
        double buildSec = 0, compileSec = 0;
        int kernels = 0, affine = 0, suspending = 0, cacheHits = 0;
        size_t shapes = 0, before = 0; ///< before: those that are not wholly behind the camera
    };
    virtual Facts facts() const = 0;
    /// Floats per AOV in Settings::outputs: what the shaders that give it have, arrays with all their elements.
    virtual std::vector<int> outputWidths() const = 0;
    /// Those of Settings::outputs that no shader of the frame gives and that are no predefined variable: they are 0 everywhere.
    /// None where the frame has no primitives.
    virtual std::vector<std::string> missingOutputs() const { return {}; }
    /// What could be named instead: predefined variables and the outputs of the frame's shaders.
    virtual std::vector<std::string> knownOutputs() const { return {}; }
    /// Writes what shaders have printed since the last call, in the order of the samples; or forgets it. Between passes.
    virtual void flushPrints(bool keep) const = 0;
    /// Runs the frame's imager over finished pixels, in place. rgb: linear colour, alpha: coverage, P: raster position. True when there is one.
    /// Once *stop is set its loops end early, and the pixels are void; null: never.
    virtual bool runImager(int count, const float* rasterX, const float* rasterY, float* r, float* g, float* b, float* alpha,
                           Diagnostics&, const StopFlag* stop = nullptr) const = 0;
};

/// One camera ray: a position on the raster and its sample number. Camera space.
struct CameraRay {
    Vec3 origin, direction;      ///< direction unit
    float width = 0, spread = 0; ///< half width of a pixel's footprint at the origin, and its growth per unit of distance
    float time = 0;
    float cosine = 1;            ///< direction.z: depth = distance * cosine
    float start = 0;             ///< the way from the eye to the origin, where that is the near plane
    int px = 0, py = 0;          ///< pixel, and
    uint32_t sample = 0;         ///< sample number: the key of all random numbers
};

struct SampleResult {
    Color color{0}, opacity{0};  ///< premultiplied; color includes light seen through
    float z = 1e38f, zSecond = 1e38f; ///< camera depth of the first and second surface; 1e38 = none
    std::vector<float> aovs;     ///< flattened in the order of Settings::outputs
};

class Integrator {
public:
    explicit Integrator(std::shared_ptr<const World>, Diagnostics&);
    ~Integrator();
    /// Follows all rays to the end. Results do not depend on which rays share a call. False when `stop` was set meanwhile: then the
    /// results are void. One Integrator per thread.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    const Counters& counters() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace alpenglow::transport

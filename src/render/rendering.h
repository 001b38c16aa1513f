// The two loops that turn camera rays into pixels, and their shared parts. Internal to render/.
#pragma once
#include "base/numberlanes.h"
#include "integrator/integrator.h"
#include "render/camera.h"
#include "render/engine.h"
#include "render/filtersampler.h"
#include "render/outputs.h"
#include "render/pixelnet.h"
#include "render/progress.h"
#include "render/settings.h"
#include "render/team.h"
#include "world/photonmaps.h"
#include <array>
#include <atomic>
#include <functional>
#include <optional>

namespace alpenglow::render {

/// Dimensions of a camera sample, beyond all call sites and uses of the integrator (services/random.h).
enum CameraUse : uint32_t { kUseFilter = 1u << 24, kUseLens, kUseTime, kUseNet };

/// Side in pixels of the tiles that threads take.
inline constexpr int kTile = 16;
/// Memory in bytes for samples of an incomplete pass, and for unfiltered image samples if bands share none.
inline constexpr size_t kPassBytes = size_t(256) << 20;
/// Memory in bytes for unfiltered image samples of a thread if bands share them: fits into the cache.
inline constexpr size_t kBandBytes = size_t(2) << 20;

/// A frame during rendering.
struct Job {
    /// Given to the constructor; they outlive the job.
    const RenderSettings& settings;
    const Camera& camera;
    const OutputPlan& plan;
    Engine& engine;
    std::shared_ptr<const world::World> world;
    Team team;
    Progress& progress;
    Diagnostics& diagnostics;
    std::string what;                             ///< name of the picture, for the progress line
    double startSeconds = 0;                      ///< clock() at the start of rendering
    StopFlag halt{0};                             ///< polled by tracers
    bool interrupted = false;                     ///< the user, or an error, has stopped rendering
    bool aborted = false;                         ///< an error has
    std::optional<int> errorsAllowed;             ///< ErrorHandler "abort": errors of the run beyond which rendering stops
    std::exception_ptr outOfMemory;               ///< set if the samples of a pass did not fit; complete passes remain
    std::vector<std::unique_ptr<Tracer>> tracers; ///< by worker
    std::vector<uint64_t> rays;                   ///< by worker, at the last report
    std::atomic<uint64_t> rayTotal{0};            ///< at the last report, of all workers
    integrator::LightGuideFigures lightGuide;     ///< of path
    world::GuideFigures guide;                    ///< of path
    std::atomic<bool> met{false}, shone{false};   ///< some camera ray hit a surface; carried light

    /// threads: 0 all cores.
    Job(const RenderSettings&, const Camera&, const OutputPlan&, Engine&, std::shared_ptr<const world::World>, int threads,
        Progress&, Diagnostics&);
    /// Builds the world with procedurals that rays reached (world/procedurals.h), by number; returns null if the user stops, or
    /// after an error (reported). Unset: no deferred procedurals.
    std::function<std::shared_ptr<const world::World>(std::span<const int>, int most)> make;
    /// Runs tasks 0 to count - 1 like Team::run(). Tasks whose rays reached deferred procedurals are repeated after expansion, so
    /// the results of a task must be those of its last run.
    bool run(size_t count, const std::function<void(int, size_t)>& work, const std::function<void(size_t)>& tick);
    /// The same, with a progress line that ends in `part`, for passes beside that of the picture. Returns false if stopped.
    bool runShown(size_t count, const char* part, const std::function<void(int, size_t)>& work);
    /// Whether rays of the worker's current task reached such procedurals; its results are then undefined.
    bool unfinished(int worker) const { return unfinished_[size_t(worker)] != 0; }
    /// Expands the procedurals that rays reached, between tasks. Returns false if stopped.
    bool makeMet();
    /// Traces on a worker and counts its rays. Returns false if stopped; the results are then undefined.
    bool trace(int worker, std::span<const integrator::CameraRay>, std::span<integrator::SampleResult>);
    /// Forwards the user's stop, or that of an error, to the tracers; returns true if there was one.
    bool pollStop();
    /// Sums over the tracers, and over earlier worlds; seconds since the start.
    integrator::Counters counters() const;
    double elapsed() const;

private:
    void begin();
    std::vector<uint8_t> unfinished_; ///< by worker
    integrator::Counters earlier_;    ///< of replaced tracers
    int rounds_ = 0;                  ///< expansion rounds
};

/// Seconds of a monotonic clock.
double clockSeconds();
/// Rays of all kinds.
uint64_t totalRays(const integrator::Counters&);
/// The tiles of a window, in reading order.
std::vector<Window> tilesOf(const Window&, int side = kTile);

/// The camera ray of a sample of `path`, at a position sampled from the filter. *weight is FilmSample::weight.
integrator::CameraRay pathRay(const Camera&, const FilterSampler&, uint64_t seed, int x, int y, uint32_t sample, float* weight);
/// The same for many samples at a time.
struct PixelSample {
    int x, y;        ///< pixel
    uint32_t sample; ///< index in the pixel
};
/// Weights: FilmSample::weight, by sample.
void pathRays(const Camera&, const FilterSampler&, uint64_t seed, std::span<const PixelSample>, NumberRows&,
              std::vector<integrator::CameraRay>& rays, std::vector<float>& weights);
/// Adds samples to the film in complete passes until the range is done, the requested noise or time is reached, or the user
/// stops. `wanted`: sample indices of every pixel. Returns false if not a single pass was completed.
bool renderPath(Job&, Film&, SampleRange wanted, uint64_t seed, const std::function<void(Film&)>& afterPass);

/// Makes the irradiance records of the world (World::interpolates()). Call before anything else is traced. Returns false if
/// stopped.
bool findRecords(Job&);

/// The nx x ny samples of a pixel under hidden and raytrace.
void gridOf(const scene::Options&, const RenderSettings&, int* nx, int* ny);
/// From the hider's parameter "jitter" and the samples per pixel.
Jitter jitterOf(const scene::Options&, Diagnostics&);
/// Where `hidden`, or else raytrace, shades, by the hider's parameter "shading" or Option "hidden" "shading": "micropolygon" or
/// "sample". Reports invalid values, and raytrace with a lens or an open shutter, which cannot shade micropolygons.
bool shadesMicropolygons(const scene::Options&, bool hidden, const Camera&, Diagnostics&);
/// Adaptive antialiasing by colour difference, of the hider raytrace: one ray through the centre of each pixel; if two horizontal
/// or vertical neighbours differ, both get side x side rays in a uniform grid. A pixel is the mean of its own rays.
struct Refinement {
    int side = 1;           ///< 3, 5, 7 or 9; 1: none
    float threshold = 0.3f; ///< threshold for the sum of the differences of red, green and blue, each clamped to 0 .. 1
    /// There is a second round.
    bool on() const { return side > 1; }
};
/// The hider's parameters aaSamples and aaThreshold; none if a lens or motion needs more rays, which is reported.
Refinement refinementOf(const scene::Options&, const Camera&, Diagnostics&);
/// Number of refined pixels, and of their rays.
struct Refined {
    uint64_t pixels = 0, rays = 0;
};
/// The camera rays of image samples, many at a time.
class ImageRays {
public:
    /// nx, ny: samples of a pixel.
    ImageRays(const Camera&, uint64_t seed, int nx, int ny, Jitter);
    /// Drops requests; memory stays.
    void clear();
    /// Requests sample k, 0 <= k < nx ny, of a pixel.
    void ask(int x, int y, int k);
    /// Makes the rays requested since clear(): places()[i] in its pixel and rays()[i] belong to the i-th request.
    void make();
    /// The results of make().
    std::span<const Vec2> places() const { return places_.places(); }
    std::vector<integrator::CameraRay>& rays() { return rays_; }

private:
    void makePlain();
    const Camera* camera_;
    SeedKey seed_;
    PixelNet net_;
    PlaceRows places_;
    struct Asked {
        int x, y, k;
    };
    std::vector<Asked> asked_;
    std::vector<Vec2> raster_;
    std::vector<integrator::CameraRay> rays_;
};
/// Samples with values that are not finite: their number, and sample, y and x of the first.
struct DroppedSamples {
    uint64_t count = 0;                      ///< number of samples
    std::optional<std::array<int, 3>> first; ///< sample, y, x
};
/// Reconstructed pictures: plan.pictures[i] has images[of[i]].
struct Reconstructions {
    std::vector<Image> images;
    std::vector<size_t> of;
    Refined refined;   ///< of hider raytrace
    bool begun = true; ///< false: the user stopped before any part was complete
};
/// If the user stops, unreached pixels stay black. `memory`: of the samples, reused from frame to frame if small, because new
/// pages cost a tenth of the time of simple frames.
Reconstructions renderImages(Job&, int nx, int ny, Jitter, const Refinement&, uint64_t seed, DroppedSamples*,
                             std::vector<float>& memory);

} // namespace alpenglow::render

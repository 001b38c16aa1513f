// The two loops that turn camera rays into pixels, and what they share. Inside render/.
#pragma once
#include "base/numberlanes.h"
#include "integrator/photons.h"
#include "render/camera.h"
#include "render/engine.h"
#include "render/filtersampler.h"
#include "render/outputs.h"
#include "render/pixelnet.h"
#include "render/progress.h"
#include "render/settings.h"
#include "render/team.h"
#include <array>
#include <atomic>
#include <functional>
#include <optional>

namespace alpenglow::render {

/// Dimensions of a camera sample, above all call sites and uses of transport/ (answers/random.h).
enum CameraUse : uint32_t { kUseFilter = 1u << 24, kUseLens, kUseTime, kUseNet };

/// Pixels a side of the squares that threads take.
inline constexpr int kTile = 16;
/// Bytes of samples that are held back until their pass is whole, and of image samples that wait for their filter where bands
/// share none.
inline constexpr size_t kPassBytes = size_t(256) << 20;
/// Bytes of image samples that wait for their filter, a thread, where bands share those between them: what caches hold.
inline constexpr size_t kBandBytes = size_t(2) << 20;

/// One frame while it is rendered.
struct Job {
    const RenderSettings& settings;
    const Camera& camera;
    const OutputPlan& plan;
    Engine& engine;
    std::shared_ptr<const transport::World> world;
    Team team;
    Progress& progress;
    Diagnostics& diagnostics;
    std::string what;                             ///< the picture's name, for the progress line
    double startSeconds = 0;                      ///< clock() when rendering began
    StopFlag halt{0};                             ///< what tracers poll
    bool interrupted = false;                     ///< the user's stop was seen
    std::exception_ptr outOfMemory;               ///< why the samples of a pass did not fit; what is whole stays
    std::vector<std::unique_ptr<Tracer>> tracers; ///< by worker
    std::vector<uint64_t> rays;                   ///< by worker, as last told
    std::atomic<uint64_t> rayTotal{0};
    transport::GuideFigures guide;              ///< of path
    std::atomic<bool> met{false}, shone{false}; ///< some camera ray met a surface; brought light

    Job(const RenderSettings&, const Camera&, const OutputPlan&, Engine&, std::shared_ptr<const transport::World>, int threads,
        Progress&, Diagnostics&);
    /// The world with procedurals that rays came to (integrator/unmade.h), by number; null: there is none, because the user
    /// wants to end or because it was reported. Unset: there are no such procedurals.
    std::function<std::shared_ptr<const transport::World>(std::span<const int>)> make;
    /// Does tasks 0 to count - 1 as Team::run() does. Those whose rays came to procedurals that are not made yet are done
    /// again once they are: what a task leaves behind must be that of its last time.
    bool run(size_t count, const std::function<void(int, size_t)>& work, const std::function<void(size_t)>& tick);
    /// Whether rays of the task that a worker does came to such procedurals: its results are void.
    bool unfinished(int worker) const { return unfinished_[size_t(worker)] != 0; }
    /// Makes what rays came to, between tasks. False: halted.
    bool makeMet();
    /// Traces on a worker and counts its rays. False: halted, the results are void.
    bool trace(int worker, std::span<const transport::CameraRay>, std::span<transport::SampleResult>);
    /// Hands the user's stop on to the tracers; true when the user wants to end.
    bool pollStop();
    transport::Counters counters() const;
    double elapsed() const;

private:
    void begin();
    std::vector<uint8_t> unfinished_; ///< by worker
    transport::Counters earlier_;     ///< of tracers that are gone
    int rounds_ = 0;                  ///< that procedurals were made in
};

/// Seconds of a clock that never goes backwards.
double clockSeconds();
uint64_t totalRays(const transport::Counters&);
/// The tiles of a window, in reading order.
std::vector<Window> tilesOf(const Window&, int side = kTile);

/// The camera ray of a sample of `path`: its place is drawn from the filter. *weight is FilmSample::weight.
transport::CameraRay pathRay(const Camera&, const FilterSampler&, uint64_t seed, int x, int y, uint32_t sample, float* weight);
/// The same for many samples at a time.
struct PixelSample {
    int x, y;
    uint32_t sample;
};
void pathRays(const Camera&, const FilterSampler&, uint64_t seed, std::span<const PixelSample>, NumberRows&,
              std::vector<transport::CameraRay>& rays, std::vector<float>& weights);
/// Adds samples to the film in whole passes until the range is done, the noise or time asked for is reached, or the user stops.
/// spp: samples `first` .. `first + spp` of every pixel; fewer may be added. Returns false when not one whole pass could be
/// added.
bool renderPath(Job&, Film&, SampleRange wanted, uint64_t seed, const std::function<void(Film&)>& afterPass);

/// Lets the world find what it interpolates between (World::interpolates()). Before anything else is traced. False: halted.
bool findRecords(Job&);

/// The samples nx x ny of a pixel under hidden and raytrace.
void gridOf(const scene::Options&, const RenderSettings&, int* nx, int* ny);
Jitter jitterOf(const scene::Options&, Diagnostics&);
/// Where `hidden`, or else raytrace, shades, as the hider's parameter "shading" or Option "hidden" "shading" says: "micropolygon"
/// or "sample". What is no answer is reported, as is raytrace with a lens or an open shutter, which cannot do the former.
bool shadesMicropolygons(const scene::Options&, bool hidden, const Camera&, Diagnostics&);
/// Anti-aliasing by difference of colours, of the hider raytrace: a ray through the middle of each pixel; where two pixels
/// side by side or one above the other differ, both get side x side of them, evenly spaced. A pixel is the mean of its own
/// rays.
struct Refinement {
    int side = 1;           ///< 3, 5, 7 or 9; 1: none
    float threshold = 0.3f; ///< sum of the differences of red, green and blue, each cut to 0 .. 1, above which pixels differ
    bool on() const { return side > 1; }
};
/// What the hider's parameters aaSamples and aaThreshold say; none where a lens or motion needs more rays, which is reported.
Refinement refinementOf(const scene::Options&, const Camera&, Diagnostics&);
/// How many pixels were refined, and the rays for it.
struct Refined {
    uint64_t pixels = 0, rays = 0;
};
/// The camera rays of image samples, many at a time.
class ImageRays {
public:
    ImageRays(const Camera&, uint64_t seed, int nx, int ny, Jitter);
    void clear();
    void ask(int x, int y, int k);
    /// Makes what was asked for since clear(): places()[i] in its pixel and rays()[i] belong to the i-th.
    void make();
    std::span<const Vec2> places() const { return places_.places(); }
    std::vector<transport::CameraRay>& rays() { return rays_; }

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
    std::vector<transport::CameraRay> rays_;
};
/// Samples that are not finite numbers: how many, and sample, y and x of the first in the picture.
struct DroppedSamples {
    uint64_t count = 0;
    std::optional<std::array<int, 3>> first;
};
/// Reconstructed pictures: that of plan.pictures[i] is images[of[i]].
struct Reconstructions {
    std::vector<Image> images;
    std::vector<size_t> of;
    Refined refined;
};
/// When the user stops, pixels not reached stay black. `memory`: of the samples, kept from frame to frame where it is little:
/// pages that the system hands out anew are a tenth of the time of simple frames.
Reconstructions renderImages(Job&, int nx, int ny, Jitter, const Refinement&, uint64_t seed, DroppedSamples*,
                             std::vector<float>& memory);

} // namespace alpenglow::render

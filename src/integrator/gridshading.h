// Camera samples of the hidden hider: rays find what is seen, and micropolygons, shaded once for all samples that see them, say
// how it looks. Colours, opacities and outputs are composited sample by sample, front to back; depths are the samples' own.
#pragma once
#include "integrator/micropolygons.h"
#include "integrator/samples.h"

namespace alpenglow::transport {

class Pipeline;

class GridShading {
public:
    /// The pipeline shades, and counts. It must outlive this.
    explicit GridShading(Pipeline&);
    /// Whether samples of this world take micropolygons: with Settings::micropolygons, under hidden and raytrace, unless
    /// something asks for what samples have of their own: their time (under raytrace an open shutter), or a volume about the eye.
    static bool takes(const WorldImpl&);
    /// Whether samples that meet nothing bring nothing.
    bool emptyIsBlack() const { return !seesSky_ && !world_.unmade_; }
    /// Integrator::trace() of camera samples of the picture. The same bits whatever was shaded before.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// The same for CameraRay::depthOnly.
    bool depths(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);

private:
    struct Sample {
        uint32_t number = 0;       ///< of the call
        uint32_t first = 0, n = 0; ///< its shares: shares_
        Vec3 origin;               ///< from where it goes on
        Color weight{1};           ///< of what it meets next
        int layers = 0;            ///< that it went through
    };
    struct Share {
        uint32_t slot;
        float weight;
    };
    bool follow(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    bool followSampleBySample(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    void begin(std::span<const CameraRay>, std::span<SampleResult>);
    void meet(std::span<const CameraRay>);
    void findShares();
    uint32_t slotOf(const MicropolygonShare&);
    bool shade(const StopFlag*);
    void keep(uint32_t slot, const SampleResult&);
    void show(std::span<const CameraRay>, std::span<SampleResult>);
    bool ownWay(const Sample&, const accel::Hit&) const;
    bool goesOn(Sample&, const CameraRay&, const accel::Hit&, const Color& clear) const;
    void aimAt(std::span<const MicropolygonShare>);
    CameraRay rayTo(const MicropolygonShare&, const geometry::SurfacePoint&, shading::GridPoint&);
    float* values(uint32_t slot) { return values_.data() + size_t(slot) * stride_; }
    void grow();
    void forget();

    Pipeline& pipeline_;
    const WorldImpl& world_;
    Micropolygons lattices_;
    MicropolygonCamera camera_;
    bool seesSky_;                ///< some sky is seen behind everything
    bool unfinished_ = false;     ///< Pipeline::unfinished(), of the call
    size_t stride_;               ///< floats of a slot: colour, opacity, what comes through, outputs
    std::vector<uint8_t> colour_; ///< by number of an output: the channel that weighs it; 3: the luminance
    // What has been shaded, by slot; the table finds slots by key (open addressing, a power of two).
    std::vector<MicropolygonKey> keys_;
    std::vector<float> values_;
    struct Entry {
        uint32_t slot, tag; ///< tag: upper half of the hash
    };
    std::vector<Entry> table_;
    uint32_t last_ = 0; ///< slot that was found last
    // Of the call under way.
    std::vector<Sample> samples_;
    std::vector<accel::Ray> rays_;
    std::vector<accel::Hit> hits_;
    std::vector<Vec3> points_;
    std::vector<Micropolygons::Found> found_;
    std::vector<Share> shares_;
    std::vector<MicropolygonShare> fresh_; ///< to be shaded
    uint32_t firstFresh_ = 0;              ///< slot of the first
    std::vector<uint32_t> own_;            ///< samples, by number, that are shaded where they lie
    struct {
        std::vector<geometry::SurfacePoint> places;
        std::vector<geometry::HitRef> hits;
        std::vector<shading::GridPoint> points;
        std::vector<CameraRay> rays;
        std::vector<SampleResult> results;
    } work_; ///< of micropolygons that are shaded
};

} // namespace alpenglow::transport

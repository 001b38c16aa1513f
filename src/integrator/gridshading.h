// Camera samples of the hidden hider: rays determine visibility, and the appearance comes from micropolygons, which are shaded
// once for all samples that see them. Colours, opacities and outputs are composited sample by sample, front to back; depths are
// those of the samples.
#pragma once
#include "integrator/micropolygons.h"
#include "integrator/samples.h"

namespace alpenglow::integrator {

class Pipeline;

/// Traces camera samples by micropolygons. One for each thread.
class GridShading {
public:
    /// The pipeline shades and counts. It must outlive this object.
    explicit GridShading(Pipeline&);
    /// Whether samples of this world use micropolygons: with Settings::micropolygons, under hidden and raytrace, unless samples
    /// need values of their own: their time (an open shutter under raytrace) or a volume around the eye.
    static bool takes(const WorldImpl&);
    /// Whether samples without a hit are black and empty.
    bool emptyIsBlack() const { return !seesSky_ && !world_.deferred(); }
    /// Integrator::trace() for camera samples of the picture. The bits do not depend on what was shaded before.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// The same for CameraRay::depthOnly.
    bool depths(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);

private:
    struct Sample {
        uint32_t number = 0;       ///< index in the call
        uint32_t first = 0, n = 0; ///< its shares, in shares_
        Vec3 origin;               ///< where it continues behind the last hit
        Color weight{1};           ///< weight of its next hit
        int layers = 0;            ///< surfaces that it has passed
    };
    struct Share {
        uint32_t slot;
        float weight;
    };
    bool follow(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    bool followSampleBySample(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    void begin(std::span<const CameraRay>, std::span<SampleResult>);
    void intersect(std::span<const CameraRay>);
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
    bool seesSky_;                ///< a sky is visible behind all geometry
    bool unfinished_ = false;     ///< Pipeline::unfinished(), of the call
    size_t stride_;               ///< floats in a slot: colour, opacity, transparency, outputs
    std::vector<uint8_t> colour_; ///< by output: the channel whose transparency weights it; 3: luminance
    // Shaded micropolygons, by slot. The table maps keys to slots (open addressing, size a power of two).
    std::vector<MicropolygonKey> keys_;
    std::vector<float> values_;
    struct Entry {
        uint32_t slot, tag; ///< tag: upper half of the hash
    };
    std::vector<Entry> table_;
    uint32_t last_ = 0; ///< slot of the last lookup
    // State of the current call.
    std::vector<Sample> samples_;
    std::vector<accel::Ray> rays_;
    std::vector<accel::Hit> hits_;
    std::vector<Vec3> points_;
    std::vector<Micropolygons::Found> found_;
    std::vector<Share> shares_;
    std::vector<MicropolygonShare> fresh_; ///< to be shaded
    uint32_t firstFresh_ = 0;              ///< slot of the first of them
    std::vector<uint32_t> own_;            ///< indices of samples that are shaded at their own hit
    struct {
        std::vector<geometry::SurfacePoint> places;
        std::vector<geometry::HitRef> hits;
        std::vector<shading::GridPoint> points;
        std::vector<CameraRay> rays;
        std::vector<SampleResult> results;
    } work_; ///< scratch memory for shading micropolygons
};

} // namespace alpenglow::integrator

// A frame prepared for rendering (World): public interface. impl.h has the bindings for rays, services and lights.
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"
#include "scene/primitive.h"
#include "world/settings.h"
#include <span>

namespace alpenglow::world {

class WorldImpl;
class Evaluator;
class PhotonStore;
struct Service;
/// Makes an Evaluator (evaluator.h) that runs kernels of a world before rays are traced. Several may run at once; the world
/// outlives them. building: the world is not complete, so what services answer may change and is not kept.
using MakeEvaluator =
    std::function<std::unique_ptr<Evaluator>(const WorldImpl&, Diagnostics&, const StopFlag* stop, bool building)>;

/// A frame ready for tracing: shapes diced, acceleration structure built, shaders compiled, lights bound. Immutable; shared by
/// threads.
class World {
public:
    /// Returns null after an error that prevents rendering (it is reported). Missing shaders are errors, too, but have fallbacks.
    /// `services`: what answers shadeops (service.h); must outlive the world.
    static std::shared_ptr<const World> build(const std::shared_ptr<const scene::Frame>&, const Settings&,
                                              std::span<const Service> services, MakeEvaluator, Diagnostics&);
    virtual ~World() = default;
    /// As the world was built.
    virtual const scene::Frame& frame() const = 0;
    virtual const Settings& settings() const = 0;
    /// Figures of the build.
    struct Facts {
        double buildSec = 0, compileSec = 0; ///< seconds
        /// Kernels of all shaders; of these, how many do not wait, wait, came from the cache.
        int kernels = 0, affine = 0, suspending = 0, cacheHits = 0;
        size_t shapes = 0, before = 0; ///< before: those not entirely behind the camera
    };
    /// For --stats.
    virtual Facts facts() const = 0;
    /// Maps that were read, by name: bytes of the file, of the map in memory, and of levels in a scratch file.
    struct MapRead {
        std::string path; ///< of the file
        size_t bytes = 0, memory = 0, scratch = 0;
    };
    virtual std::vector<MapRead> mapsRead() const { return {}; }
    /// Floats of each AOV in Settings::outputs: as wide as in the shaders that write it, arrays with all elements.
    virtual std::vector<int> outputWidths() const = 0;
    /// Entries of Settings::outputs that no shader writes and that are not predefined variables; they are 0 everywhere. Empty if
    /// the frame has no primitives.
    virtual std::vector<std::string> missingOutputs() const { return {}; }
    /// Point clouds and similar maps in which no texture3d() has found anything so far, each with the place of a call.
    virtual std::vector<std::pair<std::string, SourcePlace>> cloudsFoundEmpty() const { return {}; }
    /// Calls of occlusion(), indirectdiffuse() and gather() with everything occluded behind normals that face away, on entire
    /// primitives.
    struct FlippedNormalsCall {
        SourcePlace call, primitive; ///< first affected primitive in order of file and line
        std::string shadeop;         ///< name of the call
        size_t primitives = 0;
    };
    virtual std::vector<FlippedNormalsCall> callsTurnedAway() const { return {}; }
    /// The shader of a medium, and its first primitive's place; integrator::Counters::media has the order.
    struct NamedMedium {
        std::string shader;
        SourcePlace place;
    };
    virtual NamedMedium medium(size_t) const { return {}; }
    /// The photon maps of the frame (photonstore.h).
    virtual PhotonStore* photons() const { return nullptr; }
    /// Valid output names for suggestions: predefined variables and outputs of the frame's shaders.
    virtual std::vector<std::string> knownOutputs() const { return {}; }
    /// Whether a shader uses irradiance caching. Before the picture, trace passes of rays with CameraRay::records, coarse to
    /// fine, each followed by keepRecords(). Later passes read the records of earlier ones, so their order within a pass changes
    /// nothing.
    virtual bool interpolates() const { return false; }
    /// Ends such a pass; no thread may trace. Returns the number of records.
    virtual size_t keepRecords() const { return 0; }
    /// Writes what shaders have printed since the last call, in sample order, or discards it. Call between passes.
    virtual void flushPrints(bool keep) const = 0;
    /// Runs the frame's imager over finished pixels, in place. rgb: linear colour, alpha: coverage, raster positions in pixels.
    /// Returns true if there is an imager. After *stop is set its loops end early and the pixels are undefined; null: cannot be
    /// stopped.
    virtual bool runImager(int count, const float* rasterX, const float* rasterY, float* r, float* g, float* b, float* alpha,
                           Diagnostics&, const StopFlag* stop = nullptr) const = 0;
};

} // namespace alpenglow::world

// A frame made ready (World): what others see of it. What rays, answers and lights are bound to is in impl.h.
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"
#include "scene/primitive.h"
#include "world/settings.h"
#include <span>

namespace alpenglow::transport {

class WorldImpl;
class Evaluator;
class PhotonStore;
/// Gives who runs kernels of a world before rays are followed (evaluator.h). Several may work at a time; the world outlives them.
using MakeEvaluator = std::function<std::unique_ptr<Evaluator>(const WorldImpl&, Diagnostics&, const StopFlag* stop)>;

/// A frame ready to be traced: shapes diced, accelerated, shaders compiled, lights bound. Immutable and shared by threads.
class World {
public:
    /// Null when nothing can be rendered (an error was reported); missing shaders fall back with an error.
    static std::shared_ptr<const World> build(const std::shared_ptr<const scene::Frame>&, const Settings&, MakeEvaluator,
                                              Diagnostics&);
    virtual ~World() = default;
    virtual const scene::Frame& frame() const = 0;
    virtual const Settings& settings() const = 0;
    struct Facts {
        double buildSec = 0, compileSec = 0;
        int kernels = 0, affine = 0, suspending = 0, cacheHits = 0;
        size_t shapes = 0, before = 0; ///< before: those that are not wholly behind the camera
    };
    virtual Facts facts() const = 0;
    /// The maps that were read, by name: bytes of the file, of its map in memory, and of levels in a scratch file.
    struct MapRead {
        std::string path;
        size_t bytes = 0, memory = 0, scratch = 0;
    };
    virtual std::vector<MapRead> mapsRead() const { return {}; }
    /// Floats per AOV in Settings::outputs: what the shaders that give it have, arrays with all their elements.
    virtual std::vector<int> outputWidths() const = 0;
    /// Those of Settings::outputs that no shader of the frame gives and that are no predefined variable: they are 0 everywhere.
    /// None where the frame has no primitives.
    virtual std::vector<std::string> missingOutputs() const { return {}; }
    /// Point clouds and their like in which texture3d() has found nothing at any point until now, with the place of a call.
    virtual std::vector<std::pair<std::string, SourcePlace>> cloudsFoundEmpty() const { return {}; }
    /// Calls of occlusion(), indirectdiffuse() and gather() that have found everything blocked behind normals that face away, all
    /// over so many primitives.
    struct TurnedAwayCall {
        SourcePlace call, primitive; ///< the primitive that is the first in the order of files and lines
        std::string shadeop;
        size_t primitives = 0;
    };
    virtual std::vector<TurnedAwayCall> callsTurnedAway() const { return {}; }
    /// The photon maps of the frame (photonstore.h).
    virtual PhotonStore* photons() const { return nullptr; }
    /// What could be named instead: predefined variables and the outputs of the frame's shaders.
    virtual std::vector<std::string> knownOutputs() const { return {}; }
    /// Some shader wants light interpolated: before pictures are traced passes of rays with CameraRay::records are to be, coarse
    /// to fine, each followed by keepRecords(). What a pass finds the next ones read, so that its order changes nothing.
    virtual bool interpolates() const { return false; }
    /// Ends such a pass: no thread may trace meanwhile. Returns how many records there are now.
    virtual size_t keepRecords() const { return 0; }
    /// Writes what shaders have printed since the last call, in the order of the samples; or forgets it. Between passes.
    virtual void flushPrints(bool keep) const = 0;
    /// Runs the frame's imager over finished pixels, in place. rgb: linear colour, alpha: coverage, P: raster position. True when
    /// there is one. Once *stop is set its loops end early, and the pixels are void; null: never.
    virtual bool runImager(int count, const float* rasterX, const float* rasterY, float* r, float* g, float* b, float* alpha,
                           Diagnostics&, const StopFlag* stop = nullptr) const = 0;
};

} // namespace alpenglow::transport

// Light of point, spot and distant lights that comes to vertices by mirrors and glass: searches for its paths from points whose
// lobes spread light (specularsearch.h), and connects the lobes to the last mirror as to a light without area. Reads
// VertexBlocks::vertices and sites; writes VertexBlocks::lights and, by Connection, ShadowRays::queue. A search costs some
// thirty probes of 2 to 5 us.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/specularsearch.h"
#include "integrator/vertexblocks.h"
#include <memory>

namespace alpenglow::integrator {

/// Light of point, spot and distant lights that comes to vertices by mirrors and glass.
class SpecularLights final : VertexStage {
public:
    SpecularLights(const StageSet&, const VertexStages&);
    ~SpecularLights();
    /// After select(): for all points of a batch.
    void run(BatchContext&);

private:
    std::shared_ptr<const CausticSeeds> seeds() const;
    float bringsAt(size_t block, int lane, const BatchContext&) const;
    void ask(const CausticSeeds&, const BatchContext&);
    void connect(int light, BatchContext&);

    struct Asked {
        size_t point;
        float chance; ///< of the search
    };
    std::unique_ptr<SpecularSearch> search_;       ///< null until the first search
    std::shared_ptr<const CausticSeeds> searched_; ///< by search_
    std::vector<Asked> asked_;
    std::vector<SpecularSearch::Query> queries_; ///< by asked_
    std::vector<SpecularSearch::Found> found_;   ///< by asked_
    Connection& connection_;
    RayStore& store_;
};

} // namespace alpenglow::integrator

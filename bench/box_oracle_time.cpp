#include "bench/box_oracle_runs.inc"
#include "oracle/box_oracle_embree.h"

namespace alpenglow::bench {
namespace {

template <class Meet> double run(const oracle::Tracer<Meet>& box, const OracleRun& r, std::vector<double>& sums) {
    sums.assign(size_t(r.width) * size_t(r.height) * 3, 0);
    double all = 0;
    eachSample(r, box, [&](int x, int y, const oracle::V& v) {
        double* p = &sums[(size_t(y) * size_t(r.width) + size_t(x)) * 3];
        p[0] += v.x;
        p[1] += v.y;
        p[2] += v.z;
        all += v.x + v.y + v.z;
    });
    return all / 3 / (double(r.width) * r.height * r.samples);
}

} // namespace

double runOracle(const OracleRun& r, std::vector<double>& sums) {
    oracle::Box box;
    box.freeBounces = r.freeBounces;
    box.rootRoulette = r.rootRoulette;
    return run(box, r, sums);
}

OracleRunner oracleThroughEmbree() {
    auto box = std::make_shared<oracle::Tracer<oracle::ThroughEmbree>>();
    return [box](const OracleRun& r, std::vector<double>& sums) {
        box->freeBounces = r.freeBounces;
        box->rootRoulette = r.rootRoulette;
        return run(*box, r, sums);
    };
}

} // namespace alpenglow::bench

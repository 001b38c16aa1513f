// The oracle once more with a counter, under another name, so that the timed one does not carry it.
#define ORACLE_COUNTS_RAYS
#define oracle counted_oracle
#include "bench/box_oracle_runs.inc"

namespace alpenglow::bench {

double oracleRays(const OracleRun& r) {
    oracle::Box box;
    box.freeBounces = r.freeBounces;
    box.rootRoulette = r.rootRoulette;
    uint64_t samples = 0;
    eachSample(r, box, [&](int, int, const oracle::V&) { ++samples; });
    return double(box.rays) / double(samples);
}

} // namespace alpenglow::bench

#include "bench/box_oracle_runs.inc"

namespace alpenglow::bench {

double runOracle(const OracleRun& r, std::vector<double>& sums) {
    oracle::Box box;
    box.freeBounces = r.freeBounces;
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

} // namespace alpenglow::bench

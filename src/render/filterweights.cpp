#include "render/filterweights.h"
#include "base/exact.h"
#include "base/vec.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {
namespace {

// Linear pieces of length h have an error of at most h^2 / 8 times the second derivative. That is at most 7.8 per pixel (bessel,
// whose maximum is pi), or 16 relative to the half width for filters that scale with their width (mitchell, whose maximum is
// 8/9).
constexpr int kSegments = 2048; ///< pieces per pixel, or per half width if that is less

int piecesOf(double end) { return kSegments * std::max(1, int(std::ceil(end))); }

} // namespace

template <class F> FilterWeights::Table::Table(double end_, int count, const F& f) : end(end_), scale(count / end_) {
    pieces.resize(size_t(count) + 1); // the last entry is for the end itself
    double next = f(0.0);
    for (int i = 0; i <= count; ++i) {
        const double value = next;
        if (i < count) next = f(std::min(end, (i + 1) / scale));
        pieces[size_t(i)] = {float(value), float(next - value)};
    }
}

FilterWeights::FilterWeights(const PixelFilter& f) : filter_(f), separable_(f.separable()) {
    if (f.kind == FilterKind::Box || f.kind == FilterKind::Disk) return;
    if (separable_) {
        const auto table = [&](double w) {
            return std::make_shared<const Table>(w / 2, piecesOf(w / 2), [&](double t) { return f.axis(t, w); });
        };
        across_ = table(f.xw);
        down_ = f.yw == f.xw ? across_ : table(f.yw);
        return;
    }
    // catmull-rom ends at 2 for any width; bessel ends at the rim.
    const double end = f.kind == FilterKind::CatmullRom ? 2 : std::max(f.xw, f.yw) / 2;
    const PixelFilter wide{f.kind, 1e9, 1e9}; // its cosine is 1
    byDistance_ = std::make_shared<const Table>(end, piecesOf(end), [&](double r) { return wide(r, 0); });
    if (f.kind == FilterKind::Bessel)
        byPart_ = std::make_shared<const Table>(1, kSegments, [](double t) { return exact::cos(kPi / 2 * t); });
}

float FilterWeights::operator()(double x, double y) const {
    if (separable_) return across(x) * down(y);
    if (filter_.kind == FilterKind::Disk) return float(filter_(x, y));
    if (!(std::fabs(x) <= filter_.xw / 2 && std::fabs(y) <= filter_.yw / 2)) return 0;
    const float distance = (*byDistance_)(std::sqrt(x * x + y * y));
    if (!byPart_) return distance;
    const double part = std::sqrt((2 * x / filter_.xw) * (2 * x / filter_.xw) + (2 * y / filter_.yw) * (2 * y / filter_.yw));
    return part < 1 ? distance * (*byPart_)(part) : 0;
}

} // namespace alpenglow::render

#include "display/diff.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace alpenglow::display {

std::optional<DiffResult> compareImages(const Image& a, const Image& b, Diagnostics& diags) {
    if (a.width != b.width || a.height != b.height) {
        auto size = [](const Image& m) { return std::to_string(m.width) + " x " + std::to_string(m.height); };
        diags.report(Severity::Error, Rie::Consistency, {}, "the pictures differ in size: " + size(a) + " and " + size(b));
        return {};
    }
    if (a.channels.size() != b.channels.size()) {
        auto names = [](const Image& m) {
            std::string all;
            for (const std::string& c : m.channels) all += (all.empty() ? "" : " ") + c;
            return all;
        };
        diags.report(Severity::Error, Rie::Consistency, {},
                     "the pictures have different channels: " + names(a) + " in the first, " + names(b) + " in the second");
        return {};
    }
    size_t n = a.channels.size(), pixels = size_t(a.width) * size_t(a.height);
    std::vector<size_t> other(n);
    auto sa = a.channels, sb = b.channels;
    std::sort(sa.begin(), sa.end());
    std::sort(sb.begin(), sb.end());
    for (size_t c = 0; c < n; ++c) other[c] = sa == sb ? size_t(b.channel(a.channels[c])) : c;

    DiffResult r;
    r.difference = makeImage(a.width, a.height, a.channels);
    r.channels.resize(n);
    r.all.name = "all";
    r.all.max = -1;
    double sumAbs = 0, sumSquares = 0, sumA = 0, sumB = 0;
    size_t samples = 0;
    for (size_t c = 0; c < n; ++c) {
        ChannelDiff& d = r.channels[c];
        d.name = a.channels[c];
        double abs = 0, squares = 0, ma = 0, mb = 0, largest = -1;
        size_t count = 0;
        for (size_t p = 0; p < pixels; ++p) {
            float x = a.data[p * n + c], y = b.data[p * n + other[c]];
            float& out = r.difference.data[p * n + c];
            bool same = x == y || (std::isnan(x) && std::isnan(y));
            if (!same && !(std::isfinite(x) && std::isfinite(y))) {
                ++d.nonFinite;
                out = std::numeric_limits<float>::infinity();
                continue;
            }
            double e = same ? 0 : std::fabs(double(x) - double(y));
            out = float(e);
            abs += e;
            squares += e * e;
            ++count;
            if (std::isfinite(x)) {
                ma += x;
                mb += y;
            }
            if (e > largest) {
                largest = e;
                d.maxX = int(p % size_t(a.width));
                d.maxY = int(p / size_t(a.width));
            }
        }
        double k = count ? 1.0 / double(count) : 0;
        d.max = std::max(0.0, largest);
        d.meanAbs = abs * k;
        d.rmse = std::sqrt(squares * k);
        d.meanA = ma * k;
        d.meanB = mb * k;
        if (d.max > r.all.max) {
            r.all.max = d.max;
            r.all.maxX = d.maxX;
            r.all.maxY = d.maxY;
        }
        sumAbs += abs;
        sumSquares += squares;
        sumA += ma;
        sumB += mb;
        samples += count;
        r.all.nonFinite += d.nonFinite;
    }
    double k = samples ? 1.0 / double(samples) : 0;
    r.all.max = std::max(0.0, r.all.max);
    r.all.meanAbs = sumAbs * k;
    r.all.rmse = std::sqrt(sumSquares * k);
    r.all.meanA = sumA * k;
    r.all.meanB = sumB * k;
    return r;
}

std::string toString(const DiffResult& r) {
    std::string out;
    auto line = [&](const ChannelDiff& d) {
        char text[320];
        std::snprintf(text, sizeof text, "%s mean %.7g rmse %.7g max %.7g at %d,%d", d.name.c_str(), d.meanAbs, d.rmse, d.max,
                      d.maxX, d.maxY);
        out += text;
        if (d.nonFinite) out += " non-finite " + std::to_string(d.nonFinite);
        out += "\n";
    };
    for (const ChannelDiff& d : r.channels) line(d);
    line(r.all);
    return out;
}

} // namespace alpenglow::display

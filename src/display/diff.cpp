#include "display/diff.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace alpenglow::display {

namespace {

/// Whether the pictures have the same size and number of channels; says what differs.
bool comparable(const Image& a, const Image& b, Diagnostics& diags) {
    if (a.width != b.width || a.height != b.height) {
        auto size = [](const Image& m) { return std::to_string(m.width) + " x " + std::to_string(m.height); };
        diags.report(Severity::Error, Rie::Consistency, {}, "the pictures differ in size: " + size(a) + " and " + size(b));
        return false;
    }
    if (a.channels.size() != b.channels.size()) {
        auto names = [](const Image& m) {
            std::string all;
            for (const std::string& c : m.channels) all += (all.empty() ? "" : " ") + c;
            return all;
        };
        diags.report(Severity::Error, Rie::Consistency, {},
                     "the pictures have different channels: " + names(a) + " in the first, " + names(b) + " in the second");
        return false;
    }
    return true;
}

/// The channel of b that belongs to each of a: by name, or if they have other names by number.
std::vector<size_t> pairedChannels(const Image& a, const Image& b) {
    const size_t n = a.channels.size();
    std::vector<size_t> other(n);
    auto sa = a.channels, sb = b.channels;
    std::sort(sa.begin(), sa.end());
    std::sort(sb.begin(), sb.end());
    for (size_t c = 0; c < n; ++c) other[c] = sa == sb ? size_t(b.channel(a.channels[c])) : c;
    return other;
}

/// Sums over the finite samples of a channel, or of all.
struct Sums {
    double abs = 0, squares = 0, a = 0, b = 0;
    size_t count = 0;
    void means(ChannelDiff& d) const {
        const double k = count ? 1.0 / double(count) : 0;
        d.meanAbs = abs * k;
        d.rmse = std::sqrt(squares * k);
        d.meanA = a * k;
        d.meanB = b * k;
    }
};

/// Compares channel ca of a with cb of b, and writes the differences into a picture with the channels of a.
Sums compareChannel(const Image& a, size_t ca, const Image& b, size_t cb, Image& difference, ChannelDiff& d) {
    const size_t n = a.channels.size(), pixels = size_t(a.width) * size_t(a.height);
    Sums s;
    double largest = -1;
    for (size_t p = 0; p < pixels; ++p) {
        float x = a.data[p * n + ca], y = b.data[p * n + cb];
        float& out = difference.data[p * n + ca];
        bool same = x == y || (std::isnan(x) && std::isnan(y));
        if (!same && !(std::isfinite(x) && std::isfinite(y))) {
            ++d.nonFinite;
            out = std::numeric_limits<float>::infinity();
            continue;
        }
        double e = same ? 0 : std::fabs(double(x) - double(y));
        out = float(e);
        s.abs += e;
        s.squares += e * e;
        ++s.count;
        if (std::isfinite(x)) {
            s.a += x;
            s.b += y;
        }
        if (e > largest) {
            largest = e;
            d.maxX = int(p % size_t(a.width));
            d.maxY = int(p / size_t(a.width));
        }
    }
    d.max = std::max(0.0, largest);
    s.means(d);
    return s;
}

} // namespace

std::optional<DiffResult> compareImages(const Image& a, const Image& b, Diagnostics& diags) {
    if (!comparable(a, b, diags)) return {};
    const size_t n = a.channels.size();
    const std::vector<size_t> other = pairedChannels(a, b);
    DiffResult r;
    r.difference = makeImage(a.width, a.height, a.channels);
    r.channels.resize(n);
    r.all.name = "all";
    r.all.max = -1;
    Sums all;
    for (size_t c = 0; c < n; ++c) {
        ChannelDiff& d = r.channels[c];
        d.name = a.channels[c];
        const Sums s = compareChannel(a, c, b, other[c], r.difference, d);
        if (d.max > r.all.max) {
            r.all.max = d.max;
            r.all.maxX = d.maxX;
            r.all.maxY = d.maxY;
        }
        all.abs += s.abs;
        all.squares += s.squares;
        all.a += s.a;
        all.b += s.b;
        all.count += s.count;
        r.all.nonFinite += d.nonFinite;
    }
    r.all.max = std::max(0.0, r.all.max);
    all.means(r.all);
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

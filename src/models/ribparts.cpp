#include "models/ribparts.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace alpenglow::models {

namespace {

/// Writes numbers in pieces, with as many digits as give the same float again.
class Numbers {
public:
    explicit Numbers(const std::function<void(std::string_view)>& out) : out_(out) {}
    ~Numbers() { flush(); }
    void text(std::string_view t) { buffer_.append(t.begin(), t.end()); }
    template <class T> void number(T v) {
        fmt::format_to(std::back_inserter(buffer_), "{}", v);
        buffer_.push_back(++count_ % 12 ? ' ' : '\n');
        if (buffer_.size() > (size_t(1) << 18)) flush();
    }
    void begin(const char* declared) {
        count_ = 0;
        text(fmt::format("\n\"{}\" [", declared));
    }
    void end() { text("]"); }

private:
    void flush() {
        out_({buffer_.data(), buffer_.size()});
        buffer_.clear();
    }
    const std::function<void(std::string_view)>& out_;
    fmt::memory_buffer buffer_;
    int count_ = 0;
};

/// The vertices that are used, in order, and where each went.
struct Used {
    std::vector<int32_t> kept, at;
    explicit Used(const Part& p) : at(p.vertices(), -1) {
        for (const int32_t v : p.corners) at[size_t(v)] = 0;
        for (size_t i = 0; i < at.size(); ++i)
            if (at[i] == 0) {
                at[i] = int32_t(kept.size());
                kept.push_back(int32_t(i));
            }
    }
};

/// Values of some of `stride` numbers a vertex.
void rows(Numbers& n, const char* declared, const std::vector<float>& x, const std::vector<int32_t>& vertices, size_t stride,
          size_t from, size_t count) {
    n.begin(declared);
    for (const int32_t v : vertices)
        for (size_t k = 0; k < count; ++k) n.number(x[size_t(v) * stride + from + k]);
    n.end();
}

bool opaque(const std::vector<float>& color) {
    for (size_t i = 3; i < color.size(); i += 4)
        if (color[i] != 1) return false;
    return true;
}

void variables(Numbers& n, const Part& p, const std::vector<float>& P, const std::vector<float>& N,
               const std::vector<int32_t>& vertices, int set) {
    rows(n, "P", P, vertices, 3, 0, 3);
    if (!N.empty() && p.kind == PartKind::Polygons) rows(n, "N", N, vertices, 3, 0, 3);
    if (size_t(set) < p.st.size() && !p.st[size_t(set)].empty())
        rows(n, "vertex float[2] st", p.st[size_t(set)], vertices, 2, 0, 2);
    if (p.color.empty()) return;
    rows(n, "vertex color Cs", p.color, vertices, 4, 0, 3);
    if (opaque(p.color)) return;
    n.begin("vertex color Os");
    for (const int32_t v : vertices)
        for (int k = 0; k < 3; ++k) n.number(p.color[size_t(v) * 4 + 3]);
    n.end();
}

/// Points and lines have no width in such files: one that can be seen, a five-hundredth of their box.
float width(const Part& p, const std::vector<float>& P) {
    double size = 0;
    for (size_t k = 0; k < 3; ++k) {
        float lo = INFINITY, hi = -INFINITY;
        for (const int32_t v : p.corners) {
            lo = std::min(lo, P[size_t(v) * 3 + k]);
            hi = std::max(hi, P[size_t(v) * 3 + k]);
        }
        size += double(hi - lo) * double(hi - lo);
    }
    return size > 0 ? float(std::sqrt(size) / 500) : .01f;
}

} // namespace

void partText(const Part& p, const std::vector<float>& P, const std::vector<float>& N, int set,
              const std::function<void(std::string_view)>& out) {
    Numbers n(out);
    if (p.kind == PartKind::Polygons) {
        const Used used(p);
        n.text("PointsPolygons [");
        for (const int32_t c : p.counts) n.number(c);
        n.text("] [");
        for (const int32_t v : p.corners) n.number(used.at[size_t(v)]);
        n.text("]");
        variables(n, p, P, N, used.kept, set);
    } else {
        if (p.kind == PartKind::Lines) {
            n.text("Curves \"linear\" [");
            for (const int32_t c : p.counts) n.number(c);
            n.text("] \"nonperiodic\"");
        } else {
            n.text("Points");
        }
        variables(n, p, P, N, p.corners, set);
        n.text(fmt::format("\n\"constantwidth\" [{}]", width(p, P)));
    }
    n.text("\n");
}

} // namespace alpenglow::models

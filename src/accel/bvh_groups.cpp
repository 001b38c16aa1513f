#include "accel/bvh_groups.h"
#include "accel/bvh_cut.h"
#include "base/parallel.h"
#include <bit>
#include <cstdint>
#include <mutex>
#include <utility>

namespace alpenglow::accel {

namespace {

constexpr size_t kParallelRun = 131'072; // references that one task puts into cells

struct Cell {
    Box box, centres;
    uint32_t refs = 0, triangles = 0;
    void add(const Cell& c) {
        box.add(c.box);
        centres.add(c.centres);
        refs += c.refs;
        triangles += c.triangles;
    }
};

/// Cells are about cubic, and hold about fifty references of a surface.
struct Grid {
    Four from, scale{}, last{};
    int bits[3] = {};
    explicit Grid(const Range& r) : from(r.centres.lo) {
        const Four wide = r.centres.hi - r.centres.lo;
        float step[3] = {wide[0], wide[1], wide[2]};
        for (int left = std::clamp(int(std::bit_width(r.size())) - 5, 4, 12); left > 0; --left) {
            const int a = step[0] >= step[1] ? (step[0] >= step[2] ? 0 : 2) : (step[1] >= step[2] ? 1 : 2);
            step[a] *= 0.5f;
            ++bits[a];
        }
        for (int a = 0; a < 3; ++a) {
            const float cells = float(1 << bits[a]);
            last[a] = cells - 1;
            scale[a] = wide[a] > 0 ? cells * 0.99999f / wide[a] : 0;
            if (!std::isfinite(scale[a])) scale[a] = 0;
        }
    }
    size_t cells() const { return size_t(1) << (bits[0] + bits[1] + bits[2]); }
    uint32_t cellOf(Four twiceCentre) const {
        const Whole4 at = stepsOf(twiceCentre, from, scale, last);
        return uint32_t((((at[2] << bits[1]) | at[1]) << bits[0]) | at[0]);
    }
};

/// The cells, and the cell of each reference of the range.
std::vector<Cell> cellsOf(const Ref* refs, const Range& r, const Grid& grid, std::vector<uint16_t>& cellOf) {
    std::vector<Cell> cells(grid.cells());
    cellOf.resize(r.size());
    const auto put = [&](size_t begin, size_t end, std::vector<Cell>& into) {
        for (size_t i = begin; i < end; ++i) {
            const Ref& ref = refs[i];
            const Four c = ref.twiceCentre();
            const uint32_t k = grid.cellOf(c);
            cellOf[i - r.begin] = uint16_t(k);
            Cell& cell = into[k];
            cell.box.add(ref.lo, ref.hi);
            cell.centres.add(c, c);
            ++cell.refs;
            cell.triangles += ref.many();
        }
    };
    const size_t runs = r.size() / kParallelRun;
    if (runs < 2) {
        put(r.begin, r.end, cells);
        return cells;
    }
    std::mutex adding;
    parallelFor(size_t(0), runs, [&](size_t i) {
        std::vector<Cell> own(grid.cells());
        put(r.begin + i * r.size() / runs, r.begin + (i + 1) * r.size() / runs, own);
        std::lock_guard lock(adding);
        for (size_t k = 0; k < own.size(); ++k)
            if (own[k].refs) cells[k].add(own[k]);
    });
    return cells;
}

/// Divides groups, whose references hold the index of their cell, and assigns consecutive ranges.
struct Halving {
    std::vector<Ref>& groups;
    const std::vector<Cell>& cells;
    std::vector<uint32_t>& order; ///< of cells
    std::vector<Half> list;
    size_t placed;

    int divide(const Range& r, int depth) {
        const int at = int(list.size());
        list.emplace_back();
        Range out = r;
        if (r.size() == 1) {
            const Cell& cell = cells[groups[r.begin].id()];
            order.push_back(groups[r.begin].id());
            out.box = cell.box, out.centres = cell.centres;
            out.begin = placed;
            out.end = placed += cell.refs;
        } else {
            Range a, b;
            if (depth <= 0 || !cutInTwo(groups.data(), r, a, b)) {
                a = measuredRange(groups.data(), r.begin, r.begin + r.size() / 2);
                b = measuredRange(groups.data(), r.begin + r.size() / 2, r.end);
            }
            const int left = divide(a, depth - 1), right = divide(b, depth - 1);
            list[size_t(at)].left = left, list[size_t(at)].right = right;
            const Range &first = list[size_t(left)].range, &second = list[size_t(right)].range;
            out = first;
            out.end = second.end;
            out.box.add(second.box);
            out.centres.add(second.centres);
        }
        list[size_t(at)].range = out;
        return at;
    }
};

/// Sorts references by cell, in place.
void arrangeByCell(Ref* refs, std::vector<uint16_t>& cellOf, const std::vector<Cell>& cells, const std::vector<uint32_t>& order) {
    std::vector<uint32_t> next(cells.size());
    uint32_t at = 0;
    for (const uint32_t c : order) next[c] = std::exchange(at, at + cells[c].refs);
    uint32_t end = 0;
    for (const uint32_t c : order) {
        end += cells[c].refs;
        while (next[c] < end) {
            const uint32_t from = next[c];
            const uint16_t is = cellOf[from];
            if (is == c) {
                ++next[c];
                continue;
            }
            const uint32_t to = next[is]++;
            std::swap(refs[from], refs[to]);
            cellOf[from] = std::exchange(cellOf[to], is);
        }
    }
}

} // namespace

std::vector<Half> inGroups(Ref* refs, const Range& r, int depth) {
    const Grid grid(r);
    std::vector<uint16_t> cellOf;
    const std::vector<Cell> cells = cellsOf(refs, r, grid, cellOf);
    std::vector<Ref> groups;
    for (uint32_t k = 0; k < cells.size(); ++k) {
        const Cell& cell = cells[k];
        if (!cell.refs) continue;
        Ref g{cell.box.lo, cell.box.hi};
        g.setId(k);
        g.hi[3] = float(cell.triangles);
        groups.push_back(g);
    }
    if (groups.size() < 2) return {};
    std::vector<uint32_t> order;
    order.reserve(groups.size());
    Halving halving{groups, cells, order, {}, r.begin};
    halving.list.reserve(2 * groups.size());
    halving.divide(measuredRange(groups.data(), 0, groups.size()), depth);
    arrangeByCell(refs + r.begin, cellOf, cells, order);
    return std::move(halving.list);
}

} // namespace alpenglow::accel

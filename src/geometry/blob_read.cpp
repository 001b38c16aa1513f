// Parses a Blobby's instructions into a BlobField.
#include "base/file.h"
#include "base/limits.h"
#include "geometry/blob_field.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::geometry {

namespace {
using Kind = BlobOp::Kind;
}

struct BlobField::Reader {
    BlobField& field;
    const std::vector<int>& code;
    const std::vector<float>& numbers;
    const std::vector<std::string>& strings;
    const Matrix& objectToWorld;
    const SourcePlace& place;
    Diagnostics& diag;
    bool moves = false;
    uint32_t most = 0;             ///< number of the last leaf that variables have values for
    std::vector<uint32_t> results; ///< by instruction: operation of the tape
    uint32_t leaves = 0;
    size_t at = 0, singular = 0;

    bool fail(Rie c, const std::string& why) {
        diag.report(Severity::Error, c, place,
                    "Blobby: instruction " + std::to_string(results.size()) + ": " + why + "; it is not drawn");
        return false;
    }
    uint32_t add(BlobOp o) {
        field.tape_.push_back(o);
        return uint32_t(field.tape_.size() - 1);
    }
    bool operand(int& out) {
        if (at >= code.size()) return fail(Rie::MissingData, "the code ends early");
        out = code[at++];
        return true;
    }
    bool result(uint32_t& out) {
        int i;
        if (!operand(i)) return false;
        if (i < 0 || size_t(i) >= results.size())
            return fail(Rie::Range, "operand " + std::to_string(i) + " is no earlier instruction");
        out = results[size_t(i)];
        return true;
    }
    /// The first of n floats.
    bool floats(int n, const float*& out) {
        int i;
        if (!operand(i)) return false;
        if (i < 0 || size_t(i) + size_t(n) > numbers.size())
            return fail(Rie::Range,
                        "floats " + std::to_string(i) + " and on are beyond the " + std::to_string(numbers.size()) + " given");
        out = &numbers[size_t(i)];
        return true;
    }
    bool run();
    bool instruction(int op);
    bool leaf(int op);
    bool matrixLeaf(const float* matrix, const float* segment);
    bool ground();
    bool several(int op);
};

namespace {

Matrix matrixOf(const float* f) {
    Matrix m;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) m.m[i][j] = f[4 * i + j];
    return m;
}

} // namespace

bool shapeBlobLeaf(const double matrix[16], const double segment[7], BlobLeaf& l) {
    Matrix m;
    for (int i = 0; i < 16; ++i) m.m[i / 4][i % 4] = matrix[i];
    double radius = 1;
    Vec3d a(0.0), b(0.0);
    if (segment) {
        a = Vec3d(segment[0], segment[1], segment[2]), b = Vec3d(segment[3], segment[4], segment[5]);
        radius = std::fabs(segment[6]);
    }
    const Matrix inverse = determinant3(m) != 0 ? alpenglow::inverse(m) : Matrix();
    double norm = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            l.m[i][j] = inverse.m[j][i] / radius;
            norm += l.m[i][j] * l.m[i][j];
        }
        l.m[i][3] = inverse.m[3][i] / radius;
    }
    bool sound = determinant3(m) != 0 && radius > 0 && std::isfinite(norm);
    for (auto& row : l.m)
        for (double x : row) sound = sound && std::isfinite(x);
    if (!sound) return false;
    l.thin = std::sqrt(3 / norm);
    const double long_ = length(b - a) / radius;
    constexpr double kPoint = 1e-6; // shorter segments have no field of their own: they are spheres
    l.kind = long_ > kPoint ? BlobLeaf::Kind::Segment : BlobLeaf::Kind::Ellipsoid;
    if (l.kind == BlobLeaf::Kind::Segment) {
        l.from = a / radius;
        l.along = normalize(b - a);
        l.length = long_;
    } else {
        for (int i = 0; i < 3; ++i) l.m[i][3] -= a[i] / radius;
    }
    const Vec3d pa = transformPoint(m, a), pb = transformPoint(m, b);
    for (int i = 0; i < 3; ++i) {
        const double e = radius * std::sqrt(m.m[0][i] * m.m[0][i] + m.m[1][i] * m.m[1][i] + m.m[2][i] * m.m[2][i]);
        l.lo[i] = std::min(pa[i], pb[i]) - e;
        l.hi[i] = std::max(pa[i], pb[i]) + e;
    }
    return true;
}

void emptyBlobLeaf(BlobLeaf& l) {
    l.kind = BlobLeaf::Kind::Ellipsoid;
    for (auto& row : l.m) std::fill(row, row + 4, 0.0);
    l.m[0][3] = 2; // all points are here, outside of the unit sphere
    l.thin = INFINITY;
    l.lo = Vec3d(INFINITY), l.hi = Vec3d(-INFINITY);
}

/// An ellipsoid, or with two ends and a radius a segment.
bool BlobField::Reader::matrixLeaf(const float* matrix, const float* segment) {
    BlobLeaf l;
    l.number = std::min(leaves, most);
    l.at = uint32_t((segment ? segment : matrix) - numbers.data());
    l.bySegment = segment != nullptr;
    double m[16], s[7] = {};
    std::copy(matrix, matrix + 16, m);
    if (segment) std::copy(segment, segment + 7, s);
    if (!shapeBlobLeaf(m, segment ? s : nullptr, l)) { // no field at all
        if (!moves) {
            ++singular;
            results.push_back(add({Kind::Constant, 0, 0, 0}));
            return true;
        }
        emptyBlobLeaf(l);
    }
    field.leaves_.push_back(l);
    results.push_back(add({Kind::Leaf, uint32_t(field.leaves_.size() - 1), 0, 0}));
    return true;
}

/// A zfile: magic, two 16-bit sizes, world to screen, world to camera, depths; in either order of bytes.
static std::shared_ptr<BlobGround> readGround(const std::string& path, const Matrix& objectToWorld, std::string& why) {
    Diagnostics own;
    const auto bytes = readWholeFile(path, limits::kModelBytes, own);
    if (!bytes) return why = own.all().empty() ? "it cannot be read" : own.all().back().message, nullptr;
    const auto& b = *bytes;
    constexpr size_t kHead = 8 + 128;
    const bool big = b.size() > 4 && b[0] == 0x2f && b[1] == 0x08 && b[2] == 0x67 && b[3] == 0xab;
    const bool little = b.size() > 4 && b[0] == 0xab && b[1] == 0x67 && b[2] == 0x08 && b[3] == 0x2f;
    if (b.size() < kHead || !(big || little)) return why = "it is no zfile", nullptr;
    const auto word = [&](size_t at, size_t n) {
        uint32_t v = 0;
        for (size_t i = 0; i < n; ++i) v |= uint32_t(b[at + i]) << (8 * (little ? i : n - 1 - i));
        return v;
    };
    const auto real = [&](size_t at) { return std::bit_cast<float>(word(at, 4)); };
    auto g = std::make_shared<BlobGround>();
    g->width = int(word(4, 2));
    g->height = int(word(6, 2));
    const size_t n = size_t(g->width) * size_t(g->height);
    if (n == 0 || (b.size() - kHead) / 4 < n) return why = "it is cut short", nullptr;
    float m[2][16];
    for (size_t i = 0; i < 32; ++i)
        if (!std::isfinite(m[i / 16][i % 16] = real(8 + 4 * i))) return why = "its matrices are not finite", nullptr;
    g->toScreen = objectToWorld * matrixOf(m[0]);
    g->toCamera = objectToWorld * matrixOf(m[1]);
    for (size_t i = 0; i < n; ++i) {
        float z = real(kHead + 4 * i);
        if (!(std::fabs(z) < 1e30f)) z = 1e30f; // empty: infinitely far
        g->depth.push_back(z);
    }
    g->sumUp();
    return g;
}

bool BlobField::Reader::ground() {
    int name;
    const float* f = nullptr;
    if (!operand(name) || !floats(4, f)) return false;
    if (name < 0 || size_t(name) >= strings.size()) return fail(Rie::Range, "string " + std::to_string(name) + " is not given");
    std::string why;
    auto g = readGround(strings[size_t(name)], objectToWorld, why);
    if (!g) { // the rest is drawn
        diag.report(Severity::Error, Rie::NoFile, place,
                    "Blobby: the depth map \"" + strings[size_t(name)] + "\" of a repelling plane: " + why +
                        "; the plane is ignored");
        results.push_back(add({Kind::Constant, 0, 0, 0}));
        return true;
    }
    g->a = f[0], g->b = f[1], g->c = f[2], g->d = f[3];
    if (!(g->a > 0) || g->c == 0)
        return fail(Rie::Range, "a repelling plane needs a height above 0 and a bulge at a height that is not 0");
    BlobLeaf l;
    l.kind = BlobLeaf::Kind::Ground;
    l.number = std::min(leaves, most);
    l.at = uint32_t(f - numbers.data());
    l.thin = g->a;
    l.ground = g;
    field.leaves_.push_back(l);
    results.push_back(add({Kind::Leaf, uint32_t(field.leaves_.size() - 1), 0, 0}));
    return true;
}

bool BlobField::Reader::leaf(int op) {
    const float* f = nullptr;
    bool good = false;
    if (op == 1000) {
        good = floats(1, f);
        if (good) results.push_back(add({Kind::Constant, moves ? uint32_t(f - numbers.data()) + 1 : 0, 0, double(*f)}));
    } else if (op == 1001) {
        good = floats(16, f) && matrixLeaf(f, nullptr);
    } else if (op == 1002) {
        good = floats(23, f) && matrixLeaf(f + 7, f);
    } else if (op == 1003) {
        good = ground();
    } else {
        return fail(Rie::Unimplement,
                    op == 1004 ? "fields of plug-ins (1004) are not known" : "opcode " + std::to_string(op) + " is not known");
    }
    ++leaves;
    return good;
}

bool BlobField::Reader::several(int op) {
    int count;
    if (!operand(count)) return false;
    if (count < 1 || size_t(count) > code.size() - at) return fail(Rie::Range, std::to_string(count) + " operands");
    constexpr Kind kinds[] = {Kind::Add, Kind::Multiply, Kind::Maximum, Kind::Minimum};
    uint32_t sum = 0;
    for (int i = 0; i < count; ++i) {
        uint32_t one = 0;
        if (!result(one)) return false;
        sum = i ? add({kinds[op], sum, one, 0}) : one;
    }
    results.push_back(sum);
    return true;
}

bool BlobField::Reader::instruction(int op) {
    if (op >= 1000) return leaf(op);
    if (op >= 0 && op <= 3) return several(op);
    uint32_t a = 0, b = 0;
    switch (op) {
    case 4:
    case 5: // in the order of the specification; the application note's table has the two reversed, unlike its pictures
        if (!result(a) || !result(b)) return false;
        results.push_back(add({op == 4 ? Kind::Subtract : Kind::Divide, a, b, 0}));
        return true;
    case 6:
        if (!result(a)) return false;
        results.push_back(add({Kind::Negate, a, 0, 0}));
        return true;
    case 7:
        if (!result(a)) return false;
        results.push_back(a);
        return true;
    default:
        return fail(Rie::Range, "opcode " + std::to_string(op) + " is not known");
    }
}

bool BlobField::Reader::run() {
    if (code.size() > size_t(limits::kBlobInstructions)) return fail(Rie::Limit, "there are too many instructions");
    while (at < code.size())
        if (!instruction(code[at++])) return false;
    if (results.empty()) return fail(Rie::MissingData, "there are none");
    // The last instruction is the field: drops what it does not use.
    const uint32_t last = results.back();
    field.tape_.resize(last + 1);
    std::vector<Interval> open(field.tape_.size(), Interval{-INFINITY, INFINITY});
    for (size_t i = 0; i < open.size(); ++i)
        if (field.tape_[i].kind == Kind::Constant && field.tape_[i].a == 0) open[i] = {field.tape_[i].c, field.tape_[i].c};
    field.tape_ = simplified(field.tape_, open);
    if (singular)
        diag.report(Severity::Warning, Rie::Math, place,
                    "Blobby: " + std::to_string(singular) +
                        " leaves have a matrix without inverse or no radius; they have no field");
    return true;
}

bool BlobField::read(int count, const std::vector<int>& code, const std::vector<float>& numbers,
                     const std::vector<std::string>& strings, const Matrix& objectToWorld, const SourcePlace& place,
                     Diagnostics& diag, bool moves) {
    tape_.clear();
    leaves_.clear();
    Reader r{*this, code, numbers, strings, objectToWorld, place, diag, moves, uint32_t(std::max(count, 1) - 1), {}};
    if (!r.run()) return false;
    // The hand of Pixar's application note 31 counts one too few, and is drawn there.
    if (int(r.leaves) != count)
        diag.report(Severity::Warning, Rie::Consistency, place,
                    "Blobby: its code has " + std::to_string(r.leaves) + " leaves, not " + std::to_string(count) +
                        ": those of the code are drawn");
    return true;
}

} // namespace alpenglow::geometry

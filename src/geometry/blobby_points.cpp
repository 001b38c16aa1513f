// Variables of type mpoint (PRMan's notes on blobbies): a matrix a blob, where the blob was in its reference pose. A point of the
// surface is taken from where each blob is to where it was, and these places are mixed as the blobs mix there.
#include "geometry/blobby.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

Matrix matrixFrom(const float* numbers) {
    Matrix m;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) m.m[y][x] = double(numbers[4 * y + x]);
    return m;
}

/// The row (v, w) times the matrix.
void times(const Matrix& m, const Vec3d& v, double w, double out[4]) {
    for (int k = 0; k < 4; ++k) out[k] = v.x * m.m[0][k] + v.y * m.m[1][k] + v.z * m.m[2][k] + w * m.m[3][k];
}

constexpr int kRows = 4; // a matrix is read as an array of its rows, hpoints (ri/declare.cpp)

} // namespace

void Blobby::takePlacedPoints() {
    for (size_t i = 0; i < primvars_.size(); ++i) {
        PrimVar& v = primvars_[i];
        const bool vertex = v.cls == Class::Vertex || v.cls == Class::Varying;
        if (!vertex || v.type != scene::Type::HPoint || v.arrayLength < kRows || v.arrayLength % kRows) continue;
        const size_t each = size_t(v.arrayLength / kRows), count = size_t(leaves_) * each;
        PlacedPoints all{i, std::vector<Matrix>(count)};
        std::vector<float> origins(3 * count); // images of the blobs' origins: the plain blend of the variable
        for (size_t k = 0; k < count; ++k) {
            Matrix& m = all.maps[k] = matrixFrom(&v.cameraValues[16 * k]);
            for (int c = 0; c < 3; ++c) origins[3 * k + size_t(c)] = m.m[3][3] != 0 ? float(m.m[3][c] / m.m[3][3]) : 0;
        }
        for (const BlobLeaf& l : field_.leaves()) {
            if (l.kind == BlobLeaf::Kind::Ground || l.number >= size_t(leaves_)) continue;
            bool singular = false;
            const Matrix back = inverse(matrixFrom(&source_.primitive->numbers[l.at + (l.bySegment ? 7 : 0)]), &singular);
            for (size_t e = 0; e < each && !singular; ++e) all.maps[l.number * each + e] = back * all.maps[l.number * each + e];
        }
        v.type = scene::Type::Point;
        v.arrayLength = each == 1 ? 0 : int(each);
        v.cameraValues = std::move(origins);
        placed_.push_back(std::move(all));
    }
}

void Blobby::interpolateVariable(const PrimVar& v, const SurfacePoint& at, float* out, float* du, float* dv) const {
    const size_t number = size_t(&v - primvars_.data()); // or the normal, which is not among them
    const auto is = [&](const PlacedPoints& p) { return &v != &normal_ && p.var == number; };
    const auto found = std::find_if(placed_.begin(), placed_.end(), is);
    if (found == placed_.end()) return KeyedShape::interpolateVariable(v, at, out, du, dv);
    double way;
    const size_t k = keyAt(at.time, way), which = size_t(found - placed_.begin());
    const auto of = [&](size_t n) -> const PlacedPoints& { return static_cast<const Blobby&>(key(n)).placed_[which]; };
    placePoint(of(k), at, out, du, dv);
    if (way == 0 || k + 1 >= keys()) return;
    const size_t n = size_t(v.outWidth());
    std::vector<float> later(3 * n);
    placePoint(of(k + 1), at, &later[0], &later[n], &later[2 * n]);
    float* const to[3] = {out, du, dv};
    for (size_t j = 0; j < 3; ++j)
        for (size_t i = 0; to[j] && i < n; ++i) to[j][i] = float(to[j][i] * (1 - way) + later[j * n + i] * way);
}

void Blobby::placePoint(const PlacedPoints& points, const SurfacePoint& at, float* out, float* du, float* dv) const {
    std::vector<Weight> w(size_t(std::max(mostWeights_, 16)));
    const int n = weights(Class::Vertex, at, w.data());
    const Vec3d p = transformPoint(toObject_, Vec3d(at.P));
    const Vec3d pu = transformVector(toObject_, Vec3d(at.dPdu)), pv = transformVector(toObject_, Vec3d(at.dPdv));
    const size_t each = leaves_ > 0 ? points.maps.size() / size_t(leaves_) : 0;
    for (size_t e = 0; e < each; ++e) {
        double f[4] = {}, fu[4] = {}, fv[4] = {}, here[4], u[4], v[4];
        for (int i = 0; i < n; ++i) {
            const Weight& s = w[size_t(i)];
            const Matrix& m = points.maps[s.index * each + e];
            times(m, p, 1, here);
            times(m, pu, 0, u);
            times(m, pv, 0, v);
            for (int k = 0; k < 4; ++k) {
                f[k] += s.w * here[k];
                fu[k] += s.w * u[k] + s.du * here[k];
                fv[k] += s.w * v[k] + s.dv * here[k];
            }
        }
        const double inv = f[3] != 0 ? 1 / f[3] : 0;
        for (size_t c = 0; c < 3; ++c) {
            const double q = f[c] * inv;
            out[3 * e + c] = float(q);
            if (du) du[3 * e + c] = float((fu[c] - q * fu[3]) * inv);
            if (dv) dv[3 * e + c] = float((fv[c] - q * fv[3]) * inv);
        }
    }
}

} // namespace alpenglow::geometry

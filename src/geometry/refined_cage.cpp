#include "geometry/refined_cage.h"
#include "geometry/osd_cage.h"
#include "geometry/welding.h"
#include <opensubdiv/far/primvarRefiner.h>
#include <unordered_map>

namespace alpenglow::geometry {

using scene::Class;

namespace {

namespace Osd = OpenSubdiv;

/// One number of a value, as PrimvarRefiner sums it.
struct Number {
    double x = 0;
    void Clear() { x = 0; }
    void AddWithWeight(const Number& n, double w) { x += w * n.x; }
};
using Numbers = std::vector<Number>;

/// (u, v) of the vertices that a face's children have, in the face.
std::unordered_map<int, Vec2> places(const Osd::Far::TopologyLevel& base, int f, int part, bool triangles) {
    static constexpr float u4[4] = {0, 1, 1, 0}, v4[4] = {0, 0, 1, 1}, u3[3] = {0, 1, 0}, v3[3] = {0, 0, 1};
    const auto corners = base.GetFaceVertices(f), edges = base.GetFaceEdges(f);
    const int n = corners.size();
    std::unordered_map<int, Vec2> at;
    if (!triangles && n != 4) { // a piece with its own square
        at[base.GetVertexChildVertex(corners[part])] = {0, 0};
        at[base.GetEdgeChildVertex(edges[part])] = {1, 0};
        at[base.GetFaceChildVertex(f)] = {1, 1};
        at[base.GetEdgeChildVertex(edges[(part + n - 1) % n])] = {0, 1};
        return at;
    }
    const float *u = triangles ? u3 : u4, *v = triangles ? v3 : v4;
    for (int k = 0; k < n; ++k) {
        at[base.GetVertexChildVertex(corners[k])] = {u[k], v[k]};
        at[base.GetEdgeChildVertex(edges[k])] = {(u[k] + u[(k + 1) % n]) / 2, (v[k] + v[(k + 1) % n]) / 2};
    }
    if (!triangles) at[base.GetFaceChildVertex(f)] = {0.5f, 0.5f};
    return at;
}

/// Linear values of the corners of a face's children.
void cornerValues(const Osd::Far::TopologyLevel& base, int f, std::span<const int> child, const double* at, size_t width,
                  std::vector<double>& out) {
    const auto corners = base.GetFaceVertices(f), edges = base.GetFaceEdges(f);
    const int n = corners.size();
    out.assign(child.size() * width, 0);
    for (size_t c = 0; c < child.size(); ++c)
        for (size_t x = 0; x < width; ++x) {
            double& v = out[c * width + x];
            bool found = false;
            for (int k = 0; k < n && !found; ++k) {
                const double a = at[size_t(k) * width + x], b = at[size_t((k + 1) % n) * width + x];
                if ((found = child[c] == base.GetVertexChildVertex(corners[k]))) v = a;
                else if ((found = child[c] == base.GetEdgeChildVertex(edges[k]))) v = (a + b) / 2;
            }
            for (int k = 0; k < n && !found; ++k) v += at[size_t(k) * width + x] / n;
        }
}

/// The values of the finer level.
void refineValues(const RefinedCage& cage, const Osd::Far::TopologyRefiner& refiner,
                  const std::vector<LimitSurface::Channel>& channels, const std::vector<int>& channelOf,
                  std::vector<scene::Param>& out) {
    const auto &base = refiner.GetLevel(0), &fine = refiner.GetLevel(1);
    const Osd::Far::PrimvarRefiner primvars(refiner);
    const std::vector<int>&corners = cage.corners, &vertex = cage.vertex;
    const std::vector<scene::Param>& values = cage.values;
    std::vector<size_t> first(corners.size() + 1, 0);
    for (size_t f = 0; f < corners.size(); ++f) first[f + 1] = first[f] + size_t(corners[f]);
    for (size_t k = 0; k < values.size(); ++k) {
        scene::Param p = values[k];
        const Class c = p.cls;
        const size_t per = c == Class::Uniform                                 ? corners.size()
                           : c == Class::FaceVarying || c == Class::FaceVertex ? vertex.size()
                                                                               : size_t(cage.cage.vertices);
        const size_t width = per ? p.numbers.size() / per : 0;
        if (c == Class::Uniform) {
            scene::Param q = p;
            q.numbers.clear();
            for (int f = 0; f < fine.GetNumFaces(); ++f) {
                const auto from = p.numbers.begin() + ptrdiff_t(size_t(fine.GetFaceParentFace(f)) * width);
                q.numbers.insert(q.numbers.end(), from, from + ptrdiff_t(width));
            }
            p = std::move(q);
        } else if (c == Class::Vertex || c == Class::Varying) {
            std::vector<float> fresh(width * size_t(fine.GetNumVertices()));
            Numbers from(per), to(size_t(fine.GetNumVertices()));
            for (size_t x = 0; x < width; ++x) {
                for (size_t i = 0; i < per; ++i) from[i].x = p.numbers[i * width + x];
                if (c == Class::Vertex) primvars.Interpolate(1, from, to);
                else primvars.InterpolateVarying(1, from, to);
                for (size_t i = 0; i < to.size(); ++i) fresh[i * width + x] = float(to[i].x);
            }
            p.numbers = std::move(fresh);
        } else if (channelOf[k] >= 0) {
            const int channel = channelOf[k];
            std::vector<float> fresh(width * size_t(fine.GetNumFaceVertices()));
            Numbers from(size_t(base.GetNumFVarValues(channel))), to(size_t(fine.GetNumFVarValues(channel)));
            for (size_t x = 0; x < width; ++x) {
                for (size_t i = 0; i < vertex.size(); ++i)
                    from[size_t(channels[size_t(channel)][i])].x = p.numbers[i * width + x];
                primvars.InterpolateFaceVarying(1, from, to, channel);
                size_t at = 0;
                for (int f = 0; f < fine.GetNumFaces(); ++f) {
                    const auto index = fine.GetFaceFVarValues(f, channel);
                    for (int i = 0; i < index.size(); ++i, ++at) fresh[at * width + x] = float(to[size_t(index[i])].x);
                }
            }
            p.numbers = std::move(fresh);
        } else {
            std::vector<double> from, to;
            scene::Param q = p;
            q.numbers.clear();
            for (int f = 0; f < fine.GetNumFaces(); ++f) {
                const size_t parent = size_t(fine.GetFaceParentFace(f));
                const auto begin = p.numbers.begin() + ptrdiff_t(first[parent] * width);
                from.assign(begin, begin + ptrdiff_t(size_t(corners[parent]) * width));
                const auto v = fine.GetFaceVertices(f);
                cornerValues(base, int(parent), std::span<const int>(&v[0], size_t(v.size())), from.data(), width, to);
                for (double x : to) q.numbers.push_back(float(x));
            }
            p = std::move(q);
        }
        out.push_back(std::move(p));
    }
}

} // namespace

bool RefinedCage::refine() {
    std::vector<LimitSurface::Channel> channels;
    std::vector<int> channelOf(values.size(), -1);
    for (size_t k = 0; k < values.size(); ++k)
        if (smooth[k]) {
            channelOf[k] = int(channels.size());
            const size_t width = values[k].numbers.size() / std::max<size_t>(1, vertex.size());
            channels.push_back(
                weld(vertex, cage.vertices, [&](size_t c) { return values[k].numbers.data() + c * width; }, width));
        }
    const std::unique_ptr<Osd::Far::TopologyRefiner> refiner = makeRefiner(cage, channels);
    if (!refiner) return false;
    Osd::Far::TopologyRefiner::UniformOptions once(1);
    once.fullTopologyInLastLevel = true;
    refiner->RefineUniform(once);
    const auto &base = refiner->GetLevel(0), &fine = refiner->GetLevel(1);
    const bool triangles = cage.scheme == SubdivisionScheme::Loop;
    RefinedCage r;
    r.cage = cage;
    r.cage.vertices = fine.GetNumVertices();
    r.cage.creaseEnds.clear();
    r.cage.creaseSharpness.clear();
    r.cage.cornerVertex.clear();
    r.cage.cornerSharpness.clear();
    r.cage.holes.clear();
    r.children.resize(corners.size());
    for (int f = 0; f < fine.GetNumFaces(); ++f) {
        const auto v = fine.GetFaceVertices(f);
        const int parent = fine.GetFaceParentFace(f);
        r.corners.push_back(v.size());
        r.vertex.insert(r.vertex.end(), &v[0], &v[0] + v.size());
        auto& siblings = r.children[size_t(parent)];
        const auto at = places(base, parent, int(siblings.size()), triangles);
        siblings.push_back(f);
        const size_t p = size_t(parent);
        const auto there = [&](int w) {
            const Vec2 q = at.at(w);
            return Vec2{origin[p].x + along[p].x * q.x + across[p].x * q.y, origin[p].y + along[p].y * q.x + across[p].y * q.y};
        };
        const Vec2 o = there(v[0]), a = there(v[1]), b = there(v[v.size() - 1]);
        r.origin.push_back(o);
        r.along.push_back({a.x - o.x, a.y - o.y});
        r.across.push_back({b.x - o.x, b.y - o.y});
        if (base.IsFaceHole(parent)) r.cage.holes.push_back(f);
    }
    for (int e = 0; e < fine.GetNumEdges(); ++e)
        if (fine.GetEdgeSharpness(e) > 0 && !fine.IsEdgeBoundary(e)) {
            const auto v = fine.GetEdgeVertices(e);
            r.cage.creaseEnds.insert(r.cage.creaseEnds.end(), {v[0], v[1]});
            r.cage.creaseSharpness.push_back(fine.GetEdgeSharpness(e));
        }
    for (int v = 0; v < fine.GetNumVertices(); ++v)
        if (fine.GetVertexSharpness(v) > 0) {
            r.cage.cornerVertex.push_back(v);
            r.cage.cornerSharpness.push_back(fine.GetVertexSharpness(v));
        }
    refineValues(*this, *refiner, channels, channelOf, r.values);
    r.smooth = smooth;
    *this = std::move(r);
    look();
    return true;
}

} // namespace alpenglow::geometry

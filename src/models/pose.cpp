#include "models/pose.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::models {

namespace {

/// Rows of base/matrix.h: p' = p M, so a column of the usual matrix of a quaternion is a row here.
Matrix placeOf(const double (&t)[3], const double (&r)[4], const double (&s)[3]) {
    const double n = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    const double f = n > 0 ? 1 / n : 0, x = r[0] * f, y = r[1] * f, z = r[2] * f, w = n > 0 ? r[3] * f : 1;
    Matrix m;
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
                               {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
                               {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) m.m[i][k] = s[i] * rows[i][k];
        m.m[3][i] = t[i];
    }
    return m;
}

/// Quaternions on the shorter way along the sphere.
void slerp(const double* a, const double* b, double u, double* out) {
    double c = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double sign = c < 0 ? -1 : 1;
    c *= sign;
    double wa = 1 - u, wb = u;
    if (c < 0.9999995) {
        const double angle = std::acos(std::min(c, 1.0)), s = std::sin(angle);
        wa = std::sin((1 - u) * angle) / s;
        wb = std::sin(u * angle) / s;
    }
    for (int k = 0; k < 4; ++k) out[k] = wa * a[k] + sign * wb * b[k];
}

/// The numbers of a channel at a time.
std::vector<double> valuesAt(const Channel& c, double time) {
    const bool cubic = c.interpolation == Interpolation::Cubic;
    const size_t keys = c.times.size(), width = c.values.size() / keys / (cubic ? 3 : 1);
    const auto value = [&](size_t key, size_t part, size_t k) { // part: 0 tangent in, 1 value, 2 tangent out
        return double(cubic ? c.values[(key * 3 + part) * width + k] : c.values[key * width + k]);
    };
    const size_t after = size_t(std::upper_bound(c.times.begin(), c.times.end(), float(time)) - c.times.begin());
    const size_t a = after == 0 ? 0 : after - 1, b = std::min(after, keys - 1);
    std::vector<double> out(width);
    const double t0 = c.times[a], t1 = c.times[b], step = t1 - t0;
    const bool still = a == b || after == 0 || !(step > 0) || c.interpolation == Interpolation::Step;
    const double u = still ? 0 : std::clamp((time - t0) / step, 0.0, 1.0), u2 = u * u, u3 = u2 * u;
    for (size_t k = 0; k < width; ++k) {
        if (still) out[k] = value(a, 1, k);
        else if (cubic)
            out[k] = (2 * u3 - 3 * u2 + 1) * value(a, 1, k) + step * (u3 - 2 * u2 + u) * value(a, 2, k) +
                     (3 * u2 - 2 * u3) * value(b, 1, k) + step * (u3 - u2) * value(b, 0, k);
        else out[k] = (1 - u) * value(a, 1, k) + u * value(b, 1, k);
    }
    if (c.path == Path::Rotation && width == 4 && !still && !cubic) {
        double from[4], to[4];
        for (size_t k = 0; k < 4; ++k) from[k] = value(a, 1, k), to[k] = value(b, 1, k);
        slerp(from, to, u, out.data());
    }
    return out;
}

Matrix localOf(const Node& n) { return n.hasMatrix ? n.matrix : placeOf(n.translation, n.rotation, n.scale); }

/// The weights that count for a mesh of a node, as many as a part has targets.
double weightOf(const Pose& pose, int node, const Mesh& mesh, size_t target) {
    const std::vector<double>& own = pose.weights[size_t(node)];
    const std::vector<double>& w = own.empty() ? mesh.weights : own;
    return target < w.size() ? w[target] : 0;
}

void morph(const Pose& pose, int node, const Mesh& mesh, const Part& part, Shape& s) {
    for (size_t t = 0; t < part.targets.size(); ++t) {
        const float w = float(weightOf(pose, node, mesh, t));
        if (w == 0) continue;
        const MorphTarget& target = part.targets[t];
        for (size_t i = 0; i < target.P.size() && i < s.P.size(); ++i) s.P[i] += w * target.P[i];
        for (size_t i = 0; i < target.N.size() && i < s.N.size(); ++i) s.N[i] += w * target.N[i];
    }
}

void skin(const Model& m, const Pose& pose, const Skin& sk, const Matrix& place, const Part& part, Shape& s) {
    std::vector<Matrix> moves(sk.joints.size());
    for (size_t j = 0; j < moves.size(); ++j)
        if (sk.joints[j] != kNone && size_t(sk.joints[j]) < m.nodes.size())
            moves[j] = sk.bindings[j] * pose.world[size_t(sk.joints[j])];
    const size_t width = size_t(part.influences);
    for (size_t v = 0; v < part.vertices(); ++v) {
        Matrix sum;
        for (auto& row : sum.m)
            for (double& x : row) x = 0;
        double total = 0;
        for (size_t i = 0; i < width; ++i) {
            const int32_t j = part.joints[v * width + i];
            const double w = part.weights[v * width + i];
            if (w == 0 || j < 0 || size_t(j) >= moves.size()) continue;
            total += w;
            for (int r = 0; r < 4; ++r)
                for (int c = 0; c < 4; ++c) sum.m[r][c] += w * moves[size_t(j)].m[r][c];
        }
        if (total == 0) sum = place, total = 1; // no joint holds it: it stays with the node
        for (auto& row : sum.m)
            for (double& x : row) x /= total;
        const float* p = &s.P[v * 3];
        const Vec3d q = transformPoint(sum, Vec3d(p[0], p[1], p[2]));
        for (int k = 0; k < 3; ++k) s.P[v * 3 + size_t(k)] = float(q[k]);
        if (s.N.empty()) continue;
        const float* n = &s.N[v * 3];
        const Vec3d before(n[0], n[1], n[2]);
        const Vec3d turned = normalizeOr(transformNormal(sum, before), before);
        for (int k = 0; k < 3; ++k) s.N[v * 3 + size_t(k)] = float(turned[k]);
    }
}

} // namespace

Pose poseAt(const Model& m, int animation, double time) {
    std::vector<Node> nodes;
    nodes.reserve(m.nodes.size());
    for (const Node& n : m.nodes) { // what moves, without what hangs on it
        Node& to = nodes.emplace_back();
        to.parent = n.parent, to.hasMatrix = n.hasMatrix, to.matrix = n.matrix, to.weights = n.weights;
        std::copy(std::begin(n.translation), std::end(n.translation), to.translation);
        std::copy(std::begin(n.rotation), std::end(n.rotation), to.rotation);
        std::copy(std::begin(n.scale), std::end(n.scale), to.scale);
    }
    if (animation >= 0 && size_t(animation) < m.animations.size())
        for (const Channel& c : m.animations[size_t(animation)].channels) {
            Node& n = nodes[size_t(c.node)];
            const std::vector<double> v = valuesAt(c, time);
            if (c.path == Path::Weights) n.weights = v;
            else n.hasMatrix = false;
            double* to = c.path == Path::Translation ? n.translation : c.path == Path::Scale ? n.scale : n.rotation;
            if (c.path != Path::Weights) std::copy(v.begin(), v.end(), to);
        }
    Pose pose;
    pose.world.resize(nodes.size());
    std::vector<uint8_t> known(nodes.size(), 0);
    for (size_t i = 0; i < nodes.size(); ++i) {
        std::vector<size_t> way;
        for (size_t at = i; !known[at];) {
            way.push_back(at);
            if (nodes[at].parent == kNone) break;
            at = size_t(nodes[at].parent);
        }
        for (size_t k = way.size(); k-- > 0;) {
            const Node& n = nodes[way[k]];
            pose.world[way[k]] = n.parent == kNone ? localOf(n) : localOf(n) * pose.world[size_t(n.parent)];
            known[way[k]] = 1;
        }
        pose.weights.push_back(nodes[i].weights);
    }
    return pose;
}

double lastKey(const Animation& a) {
    double last = 0;
    for (const Channel& c : a.channels)
        if (!c.times.empty()) last = std::max(last, double(c.times.back()));
    return last;
}

int skinOf(const Node& node, const Mesh& mesh, const Part& part) {
    return part.influences == 0 ? kNone : node.skin != kNone ? node.skin : mesh.skin;
}

bool deforms(const Node& node, const Mesh& mesh, const Part& part) {
    return !part.targets.empty() || skinOf(node, mesh, part) != kNone;
}

Shape shapeAt(const Model& m, const Pose& pose, int node, const Mesh& mesh, const Part& part) {
    Shape s{part.P, part.N};
    morph(pose, node, mesh, part, s);
    if (const int k = skinOf(m.nodes[size_t(node)], mesh, part); k != kNone)
        skin(m, pose, m.skins[size_t(k)], pose.world[size_t(node)], part, s);
    return s;
}

} // namespace alpenglow::models

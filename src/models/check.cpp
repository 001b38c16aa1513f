#include "models/check.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <span>

namespace alpenglow::models {

namespace {

class Checker {
public:
    explicit Checker(Model& m) : m_(m) {}
    void all();

private:
    void error(std::string text) {
        if (reported_.insert(text).second) m_.notes.push_back({true, std::move(text)});
    }
    void index(int32_t& i, size_t size, const char* what) {
        if (i != kNone && (i < 0 || size_t(i) >= size)) {
            error(fmt::format("a {} is named that is not there; it is left out", what));
            i = kNone;
        }
    }
    void indices(std::vector<int32_t>& all, size_t size, const char* what) {
        for (int32_t& i : all) index(i, size, what);
        std::erase(all, kNone);
    }
    template <class T> void numbers(std::span<T> all, const char* what, T otherwise = 0) {
        for (T& x : all)
            if (!std::isfinite(x)) {
                error(fmt::format("a number of {} is not finite; {} is taken", what, otherwise));
                x = otherwise;
            }
    }
    void texture(Texture&);
    void material(Material&);
    void part(const std::string& mesh, Part&);
    void vertexArray(const std::string& mesh, std::vector<float>&, size_t wanted, const char* what);
    void faces(const std::string& mesh, Part&);
    void node(Node&);
    void trees();
    void channel(Channel&);
    void lightsAndCameras();

    Model& m_;
    std::set<std::string> reported_;
};

void Checker::texture(Texture& t) {
    index(t.image, m_.images.size(), "picture");
    if (t.s > Wrap::Mirror) t.s = Wrap::Repeat;
    if (t.t > Wrap::Mirror) t.t = Wrap::Repeat;
    if (t.set < 0) t.set = 0;
    numbers<double>(t.scale, "a texture's scale", 1);
    numbers<double>(t.offset, "a texture's offset");
    numbers<double>({&t.rotation, 1}, "a texture's rotation");
}

void Checker::material(Material& x) {
    if (x.alphaMode > AlphaMode::Blend) x.alphaMode = AlphaMode::Opaque;
    for (Texture* t : {&x.baseColorMap, &x.metalRoughMap, &x.normalMap, &x.emissionMap, &x.coatMap, &x.coatRoughnessMap,
                       &x.transmissionMap, &x.specularMap, &x.specularColorMap, &x.sheenColorMap, &x.sheenRoughnessMap})
        texture(*t);
    const std::string of = fmt::format("material \"{}\"", x.name);
    for (double* c : {x.emission, x.specularColor, x.attenuationColor, x.sheenColor}) numbers<double>({c, 3}, of.c_str());
    numbers<double>(x.baseColor, of.c_str(), 1);
    for (double* v : {&x.alphaCutoff, &x.metalness, &x.roughness, &x.normalScale, &x.specular, &x.coat, &x.coatRoughness,
                      &x.transmission, &x.thickness, &x.attenuationDistance, &x.sheenRoughness})
        numbers<double>({v, 1}, of.c_str());
    numbers<double>({&x.ior, 1}, of.c_str(), 1.5);
    for (double* v : {&x.metalness, &x.roughness, &x.coat, &x.coatRoughness, &x.transmission, &x.sheenRoughness, &x.baseColor[3]})
        *v = std::clamp(*v, 0.0, 1.0);
    for (double* c : {x.baseColor, x.emission, x.specularColor, x.sheenColor, x.attenuationColor})
        for (int k = 0; k < 3; ++k) c[k] = std::max(c[k], 0.0);
    if (x.ior < 1) x.ior = x.ior == 0 ? 1000 : 1; // 0: KHR_materials_ior's mirror
}

void Checker::vertexArray(const std::string& mesh, std::vector<float>& x, size_t wanted, const char* what) {
    if (x.empty() || x.size() == wanted) return;
    error(fmt::format("mesh \"{}\": {} numbers of {} where {} are needed; they are left out", mesh, x.size(), what, wanted));
    x.clear();
}

/// Leaves out faces that use vertices that are not there, or not finite.
void Checker::faces(const std::string& mesh, Part& p) {
    const size_t n = p.vertices();
    if (p.kind == PartKind::Polygons && p.counts.empty()) p.counts.assign(p.corners.size() / 3, 3);
    const size_t least = p.kind == PartKind::Polygons ? 3 : 2;
    std::vector<int32_t> counts, corners;
    size_t at = 0, lost = 0;
    for (const int32_t c : p.counts) {
        if (c < 0 || size_t(c) > p.corners.size() - at) {
            ++lost;
            break;
        }
        bool good = size_t(c) >= least;
        for (size_t i = at; i < at + size_t(c); ++i) {
            const int32_t v = p.corners[i];
            good = good && v >= 0 && size_t(v) < n;
            for (size_t k = 0; good && k < 3; ++k) good = std::isfinite(p.P[size_t(v) * 3 + k]);
        }
        if (good) {
            counts.push_back(c);
            corners.insert(corners.end(), p.corners.begin() + std::ptrdiff_t(at), p.corners.begin() + std::ptrdiff_t(at) + c);
        } else {
            ++lost;
        }
        at += size_t(c);
    }
    if (lost)
        error(fmt::format("mesh \"{}\": {} faces or lines use vertices that are not there or not finite, or have too few; they "
                          "are left out",
                          mesh, lost));
    p.counts = std::move(counts);
    p.corners = std::move(corners);
    for (float& x : p.P)
        if (!std::isfinite(x)) x = 0; // nobody uses them
}

void Checker::part(const std::string& mesh, Part& p) {
    if (p.kind > PartKind::Lines) p.kind = PartKind::Polygons;
    index(p.material, m_.materials.size(), "material");
    p.P.resize(p.P.size() / 3 * 3);
    const size_t n = p.vertices();
    vertexArray(mesh, p.N, 3 * n, "normals");
    vertexArray(mesh, p.color, 4 * n, "colours");
    for (auto& st : p.st) vertexArray(mesh, st, 2 * n, "texture coordinates");
    if (p.kind == PartKind::Points) {
        std::erase_if(p.corners, [&](int32_t v) { return v < 0 || size_t(v) >= n; });
        if (p.corners.empty())
            for (size_t i = 0; i < n; ++i) p.corners.push_back(int32_t(i));
        std::erase_if(p.corners, [&](int32_t v) {
            const float* at = &p.P[size_t(v) * 3];
            return !std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2]);
        });
        p.counts.clear();
    } else {
        faces(mesh, p);
    }
    numbers<float>(p.N, "normals");
    numbers<float>(p.color, "colours", 1);
    for (auto& st : p.st) numbers<float>(st, "texture coordinates");
    if (p.influences < 0 || p.joints.size() != p.weights.size() || p.joints.size() != n * size_t(std::max(0, p.influences))) {
        error(fmt::format("mesh \"{}\": its joints and weights do not belong together; they are left out", mesh));
        p.joints.clear();
        p.weights.clear();
        p.influences = 0;
    }
    numbers<float>(p.weights, "weights");
    for (MorphTarget& t : p.targets) {
        vertexArray(mesh, t.P, 3 * n, "a morph target");
        vertexArray(mesh, t.N, 3 * n, "a morph target's normals");
        numbers<float>(t.P, "a morph target");
        numbers<float>(t.N, "a morph target");
    }
}

void Checker::node(Node& x) {
    index(x.parent, m_.nodes.size(), "parent node");
    indices(x.meshes, m_.meshes.size(), "mesh");
    index(x.skin, m_.skins.size(), "skin");
    index(x.camera, m_.cameras.size(), "camera");
    index(x.light, m_.lights.size(), "light");
    numbers<double>(x.weights, "weights");
    numbers<double>(x.translation, "a translation");
    numbers<double>(x.rotation, "a rotation");
    numbers<double>(x.scale, "a scale", 1);
    bool finite = true;
    for (auto& row : x.matrix.m)
        for (const double v : row) finite = finite && std::isfinite(v);
    const double(&r)[4] = x.rotation;
    if (!(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] > 0)) x.rotation[3] = 1;
    if (finite) return;
    error("the matrix of a node is not finite; the node stays at its parent's place");
    x.matrix = {};
}

/// Cuts circles of parents.
void Checker::trees() {
    std::vector<uint8_t> state(m_.nodes.size(), 0); // 1: on the way, 2: good
    for (size_t i = 0; i < m_.nodes.size(); ++i) {
        std::vector<size_t> way;
        for (size_t at = i; state[at] == 0;) {
            state[at] = 1;
            way.push_back(at);
            const int32_t up = m_.nodes[at].parent;
            if (up == kNone) break;
            if (state[size_t(up)] == 1) {
                error("nodes are below each other in a circle; it is cut");
                m_.nodes[at].parent = kNone;
                break;
            }
            at = size_t(up);
        }
        for (const size_t w : way) state[w] = 2;
    }
}

void Checker::channel(Channel& c) {
    index(c.node, m_.nodes.size(), "node");
    if (c.path > Path::Weights) c.path = Path::Weights;
    if (c.interpolation > Interpolation::Cubic) c.interpolation = Interpolation::Linear;
    const size_t keys = c.times.size(), parts = c.interpolation == Interpolation::Cubic ? 3 : 1;
    bool good = keys > 0 && c.values.size() % (keys * parts) == 0 && !c.values.empty();
    if (good && c.path != Path::Weights) good = c.values.size() / (keys * parts) == (c.path == Path::Rotation ? 4u : 3u);
    for (size_t i = 0; good && i < keys; ++i) good = std::isfinite(c.times[i]) && (i == 0 || c.times[i] >= c.times[i - 1]);
    for (const float v : c.values) good = good && std::isfinite(v);
    if (good) return;
    error("a channel of an animation has times that do not grow, or values that are too few or not finite; it is left out");
    c.node = kNone;
}

void Checker::lightsAndCameras() {
    for (Light& l : m_.lights) {
        if (l.kind > LightKind::Sun) l.kind = LightKind::Point;
        numbers<double>(l.color, "a light", 1);
        numbers<double>({&l.intensity, 1}, "a light", 1);
        numbers<double>({&l.inner, 1}, "a light");
        numbers<double>({&l.outer, 1}, "a light", kPi / 4);
        l.outer = std::clamp(l.outer, 1e-4, kPi / 2);
        l.inner = std::clamp(l.inner, 0.0, l.outer);
    }
    for (Camera& c : m_.cameras) {
        numbers<double>({&c.aspect, 1}, "a camera");
        if (!(c.yfov > 1e-4 && c.yfov < 3.1)) {
            error(fmt::format("camera \"{}\" has no possible field of view; 0.8 radians are taken", c.name));
            c.yfov = 0.8;
        }
        if (!(c.halfHeight > 0 && std::isfinite(c.halfHeight))) c.halfHeight = 1;
        if (!(c.near > 0 && std::isfinite(c.near))) c.near = 0;
        if (!(c.far > c.near && std::isfinite(c.far))) c.far = 0;
        if (!(c.aspect > 0)) c.aspect = 0;
    }
}

void Checker::all() {
    for (Material& x : m_.materials) material(x);
    for (Mesh& x : m_.meshes) {
        index(x.skin, m_.skins.size(), "skin");
        numbers<double>(x.weights, "weights");
        for (Part& p : x.parts) part(x.name, p);
        std::erase_if(x.parts, [](const Part& p) { return p.corners.empty(); });
    }
    for (Node& x : m_.nodes) node(x);
    trees();
    for (Skin& x : m_.skins) {
        for (int32_t& j : x.joints) index(j, m_.nodes.size(), "joint");
        x.bindings.resize(x.joints.size());
        for (Matrix& b : x.bindings)
            for (auto& row : b.m) numbers<double>(row, "a skin");
    }
    lightsAndCameras();
    indices(m_.roots, m_.nodes.size(), "node");
    for (Animation& a : m_.animations) {
        for (Channel& c : a.channels) channel(c);
        std::erase_if(a.channels, [](const Channel& c) { return c.node == kNone; });
    }
}

} // namespace

void check(Model& m) { Checker(m).all(); }

std::vector<int> drawnNodes(const Model& m) {
    std::vector<std::vector<int>> below(m.nodes.size());
    for (size_t i = 0; i < m.nodes.size(); ++i)
        if (m.nodes[i].parent != kNone) below[size_t(m.nodes[i].parent)].push_back(int(i));
    std::vector<int> out;
    std::vector<uint8_t> seen(m.nodes.size(), 0);
    const auto add = [&](int i) {
        if (!seen[size_t(i)]) out.push_back(i);
        seen[size_t(i)] = 1;
    };
    for (const int r : m.roots) add(r);
    for (size_t k = 0; k < out.size(); ++k)
        for (const int c : below[size_t(out[k])]) add(c);
    return out;
}

} // namespace alpenglow::models

#include "models/rib.h"
#include "models/check.h"
#include "models/pose.h"
#include "models/ribparts.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

namespace alpenglow::models {

std::string matrixText(const Matrix& m) {
    std::string t = "[";
    for (const auto& row : m.m)
        for (const double v : row) t += fmt::format("{} ", v == 0 ? 0.0 : v); // no -0
    t.back() = ']';
    return t;
}

namespace {

/// What a node looks through or shines with: its place without its scale, which neither has.
Matrix withoutScale(Matrix m) {
    for (int i = 0; i < 3; ++i) {
        const Vec3d row = normalizeOr(Vec3d(m.m[i][0], m.m[i][1], m.m[i][2]), Vec3d(i == 0, i == 1, i == 2));
        for (int k = 0; k < 3; ++k) m.m[i][k] = row[k];
    }
    return m;
}

class Writer {
public:
    Writer(const Model& m, const RibOptions& o, const MapMaker& maps, const std::function<void(std::string_view)>& out,
           const std::function<void(std::string)>& note)
        : m_(m), o_(o), maps_(maps), out_(out), tell_(note), drawn_(drawnNodes(m)) {
        const int animation = m.animations.empty() ? kNone : o.animation;
        poses_.push_back(poseAt(m, animation, o.time));
        if (animation != kNone && o.shutter > 0) poses_.push_back(poseAt(m, animation, o.time + o.shutter));
    }
    void all();

private:
    void note(std::string text) {
        if (noted_.insert(text).second) tell_(std::move(text));
    }
    /// A transformation that may move while the shutter is open.
    std::string placed(const std::vector<Matrix>&) const;
    std::vector<Matrix> places(int node) const;
    void camera();
    void cameraOf(int node);
    void ownCamera();
    void lights();
    std::string light(const Light&) const;
    void objects();
    void node(int);
    const std::string& material(int);
    void box(Vec3d& lo, Vec3d& hi) const;

    const Model& m_;
    const RibOptions& o_;
    const MapMaker& maps_;
    const std::function<void(std::string_view)>& out_;
    const std::function<void(std::string)>& tell_;
    std::vector<int> drawn_;
    std::vector<Pose> poses_;
    std::map<std::pair<int, size_t>, int> handles_; ///< of parts of meshes that are drawn more than once
    std::map<int, std::string> materials_;
    std::set<std::string> noted_;
};

std::vector<Matrix> Writer::places(int node) const {
    std::vector<Matrix> all;
    for (const Pose& p : poses_) all.push_back(p.world[size_t(node)]);
    return all;
}

std::string Writer::placed(const std::vector<Matrix>& all) const {
    if (all.size() < 2 || all[0] == all[1]) return all[0] == Matrix() ? "" : "ConcatTransform " + matrixText(all[0]) + "\n";
    return "MotionBegin [0 1]\nConcatTransform " + matrixText(all[0]) + "\nConcatTransform " + matrixText(all[1]) +
           "\nMotionEnd\n";
}

void Writer::box(Vec3d& lo, Vec3d& hi) const {
    lo = Vec3d(INFINITY), hi = Vec3d(-INFINITY);
    for (const int n : drawn_)
        for (const int mesh : m_.nodes[size_t(n)].meshes)
            for (const Part& p : m_.meshes[size_t(mesh)].parts) {
                const Mesh& of = m_.meshes[size_t(mesh)];
                const bool skinned = skinOf(m_.nodes[size_t(n)], of, p) != kNone;
                const bool own = deforms(m_.nodes[size_t(n)], of, p);
                const Shape s = own ? shapeAt(m_, poses_[0], n, of, p) : Shape{};
                const std::vector<float>& P = own ? s.P : p.P;
                for (const int32_t v : p.corners) {
                    Vec3d q(P[size_t(v) * 3], P[size_t(v) * 3 + 1], P[size_t(v) * 3 + 2]);
                    if (!skinned) q = transformPoint(poses_[0].world[size_t(n)], q);
                    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], q[k]), hi[k] = std::max(hi[k], q[k]);
                }
            }
    if (!(lo.x <= hi.x)) lo = Vec3d(-1.0), hi = Vec3d(1.0);
}

/// All of it from its front (+z), a little above and to one side, as cli/modelscene.cpp shows .ply.
void Writer::ownCamera() {
    Vec3d lo, hi;
    box(lo, hi);
    const Vec3d middle = (lo + hi) * 0.5;
    double radius = 0.5 * length(hi - lo);
    if (!(radius > 0)) radius = 1;
    constexpr double kFov = 30, kRoom = 1.03; // degrees; of the ball around the model
    const double away = kRoom * radius / std::sin(kFov * 0.5 * kPi / 180);
    out_(fmt::format("Format {} {} 1\nProjection \"perspective\" \"fov\" [{}]\n"
                     "Translate 0 0 {:.9g}\nRotate -18 1 0 0\nRotate 28 0 1 0\nScale 1 1 -1\nTranslate {:.9g} {:.9g} {:.9g}\n",
                     o_.height * 4 / 3, o_.height, kFov, away, -middle.x, -middle.y, -middle.z));
}

void Writer::cameraOf(int node) {
    const Camera& c = m_.cameras[size_t(m_.nodes[size_t(node)].camera)];
    const double aspect = c.aspect > 0 ? std::clamp(c.aspect, .01, 100.0) : 16.0 / 9;
    const double tall = c.perspective ? 1 : c.halfHeight;
    out_(fmt::format("# camera {}\nFormat {} {} 1\n", c.name.empty() ? "without a name" : quoted(c.name),
                     std::max(1, int(std::lround(o_.height * aspect))), o_.height));
    if (c.perspective) out_(fmt::format("Projection \"perspective\" \"fov\" [{:.9g}]\n", c.yfov * 180 / kPi));
    else out_("Projection \"orthographic\"\n");
    out_(fmt::format("ScreenWindow {:.9g} {:.9g} {:.9g} {:.9g}\n", -aspect * tall, aspect * tall, -tall, tall));
    if (c.near > 0) out_(fmt::format("Clipping {:.9g} {:.9g}\n", c.near, c.far > 0 ? c.far : 1e30));
    std::vector<Matrix> views;
    for (const Matrix& m : places(node)) views.push_back(inverse(withoutScale(m)));
    out_("Scale 1 1 -1\n" + placed(views));
}

void Writer::camera() {
    std::vector<int> nodes;
    for (const int n : drawn_)
        if (m_.nodes[size_t(n)].camera != kNone) nodes.push_back(n);
    if (o_.camera != kNone && o_.camera != 0 && size_t(o_.camera) >= nodes.size())
        note(fmt::format("there are {} cameras, so none with the number {}", nodes.size(), o_.camera));
    if (o_.camera >= 0 && size_t(o_.camera) < nodes.size()) cameraOf(nodes[size_t(o_.camera)]);
    else ownCamera();
}

/// Candela and lux become what Cl of shipped lights is: irradiance / pi (docs/light.md).
std::string Writer::light(const Light& l) const {
    const double intensity = l.intensity * o_.lightScale / kPi;
    std::string t = fmt::format("LightSource \"{}\" {} \"float intensity\" [{:.9g}] \"color lightcolor\" [{:.9g} {:.9g} {:.9g}]",
                                l.kind == LightKind::Sun    ? "distantlight"
                                : l.kind == LightKind::Spot ? "spotlight"
                                                            : "pointlight",
                                quoted(l.name), intensity, l.color[0], l.color[1], l.color[2]);
    if (l.kind != LightKind::Point) t += " \"point from\" [0 0 0] \"point to\" [0 0 -1]";
    if (l.kind == LightKind::Spot)
        t += fmt::format(" \"float coneangle\" [{:.9g}] \"float conedeltaangle\" [{:.9g}] \"float beamdistribution\" [0]",
                         l.outer, std::max(l.outer - l.inner, 1e-4));
    return t + "\n";
}

void Writer::lights() {
    int count = 0;
    for (const int n : drawn_) {
        const int which = m_.nodes[size_t(n)].light;
        if (which == kNone) continue;
        Light named = m_.lights[size_t(which)];
        named.name = fmt::format("{}.{}", named.name.empty() ? "light" : named.name, ++count); // a handle
        std::vector<Matrix> at;
        for (const Matrix& m : places(n)) at.push_back(withoutScale(m));
        out_("TransformBegin\n" + placed({at[0]}) + light(named) + "TransformEnd\n");
        if (at.size() > 1 && !(at[0] == at[1])) note("lights do not move while the shutter is open");
    }
    if (count == 0 && o_.addLights)
        out_("LightSource \"envlight\" \"sky\" \"float intensity\" .8 \"color lightcolor\" [.78 .87 1]\n"
             "LightSource \"distantlight\" \"sun\" \"float intensity\" .8 \"color lightcolor\" [1 .93 .82] \"point from\" "
             "[-2 5 3] \"point to\" [0 0 0]\n");
}

/// Parts that several nodes show as they are become objects.
void Writer::objects() {
    std::map<int, int> uses;
    for (const int n : drawn_)
        for (const int mesh : m_.nodes[size_t(n)].meshes) ++uses[mesh];
    for (const auto& [mesh, count] : uses) {
        if (count < 2) continue;
        const Mesh& of = m_.meshes[size_t(mesh)];
        for (size_t k = 0; k < of.parts.size(); ++k) {
            const Part& p = of.parts[k];
            const int set = p.material == kNone ? 0 : coordinateSet(m_.materials[size_t(p.material)]);
            if (!p.targets.empty() || p.influences > 0) continue;
            const int handle = int(handles_.size()) + 1;
            handles_[{mesh, k}] = handle;
            out_(fmt::format("ObjectBegin {}\n", handle));
            partText(p, p.P, p.N, set, out_);
            out_("ObjectEnd\n");
        }
    }
}

const std::string& Writer::material(int i) {
    const auto [at, fresh] = materials_.try_emplace(i);
    if (fresh) at->second = materialText(m_, i, maps_, [this](std::string s) { note(std::move(s)); });
    return at->second;
}

void Writer::node(int n) {
    const Node& x = m_.nodes[size_t(n)];
    for (const int mesh : x.meshes) {
        const Mesh& of = m_.meshes[size_t(mesh)];
        for (size_t k = 0; k < of.parts.size(); ++k) {
            const Part& p = of.parts[k];
            const std::string name = x.name.empty() ? of.name : x.name;
            out_("AttributeBegin\n");
            if (!name.empty()) out_("Attribute \"identifier\" \"string name\" " + quoted(name) + "\n");
            out_(material(p.material));
            if (skinOf(x, of, p) == kNone) out_(placed(places(n)));
            const int set = p.material == kNone ? 0 : coordinateSet(m_.materials[size_t(p.material)]);
            if (const auto h = handles_.find({mesh, k}); h != handles_.end()) {
                out_(fmt::format("ObjectInstance {}\n", h->second));
            } else if (!deforms(x, of, p)) {
                partText(p, p.P, p.N, set, out_);
            } else {
                std::vector<Shape> shapes;
                for (const Pose& pose : poses_) shapes.push_back(shapeAt(m_, pose, n, of, p));
                const bool moves = shapes.size() > 1 && shapes[0].P != shapes[1].P;
                if (moves) out_("MotionBegin [0 1]\n");
                for (size_t i = 0; i < (moves ? 2u : 1u); ++i) partText(p, shapes[i].P, shapes[i].N, set, out_);
                if (moves) out_("MotionEnd\n");
            }
            out_("AttributeEnd\n");
        }
    }
}

void Writer::all() {
    out_("##RenderMan RIB-Structure 1.1\nversion 3.04\n");
    if (!m_.generator.empty()) out_("# of a model by " + quoted(m_.generator) + "\n");
    out_("Display " + quoted(o_.picture) + " \"png\" \"rgb\"\nHider \"path\"\n");
    if (poses_.size() > 1) out_("Shutter 0 1\n");
    camera();
    out_("WorldBegin\n");
    lights();
    out_("Sides 2\n");
    objects();
    for (const int n : drawn_) node(n);
    out_("WorldEnd\n");
}

} // namespace

void writeRib(const Model& m, const RibOptions& o, const MapMaker& maps, const std::function<void(std::string_view)>& text,
              const std::function<void(std::string)>& note) {
    Writer(m, o, maps, text, note).all();
}

} // namespace alpenglow::models

#include "bench/ray_set.h"
#include "base/matrix.h"
#include "bsdf/sampling.h"
#include "render/camera.h"
#include <cmath>
#include <optional>
#include <random>

namespace alpenglow::bench {

namespace {

float uniform(std::mt19937& r) { return float(r() >> 8) * 0x1p-24f; }

struct Path {
    accel::Ray ray;
    int vertex = 0; ///< scattered so often
    bool onward = false;
};

class Paths {
public:
    Paths(const scene::Frame& f, const accel::Accel& a) : accel_(a), random_(1) {
        for (const geometry::ShapeRef& s : a.shapes()) {
            const int light = s->attributes().areaLight;
            if (light >= 0) lamps_.push_back(s.get());
            if (s->attributes().interior) fog_ = s->bounds();
        }
        for (const scene::Light& l : f.lights) {
            if (!l.shader || l.area) continue;
            if (l.shader->name == "envlight") sky_ = true;
            if (const scene::Param* p = scene::find(l.shader->params, "toward"); p && p->numbers.size() == 3)
                sun_ = normalize(
                    Vec3(transformVector(f.options.worldToCamera.first(), Vec3d(p->numbers[0], p->numbers[1], p->numbers[2]))));
        }
    }

    /// One step of all paths: their rays are kept by kind, and they go on or end.
    std::vector<Path> step(const std::vector<Path>& paths, std::map<std::string, RaysOfKind>& out) {
        std::vector<accel::Ray> rays;
        for (const Path& p : paths) {
            rays.push_back(p.ray);
            out[p.onward        ? "onward"
                : p.vertex == 0 ? "camera"
                : p.vertex < 3  ? "bounce " + std::to_string(p.vertex)
                                : "bounce 3+"]
                .rays.push_back(p.ray);
        }
        std::vector<accel::Hit> hits(rays.size());
        accel_.intersect(rays, hits);
        std::vector<Path> next;
        for (size_t i = 0; i < paths.size(); ++i)
            if (std::optional<Path> p = after(paths[i], hits[i], out)) next.push_back(*p);
        return next;
    }

private:
    bool inFog(const Vec3& p) const {
        return !fog_.empty() && p.x > fog_.lo.x && p.y > fog_.lo.y && p.z > fog_.lo.z && p.x < fog_.hi.x && p.y < fog_.hi.y &&
               p.z < fog_.hi.z;
    }
    Vec3 anywhere() {
        const float z = 1 - 2 * uniform(random_), a = 2 * float(kPi) * uniform(random_), r = std::sqrt(1 - z * z);
        return {r * std::cos(a), r * std::sin(a), z};
    }

    std::optional<Path> after(const Path& p, const accel::Hit& h, std::map<std::string, RaysOfKind>& out) {
        const accel::Ray& r = p.ray;
        const float flight = -2 * std::log(1 - uniform(random_)) / length(r.dir);
        if (const Vec3 at = r.org + r.dir * flight; flight < (h.valid() ? h.t : 1e30f) && inFog(at)) {
            light(p, at, out, [](const Vec3&) { return 0.f; }, [&](const Vec3&) { return at; });
            return scattered(p, at, anywhere());
        }
        if (!h.valid()) return {};
        const geometry::Shape& shape = *accel_.shapes()[h.shape];
        const auto& surface = shape.attributes().surface;
        const bool leaf = surface && surface->name.find("leaf") != std::string::npos, null = surface && surface->name == "null";
        if (null || (leaf && uniform(random_) < 0.2f)) {
            Path on = p;
            on.onward = true;
            on.ray.tnear = std::nextafter(h.t, 0.f);
            on.ray.passed = h.distance;
            on.ray.excludeShape = h.shape;
            on.ray.excludePrim = h.prim;
            return on;
        }
        geometry::SurfacePoint s;
        accel_.point(h, s, geometry::kNeedN);
        Vec3 n = dot(s.n, r.dir) > 0 ? -s.n : s.n;
        if (leaf && uniform(random_) < 0.5f) n = -n;
        const auto origin = [&](const Vec3& d) { return geometry::offsetOrigin(s, d); };
        light(p, s.P, out, [&](const Vec3& d) { return leaf ? 1.f : dot(n, d); }, origin, leaf ? nullptr : &n);
        const Vec3 d = bsdf::Basis(n).toWorld(bsdf::sampleCosine({uniform(random_), uniform(random_)}));
        return scattered(p, origin(d), d);
    }

    static Path scattered(const Path& p, const Vec3& origin, const Vec3& d) {
        Path next;
        next.vertex = p.vertex + 1;
        next.ray.org = origin;
        next.ray.dir = d;
        return next;
    }

    /// Shadow rays from a point to a place on one lamp, the sky and the sun.
    template <class Cosine, class Origin>
    void light(const Path& p, const Vec3& P, std::map<std::string, RaysOfKind>& out, Cosine cosine, Origin origin,
               const Vec3* n = nullptr) {
        const auto send = [&](const char* kind, const Vec3& d, float far) {
            RaysOfKind& k = out[p.vertex ? std::string(kind) + " 2+" : kind];
            accel::Ray r;
            r.org = origin(d);
            r.dir = d;
            r.tfar = far;
            k.any = true;
            k.rays.push_back(r);
        };
        if (!lamps_.empty()) {
            geometry::SurfacePoint e;
            const geometry::Shape& lamp = *lamps_[random_() % lamps_.size()];
            lamp.sampleFrom(P, uniform(random_), uniform(random_), e, geometry::kNeedN);
            const Vec3 to = e.P - P;
            const float l = length(to);
            // Lamps shine to the front, which is where their polygons are ordered clockwise.
            if (l > 0 && dot(e.n, to) < 0 && (!n || cosine(to) > 0)) send("lamp", to / l, l * (1 - 1e-5f));
        }
        if (sky_)
            send("sky", n ? bsdf::Basis(*n).toWorld(bsdf::sampleCosine({uniform(random_), uniform(random_)})) : anywhere(),
                 1e38f);
        if (sun_ && (!n || cosine(*sun_) > 0)) send("sun", normalize(*sun_ + anywhere() * (uniform(random_) * 0.017f)), 1e38f);
    }

    const accel::Accel& accel_;
    std::mt19937 random_;
    std::vector<const geometry::Shape*> lamps_;
    bool sky_ = false;
    std::optional<Vec3> sun_;
    geometry::Bounds fog_;
};

} // namespace

std::map<std::string, RaysOfKind> raysOf(const scene::Frame& frame, const accel::Accel& accel, size_t most, Diagnostics& diag) {
    const render::Camera camera(frame.options, diag);
    constexpr int kTile = 8, kDeepest = 6;
    const int across = camera.width() / kTile, down = camera.height() / kTile;
    const size_t tiles = size_t(across) * size_t(down), wanted = std::max<size_t>(1, most / (kTile * kTile));
    const size_t step = std::max<size_t>(1, tiles / wanted);
    std::mt19937 random(2);
    std::vector<Path> paths;
    for (size_t t = 0; t < tiles; t += step)
        for (int k = 0; k < kTile * kTile; ++k) {
            const int x = int(t % size_t(across)) * kTile + k % kTile, y = int(t / size_t(across)) * kTile + k / kTile;
            const float dx = uniform(random), dy = uniform(random);
            const integrator::CameraRay c = camera.ray(double(x) + dx, double(y) + dy, {0.5f, 0.5f}, 0);
            Path p;
            p.ray.org = c.origin;
            p.ray.dir = c.direction;
            paths.push_back(p);
        }
    std::map<std::string, RaysOfKind> out;
    Paths all(frame, accel);
    for (int i = 0; i < kDeepest && !paths.empty(); ++i) paths = all.step(paths, out);
    return out;
}

} // namespace alpenglow::bench

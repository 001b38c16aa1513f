// What hits cost: finding them (ns a ray, by kind of ray) and evaluating them (ns a hit, by kind of mesh). One thread, CPU time.
// mesh_bench [--repeats N]                points of hits and of emitters on meshes made here
// mesh_bench --rib FILE [--repeats N]     rays through the shapes of a scene; the first run of a mesh of millions takes a while
#include "accel/accel.h"
#include "bsdf/sampling.h"
#include "geometry/build.h"
#include "geometry/dice.h"
#include "render/camera.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <random>
#include <sys/resource.h>

using namespace alpenglow;

namespace {

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Nanoseconds of CPU for each of n: the least of all repeats.
double nanoseconds(size_t n, int repeats, const std::function<void()>& once) {
    double least = INFINITY;
    for (int i = 0; i < repeats; ++i) {
        const double begin = cpuSeconds();
        once();
        least = std::min(least, cpuSeconds() - begin);
    }
    return 1e9 * least / double(std::max<size_t>(n, 1));
}

float uniform(std::mt19937& r) { return float(r() >> 8) * 0x1p-24f; }

struct Frames final : scene::FrameConsumer {
    std::shared_ptr<const scene::Frame> frame;
    void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

scene::Param param(const char* name, scene::Class c, scene::Type t, std::vector<float> v) {
    scene::Param p;
    p.name = name;
    p.cls = c;
    p.type = t;
    p.numbers = std::move(v);
    return p;
}

/// A wavy sheet of 2 * side * side triangles; with N and st where they are asked for.
std::shared_ptr<scene::Primitive> sheet(int side, bool normals, bool st) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    std::vector<float> P, N, ST;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const float x = float(i) / float(side), y = float(j) / float(side);
            P.insert(P.end(), {x, y, 0.05f * std::sin(9 * x) * std::cos(7 * y) + 3});
            N.insert(N.end(), {-0.45f * std::cos(9 * x) * std::cos(7 * y), 0.35f * std::sin(9 * x) * std::sin(7 * y), 1});
            if ((i + j) % 7 == 0) N[N.size() - 1] = 1.5f; // not of unit length
            ST.insert(ST.end(), {x, y});
        }
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const int a = j * (side + 1) + i, b = a + side + 1;
            p->ints.insert(p->ints.end(), {3, 3});
            p->ints2.insert(p->ints2.end(), {a, a + 1, b, a + 1, b + 1, b});
        }
    p->params = {param("P", scene::Class::Vertex, scene::Type::Point, P)};
    if (normals) p->params.push_back(param("N", scene::Class::Varying, scene::Type::Normal, N));
    if (st) {
        scene::Param both = param("st", scene::Class::Varying, scene::Type::Float, ST);
        both.arrayLength = 2;
        p->params.push_back(both);
    }
    return p;
}

void measurePoints(int repeats) {
    struct Case {
        const char* name;
        int side;
        bool normals, st;
    };
    for (const Case& c :
         {Case{"12 to 18 triangles, as the box", 3, false, false}, Case{"80,000 triangles", 200, false, false},
          Case{"80,000 triangles, N and st", 200, true, true}, Case{"2,000,000 triangles, N and st", 1000, true, true}}) {
        Diagnostics diag;
        geometry::ShapeRef s =
            geometry::buildShape(sheet(c.side, c.normals, c.st), nullptr, translateMatrix(0.1, 0.2, 1), -1, diag);
        if (!s) continue;
        struct Place {
            uint32_t prim;
            double b1, b2;
        };
        std::mt19937 rng(1);
        std::vector<Place> at(1 << 18);
        for (Place& p : at) {
            const double a = uniform(rng), b = uniform(rng) * (1 - a);
            p = {uint32_t(rng()) % s->mesh().triangles(), a, b};
        }
        std::vector<geometry::SurfacePoint> out(512);
        const double hit = nanoseconds(at.size(), repeats, [&] {
            for (size_t i = 0; i < at.size(); ++i) s->evaluateHit(at[i].prim, at[i].b1, at[i].b2, out[i & 511]);
        });
        std::vector<geometry::HitRef> run(512);
        const auto inRuns = [&](uint32_t needs) {
            return nanoseconds(at.size(), repeats, [&] {
                for (size_t i = 0; i < at.size(); i += run.size()) {
                    for (size_t k = 0; k < run.size(); ++k) run[k] = {at[i + k].prim, at[i + k].b1, at[i + k].b2, &out[k]};
                    s->points(run, needs);
                }
            });
        };
        const double all = inRuns(geometry::kNeedAll), some = inRuns(geometry::kNeedN | geometry::kNeedST), none = inRuns(0);
        const double light = nanoseconds(at.size(), repeats, [&] {
            for (size_t i = 0; i < at.size(); ++i) s->sampleArea(at[i].b1, at[i].b2, out[i & 511]);
        });
        std::printf(
            "%-34s %6.1f ns a hit; in runs %6.1f, N and st only %6.1f, P and n only %6.1f; %6.1f ns a sample of the emitter\n",
            c.name, hit, all, some, none, light);
    }
}

int measureRays(const char* file, int repeats) {
    Diagnostics diag;
    Frames frames;
    ri::RibReader reader({}, frames, diag);
    reader.readFile(file);
    if (!frames.frame) {
        for (const Diagnostic& d : diag.all()) std::fprintf(stderr, "%s\n", toString(d).c_str());
        return 3;
    }
    std::vector<geometry::ShapeRef> shapes = geometry::buildShapes(*frames.frame, diag);
    geometry::DiceOptions dice;
    dice.camera = geometry::DiceCamera::from(frames.frame->options);
    geometry::diceShapes(shapes, dice, diag);
    render::Camera camera(frames.frame->options, diag);
    timespec begin{}, end{};
    clock_gettime(CLOCK_MONOTONIC, &begin);
    accel::Accel accel(shapes, {}, diag);
    clock_gettime(CLOCK_MONOTONIC, &end);
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::printf("built in %.2f s; peak memory %.0f MiB\n",
                double(end.tv_sec - begin.tv_sec) + 1e-9 * double(end.tv_nsec - begin.tv_nsec), double(used.ru_maxrss) / 1024);
    std::mt19937 rng(1);
    std::vector<accel::Ray> rays;
    for (int y = 0; y < camera.height(); ++y)
        for (int x = 0; x < camera.width(); ++x) {
            const integrator::CameraRay c = camera.ray(x + uniform(rng), y + uniform(rng), {0.5f, 0.5f}, 0);
            accel::Ray r;
            r.org = c.origin;
            r.dir = c.direction;
            rays.push_back(r);
        }
    uint64_t digest = 0;
    for (int bounce = 0; bounce <= 3; ++bounce) {
        std::vector<accel::Hit> hits(rays.size());
        std::vector<uint8_t> met(rays.size());
        const auto slices = [&](const std::function<void(size_t, size_t)>& of) {
            for (size_t i = 0; i < rays.size(); i += 512) of(i, std::min<size_t>(512, rays.size() - i));
        };
        const double nearest = nanoseconds(rays.size(), repeats, [&] {
            slices(
                [&](size_t i, size_t n) { accel.intersect(std::span<const accel::Ray>(&rays[i], n), std::span(&hits[i], n)); });
        });
        const double any = nanoseconds(rays.size(), repeats, [&] {
            slices([&](size_t i, size_t n) { accel.occluded(std::span<const accel::Ray>(&rays[i], n), std::span(&met[i], n)); });
        });
        geometry::SurfacePoint p;
        size_t valid = 0, blocked = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            valid += hits[i].valid();
            blocked += met[i];
            uint32_t bits;
            std::memcpy(&bits, &hits[i].t, 4);
            digest = (digest ^ bits ^ (uint64_t(hits[i].prim) << 32) ^ met[i]) * 0x9e3779b97f4a7c15u;
        }
        const double point = nanoseconds(valid, repeats, [&] {
            for (const accel::Hit& h : hits)
                if (h.valid()) accel.point(h, p);
        });
        std::printf(
            "bounce %d: %7.1f ns a ray to the nearest, %7.1f to any, %6.1f ns a hit's point; %zu rays, %zu met, %zu stopped\n",
            bounce, nearest, any, point, rays.size(), valid, blocked);
        std::vector<accel::Ray> next;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (!hits[i].valid()) continue;
            accel.point(hits[i], p);
            const Vec3 n = dot(p.n, rays[i].dir) > 0 ? -p.n : p.n;
            accel::Ray r;
            const float x = uniform(rng), y = uniform(rng);
            r.dir = bsdf::Basis(n).toWorld(bsdf::sampleCosine({x, y}));
            r.org = geometry::offsetOrigin(p, r.dir);
            next.push_back(r);
        }
        rays = std::move(next);
    }
    std::printf("digest %016llx\n", static_cast<unsigned long long>(digest));
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    int repeats = 5;
    const char* rib = nullptr;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--repeats")) repeats = std::max(1, std::atoi(argv[i + 1]));
        if (!std::strcmp(argv[i], "--rib")) rib = argv[i + 1];
    }
    if (rib) return measureRays(rib, repeats);
    measurePoints(repeats);
    return 0;
}

// alpenglow probe: the light at one point of a scene, as the radiance that a white diffuse point there would send back.
//
// A quad is put there, a hair above the surface and seen by camera rays only, so that it neither lights nor shadows anything;
// camera rays meet it straight on, over and over. So all light counts as it does in pictures: lights sampled, the rest followed.
// The rays meet a narrow ring around the point, not the point: where something touches the surface just there (a ball on the
// floor), whatever is a hair above the point lies inside of it.
#include "base/installation.h"
#include "base/processors.h"
#include "base/sampler.h"
#include "cli/command.h"
#include "cli/jsonreport.h"
#include "cli/ranges.h"
#include "render/rendering.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

namespace alpenglow::cli {
namespace {

std::string folderOf(const std::string& file) {
    const size_t slash = file.find_last_of('/');
    return slash == std::string::npos ? "." : file.substr(0, slash + 1);
}

/// Keeps the last frame of the streams.
struct Keeper final : scene::FrameConsumer {
    std::shared_ptr<const scene::Frame> frame;
    void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

/// The largest distance of a point of the scene from `centre`, roughly: from the points and radii as given.
double extentFrom(const scene::Frame& f, const Vec3d& centre) {
    double r = 0;
    for (const auto& p : f.primitives) {
        const Matrix& m = p->toWorld.first();
        auto meet = [&](Vec3d q) {
            double d = length(transformPoint(m, q) - centre);
            if (std::isfinite(d)) r = std::max(r, d);
        };
        if (const scene::Param* q = scene::find(p->params, "P"))
            for (size_t i = 0; i + 2 < q->numbers.size(); i += 3) meet({q->numbers[i], q->numbers[i + 1], q->numbers[i + 2]});
        else if (!p->numbers.empty())
            for (int k = 0; k < 3; ++k) meet(Vec3d(k == 0, k == 1, k == 2) * double(p->numbers[0]));
    }
    return r > 0 ? r : 1;
}

struct ProbeArguments {
    std::string scene, point, normal, dialect;
    uint32_t spp = 4096;
    uint64_t seed = 0;
    int threads = 0, maxDepth = -1, lanes = 16;
    double radius = 0; ///< 0: a 400th of the scene
    bool unbiased = false, allowExec = false, allowRead = false, json = false;
    std::vector<std::string> searchPaths;
};

/// A point and its normal, world space.
struct ProbedPoint {
    Vec3d P, N;
};

ProbedPoint pointOf(const ProbeArguments& a) {
    auto p = parseNumbers(a.point, 3), n = parseNumbers(a.normal, 3);
    if (!p) throw CLI::ValidationError("point", "takes X,Y,Z in world space");
    if (!n) throw CLI::ValidationError("normal", "takes NX,NY,NZ in world space");
    Vec3d P((*p)[0], (*p)[1], (*p)[2]), N((*n)[0], (*n)[1], (*n)[2]);
    if (!(length(N) > 0)) throw CLI::ValidationError("normal", "must not be zero");
    return {P, normalize(N)};
}

/// The last frame of the scene, for path tracing. Null after an error.
std::shared_ptr<scene::Frame> frameToProbe(const ProbeArguments& a, Diagnostics& diags) {
    Keeper keeper;
    ri::ReaderOptions options;
    options.searchPaths = folders(a.searchPaths);
    options.allowRead = a.allowRead;
    ri::RibReader(options, keeper, diags).readFile(a.scene);
    if (!keeper.frame) {
        diags.report(Severity::Error, Rie::MissingData, {a.scene}, "there is no world in it");
        return nullptr;
    }
    auto frame = std::make_shared<scene::Frame>(*keeper.frame);
    frame->options.hider = "path";
    frame->options.imager = nullptr;
    return frame;
}

/// The ring that rays meet, on a quad above the point. World space.
struct Ring {
    Vec3d centre, normal, u, v;
    double radius = 0; ///< the outer; the inner is half of it
    double above = 0;  ///< from the point to the quad, and from there to where the rays begin
    /// A point where a ray begins, evenly over the ring's area.
    Vec3d begin(const Vec2& random) const {
        const double r = radius * std::sqrt(0.25 + 0.75 * random.x), phi = 2 * kPi * random.y;
        return centre + normal * above + u * (r * std::cos(phi)) + v * (r * std::sin(phi));
    }
};

Ring ringAbout(const ProbedPoint& p, const scene::Frame& frame, double radius) {
    const Matrix& toCamera = frame.options.worldToCamera.first();
    const double extent = extentFrom(frame, p.P);
    Ring r;
    r.radius = radius > 0 ? radius : extent / 400;
    // A few times the rounding of the largest coordinate, so that the surface itself stays below.
    r.above = 0x1p-20 * std::max({extent, length(p.P), length(transformPoint(toCamera, p.P))});
    r.normal = p.N;
    r.u = normalize(cross(std::fabs(p.N.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), p.N));
    r.v = cross(p.N, r.u);
    r.centre = p.P + p.N * r.above;
    return r;
}

/// White and diffuse, lit by all lights of the frame, seen by camera rays only.
std::shared_ptr<scene::Attributes> whiteAttributes(const scene::Frame& frame) {
    auto attributes = std::make_shared<scene::Attributes>();
    std::set<int> lights;
    for (const auto& q : frame.primitives) lights.insert(q->attributes->lights.begin(), q->attributes->lights.end());
    for (const auto& i : frame.instances)
        if (i.attributes) lights.insert(i.attributes->lights.begin(), i.attributes->lights.end());
    attributes->lights = scene::LightSet(std::vector<int>(lights.begin(), lights.end()));
    auto shader = std::make_shared<scene::ShaderCall>();
    shader->name = "matte";
    scene::Param kd, ka;
    kd.name = "Kd";
    kd.numbers = {1};
    ka.name = "Ka";
    ka.numbers = {0};
    shader->params = {ka, kd};
    attributes->surface = shader;
    auto visible = [&](const char* ray, int value) {
        scene::Param q;
        q.name = ray;
        q.type = scene::Type::Integer;
        q.numbers = {float(value)};
        attributes->values[std::string("visibility:") + ray] = q;
    };
    visible("camera", 1);
    for (const char* ray : {"diffuse", "specular", "transmission", "trace", "photon"}) visible(ray, 0);
    return attributes;
}

/// The quad that holds the ring.
std::shared_ptr<scene::Primitive> quadUnder(const Ring& ring, std::shared_ptr<scene::Attributes> attributes) {
    auto quad = std::make_shared<scene::Primitive>();
    quad->kind = "Polygon";
    quad->attributes = std::move(attributes);
    scene::Param points;
    points.name = "P";
    points.cls = scene::Class::Vertex;
    points.type = scene::Type::Point;
    const double size = 1.01 * ring.radius;
    for (auto [s, t] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Vec3d q = ring.centre + (ring.u * double(s) + ring.v * double(t)) * size;
        for (double x : {q.x, q.y, q.z}) points.numbers.push_back(float(x));
    }
    quad->params = {points};
    return quad;
}

world::Settings settingsOf(const ProbeArguments& a, const StopFlag* stop) {
    world::Settings t;
    t.hider = world::Hider::Path;
    t.seed = a.seed;
    t.lanes = a.lanes;
    t.maxDepth = a.maxDepth;
    t.unbiased = a.unbiased;
    t.allowExec = a.allowExec;
    t.read = readPolicyOf(folderOf(a.scene), a.allowRead);
    t.dialect = a.dialect;
    t.shaderPaths = folders(a.searchPaths);
    for (std::string& e : environmentShaders()) t.shaderPaths.push_back(std::move(e));
    const std::string folder = folderOf(a.scene);
    t.texturePaths = folders(a.searchPaths);
    t.shaderPaths.push_back(folder);
    t.texturePaths.push_back(folder);
    t.texturePaths.push_back(".");
    if (std::string s = shippedShaders(); !s.empty()) t.shaderPaths.push_back(s);
    t.pluginPaths = t.shaderPaths;
    t.stop = stop;
    return t;
}

/// Samples in up to 64 blocks, each a stratified sequence of its own: their means are independent, so their spread is the
/// error.
struct Blocks {
    uint32_t each; ///< samples
    std::vector<Color> means;
    std::atomic<uint32_t> missed{0}; ///< samples that did not meet the quad
    explicit Blocks(uint32_t spp) {
        const uint32_t blocks = std::min(64u, std::max(2u, spp));
        each = std::max(1u, (spp + blocks - 1) / blocks);
        means.resize(blocks);
    }
    /// Traces one of them, unless it is halted.
    void trace(size_t block, render::Tracer&, const Ring&, const scene::Frame&, uint64_t seed, const StopFlag* halt);
};

void Blocks::trace(size_t block, render::Tracer& tracer, const Ring& ring, const scene::Frame& frame, uint64_t seed,
                   const StopFlag* halt) {
    const Matrix& toCamera = frame.options.worldToCamera.first();
    integrator::CameraRay ray;
    ray.direction = Vec3(normalize(transformVector(toCamera, -ring.normal)));
    ray.width = float(ring.radius);
    ray.time = frame.options.shutterOpen;
    ray.px = int(block);
    double sum[3] = {0, 0, 0};
    for (uint32_t begin = 0; begin < each; begin += 1024) {
        std::vector<integrator::CameraRay> rays;
        for (uint32_t s = begin; s < std::min(each, begin + 1024); ++s) {
            const Vec2 e = Sampler(seed, int(block), 0).get2(0, render::kUseFilter, 0, s);
            rays.push_back(ray);
            rays.back().origin = Vec3(transformPoint(toCamera, ring.begin(e)));
            rays.back().sample = s;
        }
        std::vector<integrator::SampleResult> results(rays.size());
        if (!tracer.trace(rays, results, halt)) return;
        for (const auto& r : results) {
            for (int k = 0; k < 3; ++k) sum[k] += double(r.color[k]);
            if (r.z >= 1e38f) ++missed;
        }
    }
    for (int k = 0; k < 3; ++k) means[block][k] = float(sum[k] / each);
}

/// The mean of the blocks and its standard error.
struct Estimate {
    double mean[3] = {0, 0, 0}, error[3] = {0, 0, 0};
    explicit Estimate(const std::vector<Color>& means) {
        const uint32_t blocks = uint32_t(means.size());
        for (int k = 0; k < 3; ++k) {
            for (const Color& c : means) mean[k] += double(c[k]) / blocks;
            for (const Color& c : means) error[k] += (double(c[k]) - mean[k]) * (double(c[k]) - mean[k]);
            error[k] = std::sqrt(error[k] / (double(blocks) * (blocks - 1)));
        }
    }
};

/// found: what --json prints.
int probe(const ProbeArguments& a, Diagnostics& diags, nlohmann::ordered_json& found) {
    const ProbedPoint point = pointOf(a);
    const auto frame = frameToProbe(a, diags);
    if (!frame) return kNothingRendered;
    const Ring ring = ringAbout(point, *frame, a.radius);
    frame->primitives.push_back(quadUnder(ring, whiteAttributes(*frame)));
    render::Engine engine = render::transportEngine();
    const StopFlag* stop = watchInterrupts();
    auto world = engine.build(frame, settingsOf(a, stop), diags);
    if (*stop) return kInterrupted;
    if (!world) return kNothingRendered;

    Blocks blocks(a.spp);
    const size_t count = blocks.means.size();
    const int threads = a.threads > 0 ? a.threads : defaultThreads();
    render::Team team(std::min(threads, int(count)));
    std::vector<std::unique_ptr<render::Tracer>> tracers(size_t(team.threads()));
    StopFlag halt;
    team.run(
        count, &halt,
        [&](int worker, size_t b) {
            auto& tracer = tracers[size_t(worker)];
            if (!tracer) tracer = engine.tracer(world, diags);
            blocks.trace(b, *tracer, ring, *frame, a.seed, &halt);
        },
        [&](size_t) {
            if (*stop) halt = 1;
        });
    if (*stop) return kInterrupted;
    if (blocks.missed) {
        diags.report(Severity::Error, Rie::Math, {},
                     "the point could not be seen: it is lost in the rounding of the scene's coordinates");
        return kNothingRendered;
    }
    const Estimate e(blocks.means);
    if (a.json) found = {{"radiance", e.mean}, {"standardError", e.error}, {"spp", uint64_t(count) * blocks.each}};
    else std::printf("%.7g %.7g %.7g  %.3g %.3g %.3g\n", e.mean[0], e.mean[1], e.mean[2], e.error[0], e.error[1], e.error[2]);
    return diags.errors() ? kDoneWithErrors : kDone;
}

} // namespace

void addProbe(CLI::App& app, int* status) {
    auto a = std::make_shared<ProbeArguments>();
    CLI::App* c =
        app.add_subcommand("probe", "Print the radiance leaving a white diffuse point of a scene, and its standard error");
    c->add_option("scene", a->scene, "RIB file; - is standard input")->type_name("FILE")->required();
    c->add_option("point", a->point, "X,Y,Z in world space")->type_name("X,Y,Z")->required();
    c->add_option("normal", a->normal, "NX,NY,NZ: the side that is lit")->type_name("NX,NY,NZ")->required();
    c->add_option("--spp", a->spp, "Samples")->check(wholeBetween(2, 1u << 26))->type_name("N")->capture_default_str();
    c->add_option("--seed", a->seed, "Seed of all random numbers")->type_name("N");
    c->add_option("--threads", a->threads, "Number of threads; default: all processors available to the process")
        ->check(wholeBetween(1, 1024))
        ->type_name("N");
    c->add_option("--lanes", a->lanes, "SIMD width of shaders, in points")->check(CLI::IsMember({4, 8, 16}))->type_name("N");
    c->add_option("--max-depth", a->maxDepth, "Maximum number of bounces")->check(wholeBetween(0, 10000))->type_name("N");
    c->add_option("--radius", a->radius,
                  "Outer radius of the sampled ring around the point; default: a 400th of the scene's size")
        ->check(positive())
        ->type_name("R");
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Allow shaders to load plug-ins");
    c->add_flag("--allow-read", a->allowRead, "Allow the scene to read maps and archives anywhere");
    c->add_flag("--unbiased", a->unbiased, "Disable energy clamping of shaders that reflect more light than they receive");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders, textures and archives, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->footer("Prints R G B and their standard errors. Always path-traces, whatever the scene's hider.\n\n"
              "Example: alpenglow probe examples/muttenzer_box.rib 0,-1.25,0 0,1,0 --spp 65536");
    c->add_flag("--json", a->json, "Print JSON, with messages under \"diagnostics\"");
    c->callback([a, status] {
        nlohmann::ordered_json reported, found = nlohmann::ordered_json::object();
        Diagnostics diags(printerOr(a->json, reported));
        *status = probe(*a, diags, found);
        if (a->json) printReport(std::move(found), std::move(reported));
    });
}

} // namespace alpenglow::cli

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

/// found: what --json prints.
int probe(const ProbeArguments& a, Diagnostics& diags, nlohmann::ordered_json& found) {
    auto p = parseNumbers(a.point, 3), n = parseNumbers(a.normal, 3);
    if (!p) throw CLI::ValidationError("point", "takes X,Y,Z in world space");
    if (!n) throw CLI::ValidationError("normal", "takes NX,NY,NZ in world space");
    Vec3d P((*p)[0], (*p)[1], (*p)[2]), N((*n)[0], (*n)[1], (*n)[2]);
    if (!(length(N) > 0)) throw CLI::ValidationError("normal", "must not be zero");
    N = normalize(N);
    Keeper keeper;
    ri::ReaderOptions options;
    options.searchPaths = folders(a.searchPaths);
    options.allowRead = a.allowRead;
    ri::RibReader(options, keeper, diags).readFile(a.scene);
    if (!keeper.frame) {
        diags.report(Severity::Error, Rie::MissingData, {a.scene}, "there is no world in it");
        return kNothingRendered;
    }
    auto frame = std::make_shared<scene::Frame>(*keeper.frame);
    frame->options.hider = "path";
    frame->options.imager = nullptr;

    const Matrix& toCamera = frame->options.worldToCamera.first();
    double extent = extentFrom(*frame, P), radius = a.radius > 0 ? a.radius : extent / 400, size = 1.01 * radius;
    // A few times the rounding of the largest coordinate, so that the surface itself stays below.
    double above = 0x1p-20 * std::max({extent, length(P), length(transformPoint(toCamera, P))});
    Vec3d helper = std::fabs(N.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    Vec3d u = normalize(cross(helper, N)), v = cross(N, u), C = P + N * above;
    auto attributes = std::make_shared<scene::Attributes>();
    std::set<int> lights;
    for (const auto& q : frame->primitives) lights.insert(q->attributes->lights.begin(), q->attributes->lights.end());
    for (const auto& i : frame->instances)
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
    auto quad = std::make_shared<scene::Primitive>();
    quad->kind = "Polygon";
    quad->attributes = attributes;
    scene::Param points;
    points.name = "P";
    points.cls = scene::Class::Vertex;
    points.type = scene::Type::Point;
    for (auto [s, t] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Vec3d q = C + (u * double(s) + v * double(t)) * size;
        for (double x : {q.x, q.y, q.z}) points.numbers.push_back(float(x));
    }
    quad->params = {points};
    frame->primitives.push_back(quad);

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
    render::Engine engine = render::transportEngine();
    const StopFlag* stop = watchInterrupts();
    t.stop = stop;
    auto world = engine.build(frame, t, diags);
    if (*stop) return kInterrupted;
    if (!world) return kNothingRendered;

    // Samples in up to 64 blocks, each a stratified sequence of its own: their means are independent, so their spread is the
    // error.
    uint32_t blocks = std::min(64u, std::max(2u, a.spp)), each = std::max(1u, (a.spp + blocks - 1) / blocks);
    integrator::CameraRay ray;
    ray.direction = Vec3(normalize(transformVector(toCamera, -N)));
    ray.width = float(radius);
    ray.time = frame->options.shutterOpen;
    std::vector<Color> means(blocks);
    std::atomic<uint32_t> missed{0};
    const int threads = a.threads > 0 ? a.threads : defaultThreads();
    render::Team team(std::min(threads, int(blocks)));
    std::vector<std::unique_ptr<render::Tracer>> tracers(size_t(team.threads()));
    StopFlag halt;
    team.run(
        blocks, &halt,
        [&](int worker, size_t b) {
            auto& tracer = tracers[size_t(worker)];
            if (!tracer) tracer = engine.tracer(world, diags);
            double sum[3] = {0, 0, 0};
            for (uint32_t begin = 0; begin < each; begin += 1024) {
                std::vector<integrator::CameraRay> rays;
                for (uint32_t s = begin; s < std::min(each, begin + 1024); ++s) {
                    Vec2 e = render::Sampler(a.seed, int(b), 0).get2(0, render::kUseFilter, 0, s);
                    double r = radius * std::sqrt(0.25 + 0.75 * e.x), phi = 2 * kPi * e.y;
                    Vec3d from = C + N * above + u * (r * std::cos(phi)) + v * (r * std::sin(phi));
                    rays.push_back(ray);
                    rays.back().origin = Vec3(transformPoint(toCamera, from));
                    rays.back().px = int(b);
                    rays.back().sample = s;
                }
                std::vector<integrator::SampleResult> results(rays.size());
                if (!tracer->trace(rays, results, &halt)) return;
                for (const auto& r : results) {
                    for (int k = 0; k < 3; ++k) sum[k] += double(r.color[k]);
                    if (r.z >= 1e38f) ++missed;
                }
            }
            for (int k = 0; k < 3; ++k) means[b][k] = float(sum[k] / each);
        },
        [&](size_t) {
            if (*stop) halt = 1;
        });
    if (*stop) return kInterrupted;
    if (missed) {
        diags.report(Severity::Error, Rie::Math, {},
                     "the point could not be seen: it is lost in the rounding of the scene's coordinates");
        return kNothingRendered;
    }
    double mean[3] = {0, 0, 0}, error[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        for (const Color& c : means) mean[k] += double(c[k]) / blocks;
        for (const Color& c : means) error[k] += (double(c[k]) - mean[k]) * (double(c[k]) - mean[k]);
        error[k] = std::sqrt(error[k] / (double(blocks) * (blocks - 1)));
    }
    if (a.json) found = {{"radiance", mean}, {"standardError", error}, {"spp", uint64_t(blocks) * each}};
    else std::printf("%.7g %.7g %.7g  %.3g %.3g %.3g\n", mean[0], mean[1], mean[2], error[0], error[1], error[2]);
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
        nlohmann::ordered_json said, found = nlohmann::ordered_json::object();
        Diagnostics diags(printerOr(a->json, said));
        *status = probe(*a, diags, found);
        if (a->json) printReport(std::move(found), std::move(said));
    });
}

} // namespace alpenglow::cli

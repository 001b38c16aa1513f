// alpenglow shade: a shader on a lit ball, or over a unit patch without a scene; also the stopwatch of the kernels.
#include "base/installation.h"
#include "base/limits.h"
#include "cli/ball.h"
#include "cli/command.h"
#include "cli/ranges.h"
#include "display/imageio.h"
#include "render/imaging.h"
#include "rsl/compiler.h"
#include "rsl/front/protocol.h"
#include "rsl/printlog.h"
#include "rsl/services_basic.h"
#include "rsl/spilledarrays.h"
#include "services/withoutscene.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

namespace alpenglow::cli {
namespace {

struct ShadeArguments {
    std::string shader, output = "out.exr", format = "256x256", kind, dialect;
    std::vector<std::string> params, searchPaths, outputs;
    int spp = 0, iterations = 0, lanes = 16, vectors = 0;
    float gamma = 0;
    bool allowExec = false, patch = false;
};

/// Value, d/du and d/dv of a predefined variable at a point of the patch; see the footer of the help. False: not known.
bool predefined(const std::string& name, float u, float v, float du, float dv, int c, int part, float* out) {
    struct Row {
        const char* name;
        float value[3], du[3], dv[3];
    };
    const Row rows[] = {{"u", {u}, {1}, {0}},
                        {"v", {v}, {0}, {1}},
                        {"s", {u}, {1}, {0}},
                        {"t", {v}, {0}, {1}},
                        {"du", {du}, {}, {}},
                        {"dv", {dv}, {}, {}},
                        {"time", {0}, {}, {}},
                        {"dtime", {0}, {}, {}},
                        {"ncomps", {3}, {}, {}},
                        {"alpha", {1}, {}, {}},
                        {"P", {u, v, 0}, {1, 0, 0}, {0, 1, 0}},
                        {"dPdu", {1, 0, 0}, {}, {}},
                        {"dPdv", {0, 1, 0}, {}, {}},
                        {"dPdtime", {}, {}, {}},
                        {"N", {0, 0, 1}, {}, {}},
                        {"Ng", {0, 0, 1}, {}, {}},
                        {"I", {u - 0.5f, v - 0.5f, -1}, {1, 0, 0}, {0, 1, 0}},
                        {"E", {0.5f, 0.5f, 1}, {}, {}},
                        {"Cs", {1, 1, 1}, {}, {}},
                        {"Os", {1, 1, 1}, {}, {}},
                        {"Ci", {}, {}, {}},
                        {"Oi", {1, 1, 1}, {}, {}}};
    for (const Row& r : rows)
        if (name == r.name) {
            *out = c > 2 ? 0 : part == 0 ? r.value[c] : part == 1 ? r.du[c] : part == 2 ? r.dv[c] : 0;
            return true;
        }
    *out = 0;
    return false;
}

/// Rows of floats, 64-byte aligned.
struct Rows {
    std::unique_ptr<float, decltype(&std::free)> data{nullptr, &std::free};
    explicit Rows(size_t floats) {
        size_t bytes = (std::max(floats, size_t(64)) * 4 + 63) / 64 * 64;
        data.reset(static_cast<float*>(std::aligned_alloc(64, bytes)));
        if (!data) throw std::bad_alloc();
        std::fill_n(data.get(), bytes / 4, 0.f);
    }
};

struct Context {
    const rsl::CompiledKernel* kernel;
    Diagnostics* diagnostics;
    services::WithoutScene* services;
    bool print;
    size_t begun = 0; ///< index of the batch's first point
    rsl::PrintLog prints{};
    rsl::SpilledArrays spilled{};
    bool answers(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
        return services->answer(*kernel, site, first, mask, lanes, in, out) ||
               spilled.answer(kernel->sites()[size_t(site)], first, mask, lanes, in, out, *diagnostics, &kernel->files());
    }
    /// After a batch.
    void flush() {
        prints.flush();
        spilled.clear();
    }
};

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Of -o on standard output: PNG.
display::Format pictureFormat(const std::string& name) {
    return name == "-" ? display::Format::Png : display::formatOfExtension(name).value_or(display::Format::Exr);
}

int shade(const ShadeArguments& a) {
    int width = 0, height = 0;
    readFormat(a.format, &width, &height);
    if (const std::string fault = faultOfPictureName(a.output, true); !fault.empty()) throw CLI::ValidationError("-o", fault);
    const bool patch = a.patch || a.iterations > 0 || a.vectors > 0 || !a.outputs.empty();
    Diagnostics diags(printer()), quiet; // on a ball the renderer says what there is to say of the shader
    std::vector<std::string> paths{"."};
    for (std::string& f : folders(a.searchPaths)) paths.push_back(std::move(f));
    const std::vector<std::string> texturePaths = paths;
    for (std::string& f : environmentShaders()) paths.push_back(std::move(f));
    if (std::string s = shippedShaders(); !s.empty()) paths.push_back(s);
    rsl::ShaderCompiler::Settings settings;
    settings.allowExec = a.allowExec;
    settings.dialect = a.dialect;
    settings.pluginPaths = paths;
    rsl::ShaderCompiler compiler(settings);
    auto shader = compiler.load(a.shader, paths, patch ? diags : quiet);
    for (const Diagnostic& d : quiet.all())
        if (!shader) diags.report(d);
    if (!shader) return kNothingRendered;
    if (!a.kind.empty()) {
        // A class can be shaders of several kinds.
        std::string kinds;
        std::shared_ptr<const rsl::CompiledShader> wanted;
        for (const auto& s : shader->program().shaders) {
            if (s->name != shader->name()) continue;
            const std::string kind = rsl::toString(s->kind);
            kinds += (kinds.empty() ? "" : ", ") + kind;
            if (kind == a.kind) wanted = rsl::ShaderCompiler::variant(shader, s->kind);
        }
        if (!wanted) {
            diags.report(Severity::Error, Rie::BadToken, {a.shader}, "it is no " + a.kind + " shader", "it is: " + kinds);
            return kWrongUse;
        }
        shader = wanted;
    }
    auto values = compiler.parameterValues(shader, patch ? diags : quiet);
    std::vector<rsl::ParameterValue> given;
    rsl::KernelOptions options;
    options.lanes = a.lanes;
    options.vectors = a.vectors;
    options.outputs = a.outputs;
    for (const std::string& p : a.params) {
        size_t eq = p.find('=');
        if (eq == std::string::npos || eq == 0)
            throw CLI::ValidationError("--param", "takes NAME=VALUE, for example Kd=0.5 or c=1,0,0");
        std::string name = p.substr(0, eq), text = p.substr(eq + 1);
        auto i = std::find_if(values.begin(), values.end(), [&](const rsl::ParameterValue& v) { return v.name == name; });
        if (i == values.end()) {
            std::vector<std::string> names;
            for (const auto& v : values) names.push_back(v.name);
            diags.report(Severity::Error, Rie::BadToken, {a.shader}, "it has no parameter \"" + name + "\"",
                         nearestName(name, names));
            return kWrongUse;
        }
        if (i->type.base == rsl::Base::String) {
            i->strings = {text};
            given.push_back(*i);
            continue;
        }
        auto numbers = parseNumbers(text);
        size_t want = i->numbers.size();
        if (numbers && numbers->size() == 1 && want == 3) numbers->assign(3, numbers->front());
        if (!numbers || numbers->size() != want) {
            diags.report(Severity::Error, Rie::BadToken, {a.shader},
                         "parameter \"" + name + "\" takes " + std::to_string(want) + " numbers");
            return kWrongUse;
        }
        i->numbers.assign(numbers->begin(), numbers->end());
        given.push_back(*i);
    }
    if (!patch)
        return shadeBall({a.shader, shader->kind(), given, a.output, width, height, a.spp, a.lanes, a.gamma,
                          folders(a.searchPaths), a.dialect, a.allowExec},
                         diags);
    if (!given.empty()) values = compiler.parameterValues(shader, diags, {}, given); // defaults may read what is given
    std::set<std::string> names;
    for (const auto& v : given) names.insert(v.name);
    options.computedParameters = shader->computedParameters(names, {});
    for (const auto& v : values)
        if (v.type.base == rsl::Base::String && v.type.array == 0 && !v.strings.empty())
            options.stringParameters.emplace_back(v.name, v.strings[0]);
    auto kernel = compiler.kernel(shader, options, diags);
    if (!kernel) return kNothingRendered;
    const display::Format format = pictureFormat(a.output);
    const bool png = !display::written(format).floats; // shows colours
    const auto colour = [&](const auto& o) { return o.name == "Ci"; };
    if (kernel->outputs().empty() || (png && std::none_of(kernel->outputs().begin(), kernel->outputs().end(), colour))) {
        std::string writes;
        for (const auto& o : kernel->outputs()) writes += (writes.empty() ? "" : ", ") + o.name;
        diags.report(Severity::Error, Rie::MissingData, {a.shader},
                     "this " + std::string(rsl::toString(shader->kind())) + " shader " +
                         (writes.empty()
                              ? "writes nothing that could be shown"
                              : std::string("writes no Ci for a ") + display::toString(format) + " picture, only " + writes),
                     writes.empty() ? "--output names what is to be shown" : "an EXR picture takes any values");
        return kNothingRendered;
    }
    if (kernel->facts().suspends) {
        diags.report(Severity::Error, Rie::IllState, {a.shader}, "it waits for rays, and there is no scene here");
        return kNothingRendered;
    }

    const int w = width, h = height, side = std::max(1, int(std::lround(std::sqrt(double(std::max(1, a.spp))))));
    const float du = 1.f / float(w), dv = 1.f / float(h);
    std::vector<std::string> channels;
    for (const auto& o : kernel->outputs()) {
        int n = rsl::ir::components(o.kind);
        if (o.kind == rsl::ir::Kind::String) continue;
        for (int c = 0; c < n; ++c)
            channels.push_back(o.name == "Ci" ? std::string(1, "rgb"[c])
                               : n == 1       ? o.name
                                              : o.name + "." + (n == 3 ? std::string(1, "rgb"[c]) : std::to_string(c)));
    }
    display::Image image = display::makeImage(w, h, channels);
    const int batch = 4096, stride = batch;
    std::vector<Rows> in, out;
    std::vector<const float*> inRows;
    std::vector<float*> outRows;
    for (const auto& i : kernel->inputs()) {
        in.emplace_back(size_t(std::max(1, i.array)) * rsl::ir::components(i.kind) * rsl::inputParts(i) * stride);
        inRows.push_back(in.back().data.get());
    }
    for (const auto& o : kernel->outputs()) {
        out.emplace_back(size_t(rsl::ir::components(o.kind)) * stride);
        outRows.push_back(out.back().data.get());
    }
    services::WithoutScene services(texturePaths, diags);
    Context context{kernel.get(), &diags, &services, true};
    const StopFlag* stop = watchInterrupts();
    rsl::KernelCall call{};
    call.in = inRows.data();
    call.out = outRows.data();
    call.stride = stride;
    call.strings = kernel->strings().data();
    call.user = &context;
    call.stop = stop;
    call.service = [](rsl::KernelCall* c, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* rowsIn,
                      float* rowsOut) {
        auto& x = *static_cast<Context*>(c->user);
        if (site < 0 || x.answers(site, first, mask, lanes, rowsIn, rowsOut)) return;
        rsl::basicService(
            x.kernel->sites()[size_t(site)], mask, lanes, rowsIn, rowsOut, *x.diagnostics,
            [&](int lane, const std::string& text) {
                if (!x.print) return;
                rsl::PrintKey key;
                key.sample = int64_t(x.begun) + first + lane;
                x.prints.add(key, text);
            },
            &x.kernel->files());
    };
    call.lightBegin = [](rsl::KernelCall*, int32_t, int32_t, uint64_t, int32_t, const float*) { return int32_t(0); };
    call.lightFetch = [](rsl::KernelCall*, int32_t, int32_t, int32_t, uint64_t, int32_t, float*) { return uint64_t(0); };
    call.lightEnd = [](rsl::KernelCall*, int32_t, int32_t, int32_t) {};

    auto fill = [&](const std::vector<Vec2>& at) {
        call.n = int32_t(at.size());
        std::vector<Vec3> points;
        for (const Vec2& p : at) points.push_back({p.x, p.y, 0});
        services.setPoints({0.5f, 0.5f, 1}, points);
        for (size_t k = 0; k < in.size(); ++k) {
            const auto& i = kernel->inputs()[k];
            float* rows = in[k].data.get();
            int parts = rsl::inputParts(i), n = rsl::ir::components(i.kind);
            const rsl::InputName name = rsl::InputName::parse(i.name);
            auto value = std::find_if(values.begin(), values.end(),
                                      [&](const rsl::ParameterValue& v) { return name == rsl::InputName::parameter(v.name); });
            for (int e = 0; e < std::max(1, i.array); ++e)
                for (int c = 0; c < n; ++c)
                    for (int part = 0; part < parts; ++part) {
                        size_t row = size_t(e * n + c) * size_t(parts) + size_t(part), number = size_t(e * n + c);
                        float constant = 0;
                        bool varies = false;
                        if (value != values.end())
                            constant = part == 0 && number < value->numbers.size() ? value->numbers[number] : 0;
                        else if (i.kind == rsl::ir::Kind::Matrix) constant = c % 5 == 0 ? 1.f : 0.f; // every space is "current"
                        else varies = true;
                        if (i.uniform) {
                            if (varies) predefined(i.name, at[0].x, at[0].y, du, dv, c, part, &constant);
                            rows[row] = constant;
                            continue;
                        }
                        float* r = rows + row * size_t(stride);
                        for (size_t p = 0; p < at.size(); ++p) {
                            if (varies) predefined(i.name, at[p].x, at[p].y, du, dv, c, part, &r[p]);
                            else r[p] = constant;
                        }
                    }
        }
    };
    const size_t samples = size_t(side) * size_t(side), total = size_t(w) * size_t(h) * samples;
    auto place = [&](size_t i) {
        size_t pixel = i / samples, s = i % samples;
        double x = double(pixel % size_t(w)) + (double(s % size_t(side)) + 0.5) / side,
               y = double(pixel / size_t(w)) + (double(s / size_t(side)) + 0.5) / side;
        return Vec2{float(x / w), float(y / h)};
    };
    for (size_t first = 0; first < total && !*stop; first += size_t(batch)) {
        std::vector<Vec2> at;
        for (size_t i = first; i < std::min(total, first + size_t(batch)); ++i) at.push_back(place(i));
        fill(at);
        context.begun = first;
        kernel->run(&call);
        context.flush();
        for (size_t p = 0; p < at.size(); ++p) {
            float* pixel = image.data.data() + (first + p) / samples * channels.size();
            for (size_t o = 0; o < out.size(); ++o) {
                if (kernel->outputs()[o].kind == rsl::ir::Kind::String) continue;
                for (int c = 0; c < rsl::ir::components(kernel->outputs()[o].kind); ++c)
                    *pixel++ += out[o].data.get()[size_t(c) * stride + p] / float(samples);
            }
        }
    }
    if (*stop) return kInterrupted;
    if (a.iterations > 0) {
        context.print = false;
        std::vector<Vec2> at; // one batch over the whole patch, again and again
        for (int i = 0; i < batch; ++i) at.push_back({(float(i % 64) + 0.5f) / 64, (float(i / 64) + 0.5f) / 64});
        fill(at);
        double best = 1e300, all = 0;
        for (int k = 0; k < a.iterations && !*stop; ++k) {
            double t = cpuSeconds();
            kernel->run(&call);
            t = cpuSeconds() - t;
            best = std::min(best, t);
            all += t;
        }
        std::printf("%.4g ns a point (best of %d batches of %d points), mean %.4g ns, %d points a strip\n", best * 1e9 / batch,
                    a.iterations, batch, all * 1e9 / batch / a.iterations, kernel->lanes());
    }
    display::WriteOptions o;
    o.format = format;
    o.policy.allowWrite = true;
    if (png) {
        o.sample = display::Sample::UInt8;
        image = display::selectChannels(image, {"r", "g", "b"});
    }
    if (a.gamma > 0)
        for (float& f : image.data) f = render::expose(f, 1, a.gamma);
    if (!display::writeImage(a.output, image, o, diags)) return kOutputFailed;
    return diags.errors() ? kDoneWithErrors : kDone;
}

} // namespace

void addShade(CLI::App& app, int* status) {
    auto a = std::make_shared<ShadeArguments>();
    CLI::App* c = app.add_subcommand("shade", "Show a shader on a lit ball, or over a unit patch");
    c->add_option("shader", a->shader, "RSL file, or the name of a shader on the search path")->type_name("FILE")->required();
    c->add_option("-o", a->output,
                  std::string("Picture to write (") + display::pictureExtensions() +
                      "; - is standard output); for a patch: Ci and Oi, or the variables of --output")
        ->type_name("FILE")
        ->capture_default_str();
    c->add_flag("--patch", a->patch, "Shade the unit patch instead of the ball; implied by --output, --iterations and --vectors");
    c->add_option(
         "--kind", a->kind,
         "Kind of shader to use of a class that has several; default: the first of surface, displacement, light, volume, imager")
        ->check(CLI::IsMember({"surface", "displacement", "light", "volume", "imager"}))
        ->type_name("KIND");
    c->add_option("--param", a->params, "Set a parameter: Kd=0.5, color=1,0,0, name=text")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    c->add_option("--output", a->outputs, "Variables to write instead of Ci and Oi")->type_name("NAME")->allow_extra_args(false);
    c->add_option("--format", a->format, "Size of the picture")->type_name("WxH")->capture_default_str();
    c->add_option("--spp", a->spp,
                  "Samples per pixel of the ball (default 64), or points per pixel of the patch, rounded to a square number and "
                  "averaged (default 1)")
        ->check(wholeBetween(1, 4096))
        ->type_name("N");
    c->add_option("--gamma", a->gamma, "Display gamma of the picture")->check(between(0.01, 100))->type_name("G");
    c->add_option("--iterations", a->iterations,
                  "Time this many runs over 4096 points and print nanoseconds per point (one thread, processor time)")
        ->check(wholeBetween(1, 100000000))
        ->type_name("N");
    c->add_option("--lanes", a->lanes, "SIMD width of the machine code, in points")
        ->check(CLI::IsMember({4, 8, 16}))
        ->type_name("N");
    c->add_option("--vectors", a->vectors, "Vectors in flight; 0: chosen by the compiler")
        ->check(wholeBetween(0, 4))
        ->type_name("K");
    c->add_option("--searchpath", a->searchPaths, "Folders for shaders, #include and maps, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Allow the shader to load plug-ins");
    c->footer(
        "The ball lies on a floor under a lamp and a sky, and is path-traced: a surface is on the ball, a displacement pushes "
        "it, a\n"
        "volume is the air, a light is the lamp, an imager sees the picture.\n"
        "The patch: P = (u, v, 0), u to the right and v downward over the picture, s = u, t = v, N = (0,0,1), seen from the eye "
        "at\n"
        "(0.5, 0.5, 1), so I = P - E; du and dv are a pixel. Cs = Os = 1. There are no lights and nothing else to be seen.\n\n"
        "Examples:\n  alpenglow shade examples/shaders/marble.sl -o marble.png\n"
        "  alpenglow shade plastic --param roughness=0.05 -o plastic.png\n"
        "  alpenglow shade pattern.sl --patch --output Ci -o pattern.exr");
    c->callback([a, status] { *status = shade(*a); });
}

} // namespace alpenglow::cli

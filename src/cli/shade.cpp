// alpenglow shade: a shader on a lit ball, or over a unit patch without a scene; also the stopwatch of the kernels.
#include "base/installation.h"
#include "cli/ball.h"
#include "cli/command.h"
#include "cli/patch.h"
#include "cli/ranges.h"
#include "display/imageio.h"
#include "render/imaging.h"
#include "rsl/compiler.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace alpenglow::cli {
namespace {

struct ShadeArguments {
    std::string shader, output = "out.exr", format = "256x256", kind, dialect;
    std::vector<std::string> params, searchPaths, outputs;
    int spp = 0, iterations = 0, lanes = 16, vectors = 0;
    float gamma = 0;
    bool allowExec = false, patch = false;
};

/// Of -o on standard output: PNG.
display::Format pictureFormat(const std::string& name) {
    return name == "-" ? display::Format::Png : display::formatOfExtension(name).value_or(display::Format::Exr);
}

using ShaderPtr = std::shared_ptr<const rsl::CompiledShader>;

/// The shader as one of the kind that was asked for: a class can be shaders of several kinds. Null after an error.
ShaderPtr ofAskedKind(const ShaderPtr& shader, const ShadeArguments& a, Diagnostics& diags) {
    std::string kinds;
    ShaderPtr wanted;
    for (const auto& s : shader->program().shaders) {
        if (s->name != shader->name()) continue;
        const std::string kind = rsl::toString(s->kind);
        kinds += (kinds.empty() ? "" : ", ") + kind;
        if (kind == a.kind) wanted = rsl::ShaderCompiler::variant(shader, s->kind);
    }
    if (!wanted) diags.report(Severity::Error, Rie::BadToken, {a.shader}, "it is no " + a.kind + " shader", "it is: " + kinds);
    return wanted;
}

/// Reads one --param, NAME=VALUE, into the value of that name and to the end of `given`. False after an error.
bool takeParameter(const std::string& argument, const std::string& shader, std::vector<rsl::ParameterValue>& values,
                   std::vector<rsl::ParameterValue>& given, Diagnostics& diags) {
    const size_t eq = argument.find('=');
    if (eq == std::string::npos || eq == 0)
        throw CLI::ValidationError("--param", "takes NAME=VALUE, for example Kd=0.5 or c=1,0,0");
    const std::string name = argument.substr(0, eq), text = argument.substr(eq + 1);
    const auto i = std::find_if(values.begin(), values.end(), [&](const rsl::ParameterValue& v) { return v.name == name; });
    if (i == values.end()) {
        std::vector<std::string> names;
        for (const auto& v : values) names.push_back(v.name);
        diags.report(Severity::Error, Rie::BadToken, {shader}, "it has no parameter \"" + name + "\"", nearestName(name, names));
        return false;
    }
    if (i->type.base == shadeops::Base::String) {
        i->strings = {text};
    } else {
        auto numbers = parseNumbers(text);
        const size_t want = i->numbers.size();
        if (numbers && numbers->size() == 1 && want == 3) numbers->assign(3, numbers->front());
        if (!numbers || numbers->size() != want) {
            diags.report(Severity::Error, Rie::BadToken, {shader},
                         "parameter \"" + name + "\" takes " + std::to_string(want) + " numbers");
            return false;
        }
        i->numbers.assign(numbers->begin(), numbers->end());
    }
    given.push_back(*i);
    return true;
}

/// Whether a picture of this format can show what a kernel computes without a scene; says why not.
bool canBeShown(const rsl::CompiledKernel& kernel, const rsl::CompiledShader& shader, display::Format format,
                const std::string& asked, Diagnostics& diags) {
    const bool png = !display::written(format).floats; // shows colours
    const auto colour = [&](const auto& o) { return o.name == "Ci"; };
    if (kernel.outputs().empty() || (png && std::none_of(kernel.outputs().begin(), kernel.outputs().end(), colour))) {
        std::string writes;
        for (const auto& o : kernel.outputs()) writes += (writes.empty() ? "" : ", ") + o.name;
        diags.report(Severity::Error, Rie::MissingData, {asked},
                     "this " + std::string(rsl::toString(shader.kind())) + " shader " +
                         (writes.empty()
                              ? "writes nothing that could be shown"
                              : std::string("writes no Ci for a ") + display::toString(format) + " picture, only " + writes),
                     writes.empty() ? "--output names what is to be shown" : "an EXR picture takes any values");
        return false;
    }
    if (kernel.facts().suspends)
        diags.report(Severity::Error, Rie::IllState, {asked}, "it waits for rays, and there is no scene here");
    return !kernel.facts().suspends;
}

/// Writes the picture of the patch, with colours alone where its format has no others.
bool writePatch(display::Image image, const ShadeArguments& a, display::Format format, Diagnostics& diags) {
    display::WriteOptions o;
    o.format = format;
    o.policy.allowWrite = true;
    if (!display::written(format).floats) {
        o.sample = display::Sample::UInt8;
        image = display::selectChannels(image, {"r", "g", "b"});
    }
    if (a.gamma > 0)
        for (float& f : image.data) f = render::expose(f, 1, a.gamma);
    return display::writeImage(a.output, image, o, diags);
}

/// Shades the patch. values: of all parameters; given: of those that the user set.
int shadePatch(const ShadeArguments& a, rsl::ShaderCompiler& compiler, const ShaderPtr& shader,
               std::vector<rsl::ParameterValue> values, const std::vector<rsl::ParameterValue>& given,
               const std::vector<std::string>& texturePaths, int width, int height, Diagnostics& diags) {
    rsl::KernelOptions options;
    options.lanes = a.lanes;
    options.vectors = a.vectors;
    options.outputs = a.outputs;
    if (!given.empty()) values = compiler.parameterValues(shader, diags, {}, given); // defaults may read what is given
    std::set<std::string> names;
    for (const auto& v : given) names.insert(v.name);
    options.computedParameters = shader->computedParameters(names, {});
    for (const auto& v : values)
        if (v.type.base == shadeops::Base::String && v.type.array == 0 && !v.strings.empty())
            options.stringParameters.emplace_back(v.name, v.strings[0]);
    const auto kernel = compiler.kernel(shader, options, diags);
    if (!kernel) return kNothingRendered;
    const display::Format format = pictureFormat(a.output);
    if (!canBeShown(*kernel, *shader, format, a.shader, diags)) return kNothingRendered;
    Patch patch(*kernel, std::move(values), texturePaths, width, height, diags);
    display::Image image = patch.picture(std::max(1, int(std::lround(std::sqrt(double(std::max(1, a.spp)))))));
    if (patch.stopped()) return kInterrupted;
    if (a.iterations > 0) patch.printTimes(a.iterations);
    if (!writePatch(std::move(image), a, format, diags)) return kOutputFailed;
    return diags.errors() ? kDoneWithErrors : kDone;
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
    ShaderPtr shader = compiler.load(a.shader, paths, patch ? diags : quiet);
    for (const Diagnostic& d : quiet.all())
        if (!shader) diags.report(d);
    if (!shader) return kNothingRendered;
    if (!a.kind.empty()) shader = ofAskedKind(shader, a, diags);
    if (!shader) return kWrongUse;
    std::vector<rsl::ParameterValue> values = compiler.parameterValues(shader, patch ? diags : quiet), given;
    for (const std::string& p : a.params)
        if (!takeParameter(p, a.shader, values, given, diags)) return kWrongUse;
    if (patch) return shadePatch(a, compiler, shader, std::move(values), given, texturePaths, width, height, diags);
    return shadeBall({a.shader, shader->kind(), given, a.output, width, height, a.spp, a.lanes, a.gamma, folders(a.searchPaths),
                      a.dialect, a.allowExec},
                     diags);
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

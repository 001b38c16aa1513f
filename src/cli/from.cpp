// alpenglow from: models and materials of other programs to RIB and RSL.
#include "base/file.h"
#include "base/installation.h"
#include "cli/command.h"
#include "cli/foreignmodel.h"
#include "cli/modelscene.h"
#include "cli/ranges.h"
#include "models/materialx.h"
#include "models/modelfile.h"
#include "ri/models/model.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

namespace alpenglow::cli {

namespace {

namespace fs = std::filesystem;

struct FromArguments {
    std::string input, output, material;
    models::RibOptions rib;
    bool noLights = false, quiet = false;
};

std::string ending(const std::string& path) {
    std::string e = fs::path(path).extension().string();
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    return e;
}

/// Writes what `make` gives piece by piece; an exit status. `make` says whether there was anything.
int writeTo(const std::string& name, Diagnostics& d,
            const std::function<bool(const std::function<void(std::string_view)>&)>& make) {
    auto out = OutputFile::open(name, {".", true}, d);
    if (!out) return kOutputFailed;
    if (!make([&](std::string_view t) { out->write(t.data(), t.size()); })) return kNothingRendered;
    if (!out->commit(d)) return kOutputFailed;
    return d.errors() ? kDoneWithErrors : kDone;
}

/// A surface of a MaterialX file; its maps are in the folder of the shader, which names them without a folder.
std::string shaderOf(const FromArguments& a, Diagnostics& d) {
    const fs::path out(a.output == "-" ? fs::path("material") : fs::path(a.output));
    std::string standard;
    if (const auto bytes = readWholeFile(shippedShaders() + "/standard.sl", size_t(1) << 20, d))
        standard.assign(bytes->begin(), bytes->end());
    models::Model pictures; // those that its graph uses
    ModelMaps maps(pictures, out.parent_path(), out.stem().string(), "", d);
    const models::MaterialxMaps make = [&](const models::MaterialxMap& m) {
        size_t at = 0;
        while (at < pictures.images.size() && pictures.images[at].file != m.file) ++at;
        if (at == pictures.images.size()) pictures.images.push_back({fs::path(m.file).filename().string(), m.file, {}});
        models::Texture t;
        t.image = int(at), t.s = m.u, t.t = m.v;
        return maps({&t, m.colour}).name;
    };
    return models::materialxShader({a.input, a.material, out.stem().string(), standard}, make, d);
}

int convertModel(FromArguments& a) {
    Diagnostics d(printer(a.quiet ? Severity::Error : Severity::Warning));
    if (::access(a.input.c_str(), R_OK) != 0) {
        d.report(Severity::Error, Rie::NoFile, {}, "\"" + a.input + "\" cannot be read");
        return kNothingRendered;
    }
    const bool mtlx = ending(a.input) == ".mtlx", foreign = models::namedAsForeignModel(a.input);
    if (!mtlx && !foreign && !ri::namedAsModel(a.input)) {
        d.report(Severity::Error, Rie::Incapable, {}, "\"" + a.input + "\" has an ending that is not known",
                 "docs/models.md lists what is read");
        return kWrongUse;
    }
    if (a.output.empty()) a.output = fs::path(a.input).stem().string() + (mtlx ? ".sl" : ".rib");
    if (fileIdentity(a.output) == fileIdentity(a.input)) throw CLI::ValidationError("-o", "names the model itself");
    return writeTo(a.output, d, [&](const std::function<void(std::string_view)>& text) {
        if (mtlx) {
            const std::string shader = shaderOf(a, d);
            text(shader);
            return !shader.empty();
        }
        if (!foreign) {
            text(modelScene(a.input));
            return true;
        }
        const fs::path out(a.output == "-" ? fs::path("model") : fs::path(a.output));
        a.rib.picture = out.stem().string() + ".png";
        return writeForeignScene(a.input, a.rib, out.parent_path(), out.stem().string(), "", text, d);
    });
}

} // namespace

void addFrom(CLI::App& app, int* status) {
    auto a = std::make_shared<FromArguments>();
    CLI::App* c = app.add_subcommand("from", "Write models and materials of other programs as RIB and RSL (docs/models.md)");
    c->add_option("model", a->input, "glTF, FBX, Collada, 3DS, ...: a scene in RIB; .mtlx: a shader in RSL")
        ->type_name("FILE")
        ->required();
    c->add_option("-o", a->output, "What is written; when not given the model's name with .rib or .sl, in the current folder")
        ->type_name("FILE");
    c->add_option("--time", a->rib.time, "Seconds of the animation at which the model is taken")->type_name("SECONDS");
    c->add_option("--shutter", a->rib.shutter, "Seconds that the shutter is open: what moves meanwhile is blurred")
        ->check(between(0, 1e6))
        ->type_name("SECONDS");
    c->add_option("--animation", a->rib.animation, "Which animation moves it, from 0; -1: none")
        ->check(wholeBetween(-1, 1000000))
        ->type_name("N");
    c->add_option("--camera", a->rib.camera, "Which camera of the model looks, from 0; -1: one that shows all of it")
        ->check(wholeBetween(-1, 1000000))
        ->type_name("N");
    c->add_option("--light-scale", a->rib.lightScale,
                  "Factor on candela and lux; 0.00146413 (1/683) for lights that were watts, as Blender writes them")
        ->check(positive())
        ->type_name("F");
    c->add_flag("--no-lights", a->noLights, "Add no sky and sun to a model without lights");
    c->add_option("--material", a->material, "Which material of an .mtlx file, by name; the first when not given")
        ->type_name("NAME");
    c->add_flag("-q,--quiet", a->quiet, "Errors only");
    c->footer("Maps are written next to the RIB. alpenglow model.glb renders a model at once.");
    c->callback([a, status] {
        a->rib.addLights = !a->noLights;
        *status = convertModel(*a);
    });
}

} // namespace alpenglow::cli

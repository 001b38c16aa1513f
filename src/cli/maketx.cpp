// alpenglow maketx: pictures to tiled MIP-mapped maps.
#include "cli/command.h"
#include "cli/ptexmesh.h"
#include "cli/ranges.h"
#include "texture/maketexture.h"
#include "texture/volume.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

namespace alpenglow::cli {

namespace {

struct MaketxArguments {
    std::vector<std::string> files;
    texture::MakeOptions options;
    std::string mode, smode, tmode, output, number = "half";
    std::vector<float> width;
    float fov = 90;
    int side = 8, radius = 1, smooth = 0;
    bool latlong = false, cube = false, shadow = false, faces = false, gradients = false, srgb = false, linear = false,
         newer = false;
};

void checkFiles(const MaketxArguments& a) {
    if (a.files.size() != (a.cube ? 7u : 2u))
        throw CLI::ValidationError("files", a.cube ? "--envcube takes six pictures and the map" : "takes a picture and the map");
    refuseOwnInput(a.files);
}

/// Whether the map is there and younger than all that it is made of.
bool upToDate(const std::vector<std::string>& files) {
    std::error_code ec;
    const auto made = std::filesystem::last_write_time(files.back(), ec);
    if (ec) return false;
    return std::none_of(files.begin(), files.end() - 1, [&](const std::string& f) {
        const auto t = std::filesystem::last_write_time(f, ec);
        return ec || t > made;
    });
}

bool makeMap(const MaketxArguments& a, const PtexOptions& faces, Diagnostics& diags) {
    const std::vector<std::string> in(a.files.begin(), a.files.end() - 1);
    const std::string& out = a.files.back();
    const texture::MakeOptions& o = a.options;
    if (a.faces) return makePtex(in[0], out, faces, diags);
    if (a.cube) return texture::makeCubeFaceEnvironment(in, out, a.fov, o, diags);
    if (a.latlong) return texture::makeLatLongEnvironment(in[0], out, o, diags);
    if (a.gradients) return texture::makeGradients(in[0], out, a.radius, a.smooth, o, diags);
    return a.shadow ? texture::makeShadow(in[0], out, o, diags) : texture::makeTexture(in[0], out, o, diags);
}

} // namespace

void addMaketx(CLI::App& app, int* status) {
    auto a = std::make_shared<MaketxArguments>();
    CLI::App* c = app.add_subcommand("maketx", "Make textures, environment and shadow maps of pictures");
    c->add_option("files", a->files, "Picture and output map; --envcube: six pictures (px nx py ny pz nz) and the output map")
        ->type_name("FILE")
        ->required();
    c->add_option("-o", a->output, "Output map, instead of the last file")->type_name("FILE");
    auto* kinds = c->add_option_group("Kind", "Kind of map; default: a texture");
    kinds->add_flag("--envlatl", a->latlong, "A latitude-longitude environment map");
    kinds->add_flag("--envcube", a->cube, "A cube environment map");
    kinds->add_flag("--shadow", a->shadow, "A shadow map of a depth picture");
    kinds->add_flag("--ptex", a->faces, "A Ptex file of a mesh with colours of its faces or vertices (PLY, in text)");
    kinds->add_flag(
        "--gradients", a->gradients,
        "A volume with the gradients of its opacity, of slices (\"s%03d.png\", \"strip.png*64\") or a grid of OpenVDB");
    kinds->require_option(0, 1);
    c->add_option("--side", a->side, "Ptex: pixels along each side of a face whose colour is not constant; a power of two")
        ->check(between(1, 4096))
        ->type_name("PIXELS");
    c->add_option("--number", a->number, "Ptex: number format")
        ->check(CLI::IsMember({"byte", "word", "half", "float"}))
        ->type_name("TYPE");
    auto wraps = CLI::IsMember({"black", "clamp", "periodic", "mirror"});
    c->add_option("--mode", a->mode, "Wrap mode: black, clamp, periodic or mirror")->check(wraps)->type_name("MODE");
    c->add_option("--smode", a->smode, "Wrap mode in s")->check(wraps)->type_name("MODE");
    c->add_option("--tmode", a->tmode, "Wrap mode in t")->check(wraps)->type_name("MODE");
    c->add_option("--filter", a->options.filter, "Filter of the reduced levels, for example box or sinc")->type_name("NAME");
    c->add_option("--width", a->width, "Factors of the filter width in s and t")
        ->expected(1, 2)
        ->check(positive())
        ->type_name("S [T]")
        ->allow_extra_args(false);
    c->add_flag("--newer", a->newer, "Make nothing if the map is newer than its pictures");
    auto* srgb = c->add_flag("--srgb", a->srgb, "Read the pictures as sRGB, whatever they declare, and store linear light");
    c->add_flag("--linear", a->linear, "Read the pictures as linear light or data, whatever they declare")->excludes(srgb);
    c->add_option("--fov", a->fov, "Field of view of the six pictures, in degrees")->check(between(1, 179))->type_name("DEGREES");
    c->add_option("--radius", a->radius, "--gradients: half the distance of a difference, in voxels")
        ->check(between(1, 64))
        ->type_name("N");
    c->add_option("--smooth", a->smooth, "--gradients: average over this many voxels on each side")
        ->check(between(0, 64))
        ->type_name("N");
    c->footer("The spellings of older tools work as well: -envlatl, -envcube, -shadow, -ptex, -mode, -smode, -tmode, -filter, "
              "-gradients. -resize, -format, -compression, -byte and the like are noted and have no effect (docs/options.md).");
    c->callback([a, status] {
        Diagnostics diags(printer());
        texture::MakeOptions& o = a->options;
        if (!a->output.empty()) a->files.push_back(a->output);
        checkFiles(*a);
        if (a->newer && upToDate(a->files)) return;
        std::string s = !a->smode.empty() ? a->smode : a->mode, t = !a->tmode.empty() ? a->tmode : a->mode;
        if (!s.empty()) o.swrap = s;
        if (!t.empty()) o.twrap = t;
        if (!a->width.empty()) {
            o.swidth = a->width.front();
            o.twidth = a->width.back();
        }
        using Colours = texture::MakeOptions::Colours;
        o.colours = a->srgb ? Colours::Srgb : a->linear ? Colours::Light : Colours::Auto;
        o.policy.allowWrite = true;
        PtexOptions faces;
        faces.number = ptex::Number::Byte;
        while (1 << faces.log < a->side) ++faces.log;
        if (1 << faces.log != a->side) throw CLI::ValidationError("--side", "takes a power of two");
        for (const char* name : {"byte", "word", "half", "float"}) {
            if (a->number == name) break;
            faces.number = ptex::Number(int(faces.number) + 1);
        }
        const bool ok = makeMap(*a, faces, diags);
        *status = ok ? (diags.errors() ? kDoneWithErrors : kDone) : kOutputFailed;
        if (ok) return;
        for (const Diagnostic& d : diags.all())
            if (d.code == Rie::NoFile || d.code == Rie::BadFile) *status = kNothingRendered;
    });
}

} // namespace alpenglow::cli

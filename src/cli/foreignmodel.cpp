#include "cli/foreignmodel.h"
#include "models/modelfile.h"
#include "texture/maketexture.h"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>

namespace alpenglow::cli {

namespace fs = std::filesystem;

namespace {

std::string temporaryFolder() {
    std::error_code e;
    std::string name = (fs::temp_directory_path(e) / "alpenglow-model-XXXXXX").string(); // mkdtemp wants the X
    return mkdtemp(name.data()) ? name : "";
}

const char* wordFor(models::Wrap w) {
    return w == models::Wrap::Clamp ? "clamp" : w == models::Wrap::Mirror ? "mirror" : "periodic";
}

/// Letters of names of pictures that are safe in names of files.
std::string letters(const std::string& name) {
    std::string out;
    for (const char c : fs::path(name).stem().string().substr(0, 40))
        out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
    return out;
}

/// Components of a JPEG: those of its frame header. ITU-T T.81, B.2.2.
int jpegChannels(const std::vector<uint8_t>& b) {
    for (size_t at = 2; at + 9 < b.size() && b[at] == 0xff;) {
        const int marker = b[at + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) return b[at + 9];
        at += 2 + size_t(b[at + 2]) * 256 + b[at + 3];
    }
    return 3;
}

} // namespace

int channelsOf(const std::vector<uint8_t>& b) {
    constexpr std::string_view kTransparent = "tRNS", png = "\x89PNG\r\n\x1a\n";
    if (b.size() > 33 && std::equal(png.begin(), png.end(), b.begin(), [](char x, uint8_t y) { return uint8_t(x) == y; })) {
        const bool transparent = std::search(b.begin(), b.end(), kTransparent.begin(), kTransparent.end()) != b.end();
        switch (b[25]) { // colour type of IHDR
        case 0:
            return transparent ? 2 : 1;
        case 4:
            return 2;
        case 6:
            return 4;
        default:
            return transparent ? 4 : 3;
        }
    }
    if (b.size() > 4 && b[0] == 0xff && b[1] == 0xd8) return jpegChannels(b);
    return 3;
}

ModelMaps::ModelMaps(const models::Model& m, fs::path folder, std::string stem, std::string before, Diagnostics& d)
    : model_(m), folder_(std::move(folder)), stem_(std::move(stem)), before_(std::move(before)), diags_(d) {}

ModelMaps::~ModelMaps() {
    std::error_code e;
    if (!own_.empty()) fs::remove_all(own_, e);
}

/// The file of a picture; those without one are written to a folder of ours.
std::string ModelMaps::source(int image) {
    const models::Image& i = model_.images[size_t(image)];
    if (!i.file.empty()) return i.file;
    if (own_.empty()) own_ = temporaryFolder();
    const fs::path to = own_ / ("picture" + std::to_string(image));
    std::ofstream out(to, std::ios::binary);
    out.write(reinterpret_cast<const char*>(i.bytes.data()), std::streamsize(i.bytes.size()));
    if (!own_.empty() && out.good()) return to.string();
    diags_.report(Severity::Error, Rie::DiskFull, {}, "pictures of the model cannot be written to the folder for temporary files",
                  "TMPDIR names another");
    return "";
}

std::string ModelMaps::nameFor(const Key& key) {
    const auto& [image, colour, s, t] = key;
    std::string name = letters(model_.images[size_t(image)].name);
    if (name.empty()) name = "picture" + std::to_string(image);
    name = stem_ + "_" + name;
    const int n = names_[name]++;
    return n ? fmt::format("{}_{}", name, n + 1) : name;
}

models::MapFile ModelMaps::operator()(const models::MapWish& wish) {
    const models::Texture& t = *wish.texture;
    const Key key{t.image, wish.colour, t.s, t.t};
    const auto [at, fresh] = made_.try_emplace(key);
    if (!fresh) return at->second;
    const std::string from = source(t.image);
    if (from.empty()) return {};
    texture::MakeOptions o;
    o.swrap = wordFor(t.s);
    o.twrap = wordFor(t.t);
    using Colours = texture::MakeOptions::Colours;
    o.colours = wish.colour ? Colours::Srgb : Colours::Light;
    o.policy.allowWrite = true;
    const std::string name = nameFor(key) + ".tex";
    if (!texture::makeTexture(from, (folder_ / name).string(), o, diags_)) return {};
    at->second.name = before_ + name;
    at->second.channels = channelsOf(model_.images[size_t(t.image)].bytes);
    return at->second;
}

bool writeForeignScene(const std::string& file, const models::RibOptions& options, const fs::path& mapFolder,
                       const std::string& stem, const std::string& before, const std::function<void(std::string_view)>& text,
                       Diagnostics& d) {
    const auto model = models::readForeignModel(file, d);
    if (!model) return false;
    ModelMaps maps(*model, mapFolder, stem, before, d);
    const models::MapMaker make = [&maps](const models::MapWish& w) { return maps(w); };
    models::writeRib(*model, options, make, text,
                     [&](std::string note) { d.report(Severity::Warning, Rie::Incapable, {file, 0, 0}, std::move(note)); });
    return true;
}

ModelFolder::~ModelFolder() {
    std::error_code e;
    if (!path_.empty()) fs::remove_all(path_, e);
}

const std::string& ModelFolder::pathFor(const std::vector<std::string>& scenes) {
    if (path_.empty() && std::any_of(scenes.begin(), scenes.end(), models::namedAsForeignModel)) path_ = temporaryFolder();
    return path_;
}

std::string ModelFolder::scene(const std::string& file, double time, Diagnostics& d) {
    models::RibOptions o;
    o.picture = fs::path(file).stem().string() + ".png";
    o.time = time;
    std::string text;
    const fs::path folder = pathFor({file});
    const std::string stem = "m" + std::to_string(++count_);
    return writeForeignScene(file, o, folder, stem, folder.string() + "/", [&](std::string_view t) { text += t; }, d) ? text : "";
}

} // namespace alpenglow::cli

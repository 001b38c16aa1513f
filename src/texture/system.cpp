// TextureSystem: finding, loading and keeping maps.
#include "base/exact.h"
#include "base/file.h"
#include "base/filternames.h"
#include "base/memory.h"
#include "base/srgb.h"
#include "display/imageio.h"
#include "texture/lookup.h"
#include "texture/scratch.h"
#include "texture/texture.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

namespace alpenglow::texture {

const char* const cubeFormat = "CubeFace Environment";

namespace {

constexpr const char* kFace = "<FACE>";
constexpr const char* kFaceNames[] = {"px", "nx", "py", "ny", "pz", "nz"};

/// Makes a level from the numbers of a picture, which it moves.
Level levelOf(display::Image& m, bool codes) {
    Level l;
    l.width = m.width;
    l.height = m.height;
    l.channels = m.channelCount();
    if (codes) {
        std::vector<uint8_t> numbers;
        numbers.reserve(m.data.size() + Texels<uint8_t>::kBeyond);
        for (const float v : m.data) // the nearest
            numbers.push_back(v > 0 ? uint8_t(double(std::min(v, 1.0f) * 255.0f) + 0.5) : uint8_t(0));
        m.data = {};
        l.codes = std::move(numbers);
    } else {
        l.values = std::move(m.data);
    }
    return l;
}

/// The curve by which the numbers of a picture are light. Empty: they are light.
using Decode = std::function<float(float)>;

/// The declared curve of a file; optionally a default for 8-bit pictures.
Decode decodeOf(const display::Image& m, bool undeclared) {
    const std::string space = textOf(m, "colorspace");
    if (space == "sRGB") return [](float v) { return srgbDecode(std::max(0.0f, v)); };
    const double gamma = std::atof(textOf(m, "gamma").c_str());
    if (gamma > 0.01 && gamma <= 100) {
        if (std::fabs(gamma - 1) < 0.01) return {};
        return [gamma](float v) { return float(exact::pow(std::max(0.0, double(v)), 1 / gamma)); };
    }
    // Maps of maketx are floats: metadata says the kind of their picture.
    const bool eight = (m.bits == 8 && !m.floating && space.empty()) || space == kEightBits;
    if (undeclared && eight && textOf(m, "textureformat") != "Shadow")
        return [](float v) { return srgbDecode(std::max(0.0f, v)); };
    return {};
}

/// Channels that hold colours; alpha and data are numbers.
uint32_t colourChannels(const display::Image& m) {
    uint32_t bits = 0;
    for (size_t c = 0; c < std::min<size_t>(m.channels.size(), 32); ++c)
        for (const char* name : {"r", "g", "b", "y"}) bits |= uint32_t(m.channels[c] == name) << c;
    return bits;
}

void decode(display::Image& m, const Decode& curve) {
    const uint32_t colours = colourChannels(m);
    const size_t n = m.channels.size();
    for (size_t i = 0; i < m.data.size(); ++i)
        if (i % n < 32 && (colours >> (i % n) & 1)) m.data[i] = curve(m.data[i]);
}

/// Whether all numbers are one of the 256 values of 8 bits: codes then store them exactly, in a quarter of the memory. Maps made
/// of such pictures are float files.
bool fitsCodes(const display::Image& m) {
    for (float v : m.data) {
        const float code = v * 255.0f + 0.5f;
        if (!(code >= 0 && code < 256) || kCodeValues[size_t(code)] != v) return false;
    }
    return true;
}

/// The light of the numbers of a picture, which are in the level.
display::Image lightOf(const display::Image& picture, const Level& level, const Decode& curve) {
    display::Image light = display::makeImage(picture.width, picture.height, picture.channels);
    light.data.assign(level.values.data(), level.values.data() + level.values.size());
    decode(light, curve);
    return light;
}

/// The same for a level of codes, row by row: floats would take four times the memory.
PictureRows lightRowsOf(const display::Image& picture, const Level& level) {
    const auto read = [&level](int y, float* to) {
        const auto n = size_t(level.channels), row = size_t(level.width) * n, first = size_t(y) * row;
        for (size_t i = 0; i < row; i += n)
            for (size_t c = 0; c < n; ++c) to[i + c] = level.texel(first + i + c, int(c), true);
    };
    return {picture.width, picture.height, picture.channels, read};
}

/// Adds to the levels of a texture those of its light.
void addLight(Texture& tex, const display::Image& picture, const Decode& curve, Wrap swrap, Wrap twrap) {
    Level& first = tex.levels.front();
    if (!first.codes.empty()) {
        CodeTable table;
        for (size_t k = 0; k < table.size(); ++k) table[k] = curve(float(k) / 255.0f);
        first.table = std::make_shared<const CodeTable>(table);
        first.colours = colourChannels(picture);
    }
    if (tex.levels.size() == 1 && !first.codes.empty()) return;
    display::Image light;
    if (first.codes.empty()) light = lightOf(picture, first, curve);
    size_t at = 1;
    for (display::Image& l : first.codes.empty() ? reducedLevels(light, {}, swrap, twrap)
                                                 : reducedLevels(lightRowsOf(picture, first), {}, swrap, twrap))
        if (at < tex.levels.size()) tex.levels[at++].light = std::move(l.data);
    if (first.codes.empty()) first.light = std::move(light.data);
}

} // namespace

std::string textOf(const display::Image& m, const char* key) {
    auto i = m.metadata.find(key);
    return i == m.metadata.end() ? std::string() : i->second;
}

void toLight(display::Image& m) {
    decode(m, [](float v) { return srgbDecode(std::max(0.0f, v)); });
}

size_t Texture::bytes() const {
    size_t n = 0;
    for (const Level& l : levels) n += l.bytes();
    if (deep) n += deep->steps.size() * sizeof(display::DeepStep) + deep->first.size() * sizeof(uint64_t);
    for (auto& [number, tile] : tiles) n += tile->bytes();
    return n;
}

std::optional<Filter> filterByName(std::string_view n) {
    constexpr std::pair<const char*, Filter> kNames[] = {{"box", Filter::Box},
                                                         {"point", Filter::Box},
                                                         {"triangle", Filter::Triangle},
                                                         {"gaussian", Filter::Gaussian},
                                                         {"b-spline", Filter::Gaussian},
                                                         {"blackman-harris", Filter::Gaussian},
                                                         {"radial-bspline", Filter::Gaussian},
                                                         {"disk", Filter::Disk},
                                                         {"catmull-rom", Filter::CatmullRom},
                                                         {"separable-catmull-rom", Filter::SeparableCatmullRom},
                                                         {"mitchell", Filter::Mitchell},
                                                         {"sinc", Filter::Sinc},
                                                         {"lanczos", Filter::Lanczos},
                                                         {"bessel", Filter::Bessel}};
    const std::string same = filterNameOf(n);
    for (const auto& [name, filter] : kNames)
        if (same == name) return filter;
    return {};
}

/// Whether a shadow map has no surface in any of its texels: only depths that stand for none (1e30 of a zfile, RI_INFINITY).
static bool holdsNoDepth(const Texture& map) {
    constexpr float kNothing = 1e30f;
    if (map.deep) return map.deep->steps.empty();
    const Level& l = map.levels[0];
    if (!l.codes.empty() || l.channels < 1) return false;
    for (size_t i = 0; i < l.values.size(); i += size_t(l.channels))
        if (l.values[i] < kNothing) return false;
    return true;
}

std::shared_ptr<const Texture> makeTextureFrom(display::Image image, const TextureSettings& settings) {
    auto tex = std::make_shared<Texture>();
    auto text = [&](const char* key) { return textOf(image, key); };
    tex->channels = image.channels;
    tex->bits = image.bits;
    tex->floating = image.floating;
    tex->worldToCamera = image.worldToCamera;
    tex->worldToNDC = image.worldToNDC;
    tex->swrap = tex->twrap = settings.plainWrap;
    tex->gamma = float(std::atof(text("gamma").c_str()));
    std::string wraps = text("wrapmodes");
    size_t comma = wraps.find(',');
    if (auto w = wrapByName(wraps.substr(0, comma))) tex->swrap = tex->twrap = *w;
    if (comma != std::string::npos)
        if (auto w = wrapByName(wraps.substr(comma + 1))) tex->twrap = *w;
    std::string format = text("textureformat");
    tex->kind = format == "Shadow" ? Kind::Shadow : format.rfind("LatLong", 0) == 0 ? Kind::LatLong : Kind::Texture;
    if (format == cubeFormat && image.height >= 6 && image.height % 6 == 0) {
        tex->kind = Kind::Cube;
        double cot = std::atof(text("fovcot").c_str());
        tex->fovCotangent = cot > 0 && cot <= 1000 ? float(cot) : 1.0f;
        display::Image face = display::makeImage(image.width, image.height / 6, image.channels);
        face.bits = image.bits;
        face.floating = image.floating;
        for (const char* key : {"colorspace", "gamma"})
            if (!text(key).empty()) face.metadata[key] = text(key);
        for (int i = 0; i < 6; ++i) {
            std::copy_n(image.pixel(0, i * face.height), face.data.size(), face.data.data());
            tex->tiles[i] = makeTextureFrom(face, settings);
        }
        return tex;
    }
    const bool codes = (image.bits == 8 && !image.floating) || (text("colorspace") == kEightBits && fitsCodes(image));
    if (tex->kind == Kind::Shadow) { // depths have no mean
        tex->levels.push_back(levelOf(image, codes));
        tex->deep = image.deep;
        return tex;
    }
    // The levels in the file; those below the last (files may end at 2x1) are computed.
    const size_t stored = storedLevels(image);
    const bool round = tex->kind == Kind::LatLong;
    const Wrap swrap = round ? Wrap::Periodic : tex->swrap, twrap = round ? Wrap::Clamp : tex->twrap;
    std::vector<display::Image> below = reducedLevels(stored ? image.levels[stored - 1] : image, {}, swrap, twrap);
    tex->levels.push_back(levelOf(image, codes));
    for (size_t i = 0; i < stored; ++i) tex->levels.push_back(levelOf(image.levels[i], false));
    for (display::Image& l : below) tex->levels.push_back(levelOf(l, false));
    if (settings.light)
        if (const Decode curve = decodeOf(image, true)) addLight(*tex, image, curve, swrap, twrap);
    return tex;
}

/// One file or request, loaded once by the first thread.
struct TextureSystem::Entry {
    std::once_flag once;
    std::shared_ptr<const Texture> texture;
};

TextureSystem::TextureSystem(Diagnostics& d, TextureSettings s) : diags_(d), settings_(std::move(s)), limit_(settings_.memory) {
    constexpr size_t unknown = size_t(1) << 30; // if the system does not report its memory
    if (!limit_) limit_ = machineMemory() ? machineMemory() / 4 : unknown;
}
TextureSystem::~TextureSystem() = default;

std::shared_ptr<const Texture> TextureSystem::load(const std::string& path, const SourcePlace& place) {
    std::shared_ptr<Entry> entry;
    {
        std::lock_guard lock(mutex_);
        auto& e = byPath_[path];
        if (!e) e = std::make_shared<Entry>();
        entry = e;
    }
    std::call_once(entry->once, [&] {
        display::ReadOptions options;
        options.levels = true;
        options.place = place;
        auto image = display::readImage(path, diags_, options);
        if (!image) return;
        try {
            if (const Decode curve = settings_.linearise && !settings_.light ? decodeOf(*image, false) : Decode()) {
                decode(*image, curve);
                image->floating = true; // values are no longer codes
                image->levels.clear();
            }
            auto tex = std::const_pointer_cast<Texture>(makeTextureFrom(std::move(*image), settings_));
            tex->path = path;
            pageOut(*tex, place);
            if (tex->kind == Kind::Shadow && holdsNoDepth(*tex))
                diags_.report(Severity::Warning, Rie::MissingData, place,
                              "shadow map \"" + path + "\" is empty: nothing in it casts a shadow",
                              "did the camera of its frame see anything?");
            entry->texture = tex;
        } catch (const std::bad_alloc&) {
            diags_.report(Severity::Error, Rie::NoMem, place, "texture \"" + path + "\": out of memory");
        }
    });
    return entry->texture;
}

std::shared_ptr<const Texture> TextureSystem::loadFile(const std::string& name, const std::vector<std::string>& searchPath,
                                                       const SourcePlace& place) {
    std::string outside;
    auto found = findFile(name, searchPath, settings_.read, &outside);
    if (!found && !outside.empty()) {
        diags_.reportOnce("texture:" + name, outsideMessage("texture", name, outside, place));
        return {};
    }
    if (settings_.reads) found ? settings_.reads->add(found->path) : settings_.reads->addMissing(name, searchPath);
    Diagnostic d;
    d.place = place;
    if (!found) {
        d.severity = Severity::Error;
        d.code = Rie::NoFile;
        d.message = "texture \"" + name + "\" was not found";
        std::string dirs;
        for (const std::string& s : searchPath) {
            const std::string folder = s.empty() ? "." : s;
            if ((":" + dirs + ":").find(":" + folder + ":") == std::string::npos) dirs += (dirs.empty() ? "" : ":") + folder;
        }
        d.hint = "searched: " + dirs;
        diags_.reportOnce("texture:" + name, d);
        return {};
    }
    if (found->otherCase || found->baseNameOnly) {
        d.severity = Severity::Warning;
        d.message = "texture \"" + name + "\" was not found as named; \"" + found->path + "\" is used";
        diags_.reportOnce("texture:" + name, d);
    }
    return load(found->path, place);
}

std::optional<std::pair<size_t, size_t>> tileNumberIn(const std::string& name) {
    // Longer spellings first: they hold the shorter ones.
    for (const std::string_view spelling : {"<UDIM>", "<udim>", "%(UDIM)d", "_MAPID_", "UDIM"})
        if (const size_t at = name.find(spelling); at != std::string::npos) return {{at, spelling.size()}};
    return {};
}

std::shared_ptr<const Texture> TextureSystem::loadTiles(const std::string& name, const std::vector<std::string>& searchPath,
                                                        const SourcePlace& place) {
    const auto [from, length] = *tileNumberIn(name);
    auto tex = std::make_shared<Texture>();
    tex->path = name;
    for (int number = 1001; number <= 1100; ++number) {
        std::string tile = name;
        tile.replace(from, length, std::to_string(number));
        std::string outside;
        auto found = findFile(tile, searchPath, settings_.read, &outside);
        if (!outside.empty()) diags_.reportOnce("texture:" + name, outsideMessage("texture", name, outside, place));
        if (!found) continue;
        if (auto t = load(found->path, place)) tex->tiles[number] = t;
    }
    if (tex->tiles.empty()) {
        Diagnostic d;
        d.code = Rie::NoFile;
        d.place = place;
        d.message = "texture \"" + name + "\": no tile from 1001 to 1100 was found";
        diags_.reportOnce("texture:" + name, d);
        return {};
    }
    const Texture& one = *tex->tiles.begin()->second;
    tex->channels = one.channels;
    tex->bits = one.bits;
    tex->floating = one.floating;
    return tex;
}

std::shared_ptr<const Texture> TextureSystem::loadFaces(const std::string& name, const std::vector<std::string>& searchPath,
                                                        const SourcePlace& place) {
    auto cube = std::make_shared<Texture>();
    cube->path = name;
    cube->kind = Kind::Cube;
    int face = 0;
    for (const char* which : kFaceNames) {
        std::string one = name;
        const auto map = loadFile(one.replace(name.find(kFace), std::strlen(kFace), which), searchPath, place);
        if (!map) return {};
        if (map->levels.empty()) {
            diags_.reportOnce(
                "texture:" + name,
                {Severity::Error, Rie::BadFile, place, "cube map \"" + name + "\": face " + which + " is no picture", {}, {}});
            return {};
        }
        if (face == 0) {
            cube->channels = map->channels;
            cube->bits = map->bits;
            cube->floating = map->floating;
        }
        cube->tiles[face++] = map;
    }
    return cube;
}

bool TextureSystem::find(const std::string& name, const std::vector<std::string>& searchPath) const {
    std::string outside;
    return findFile(name, searchPath, settings_.read, &outside).has_value();
}

Handle TextureSystem::open(const std::string& name, const std::vector<std::string>& searchPath, const SourcePlace& place) {
    std::string key = name;
    for (const std::string& d : searchPath) key += '\n' + d;
    std::shared_ptr<Entry> entry;
    {
        std::lock_guard lock(mutex_);
        auto& e = byRequest_[key];
        if (!e) e = std::make_shared<Entry>();
        entry = e;
    }
    std::call_once(entry->once, [&] {
        const bool sixFaces = name.find(kFace) != std::string::npos && !find(name, searchPath);
        if (sixFaces) return void(entry->texture = loadFaces(name, searchPath, place));
        bool tiles = tileNumberIn(name) && !find(name, searchPath);
        entry->texture = tiles ? loadTiles(name, searchPath, place) : loadFile(name, searchPath, place);
    });
    return entry->texture.get();
}

bool TextureSystem::present(const std::string& name, const std::vector<std::string>& searchPath) {
    std::string key = name;
    for (const std::string& d : searchPath) key += '\n' + d;
    std::lock_guard lock(mutex_);
    const auto [known, fresh] = present_.try_emplace(key, false);
    if (!fresh) return known->second;
    std::string outside;
    bool there = findFile(name, searchPath, settings_.read, &outside).has_value();
    if (!there && !outside.empty()) {
        Diagnostic d = outsideMessage("texture", name, outside, {});
        d.message += "; to textureinfo() it is missing";
        diags_.reportOnce("textureinfo:" + name, d);
    }
    if (const auto number = tileNumberIn(name); !there && number)
        for (int k = 1001; k <= 1100 && !there; ++k) {
            std::string tile = name;
            there = find(tile.replace(number->first, number->second, std::to_string(k)), searchPath);
        }
    if (const size_t at = name.find(kFace); !there && at != std::string::npos) {
        there = true;
        for (const char* which : kFaceNames)
            there = there && find(std::string(name).replace(at, std::strlen(kFace), which), searchPath);
    }
    return known->second = there;
}

std::optional<TextureInfo> TextureSystem::info(Handle h) const {
    if (!h) return {};
    const Texture& t = h->tiles.empty() ? *h : *h->tiles.begin()->second;
    TextureInfo i;
    i.width = t.width();
    i.height = t.height();
    i.channels = int(t.channels.size());
    i.bits = t.bits;
    i.floating = t.floating;
    i.type = t.kind == Kind::Shadow ? "shadow" : h->kind == Kind::LatLong || h->kind == Kind::Cube ? "environment" : "texture";
    i.swrap = t.swrap;
    i.twrap = t.twrap;
    if (t.gamma > 0) i.gamma = t.gamma;
    i.faces = h->kind == Kind::Cube ? 6 : 0;
    i.alpha = std::find(t.channels.begin(), t.channels.end(), "a") != t.channels.end();
    i.viewing = t.worldToCamera;
    if (t.worldToNDC) i.projection = *t.worldToNDC * inverse(display::screenToNDC());
    return i;
}

size_t TextureSystem::bytes() const {
    std::lock_guard lock(mutex_);
    size_t n = 0;
    for (auto& [path, e] : byPath_)
        if (e->texture) n += e->texture->bytes();
    return n + scratchBytes();
}

std::vector<TextureSystem::File> TextureSystem::files() const {
    std::lock_guard lock(mutex_);
    std::vector<File> all;
    for (const auto& [path, e] : byPath_) {
        if (!e->texture) continue;
        const Texture& t = *e->texture;
        std::error_code none; // a file that has gone meanwhile has no size
        const auto size = std::filesystem::file_size(path, none);
        all.push_back({path, none ? 0 : size_t(size), t.bytes(), t.scratch ? t.scratch->size() : 0});
        for (const auto& [number, face] : t.tiles) all.back().scratch += face->scratch ? face->scratch->size() : 0;
    }
    return all;
}

void TextureSystem::forget() {
    std::lock_guard lock(mutex_);
    byRequest_.clear();
    byPath_.clear();
    present_.clear();
    std::lock_guard trimming(trimming_);
    files_.clear();
    scratches_ = 0;
    held_ = 0;
}

} // namespace alpenglow::texture

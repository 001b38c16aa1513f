// TextureSystem: finding, loading and keeping maps.
#include "base/file.h"
#include "display/imageio.h"
#include "texture/lookup.h"
#include "texture/texture.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {

const char* const cubeFormat = "CubeFace Environment";

namespace {

Level levelOf(const display::Image& m, bool codes) {
    Level l;
    l.width = m.width;
    l.height = m.height;
    l.channels = m.channelCount();
    if (codes) {
        l.codes.resize(m.data.size());
        for (size_t i = 0; i < m.data.size(); ++i) l.codes[i] = uint8_t(std::lround(std::clamp(m.data[i], 0.0f, 1.0f) * 255.0f));
    } else {
        l.values = m.data;
    }
    return l;
}

/// Whether some colour value was changed: files that declare a gamma give linear colours; alpha and data stay.
bool linearise(display::Image& m) {
    auto find = [&](const char* key) {
        auto i = m.metadata.find(key);
        return i == m.metadata.end() ? std::string() : i->second;
    };
    bool srgb = find("colorspace") == "sRGB";
    double gamma = srgb ? 1 : std::atof(find("gamma").c_str());
    if (!srgb && (!(gamma > 0.01) || gamma > 100 || std::fabs(gamma - 1) < 0.01)) return false;
    size_t n = m.channels.size();
    for (size_t c = 0; c < n; ++c) {
        const std::string& name = m.channels[c];
        if (name != "r" && name != "g" && name != "b" && name != "y") continue;
        for (size_t i = c; i < m.data.size(); i += n) {
            double v = std::max(0.0, double(m.data[i]));
            m.data[i] = float(srgb ? (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)) : std::pow(v, 1 / gamma));
        }
    }
    return true;
}

} // namespace

size_t Texture::bytes() const {
    size_t n = 0;
    for (const Level& l : levels) n += l.bytes();
    for (auto& [number, tile] : tiles) n += tile->bytes();
    return n;
}

std::optional<Filter> filterByName(std::string_view n) {
    for (const char* k :
         {"box", "disk", "point", "catmull-rom", "separable-catmull-rom", "mitchell", "lanczos", "sinc", "bessel"})
        if (n == k) return Filter::Box;
    if (n == "triangle") return Filter::Triangle;
    for (const char* k : {"gaussian", "b-spline", "blackman-harris", "radial-bspline"})
        if (n == k) return Filter::Gaussian;
    return {};
}

std::shared_ptr<const Texture> makeTextureFrom(const display::Image& image, const TextureSettings& settings) {
    auto tex = std::make_shared<Texture>();
    auto text = [&](const char* key) {
        auto i = image.metadata.find(key);
        return i == image.metadata.end() ? std::string() : i->second;
    };
    tex->channels = image.channels;
    tex->bits = image.bits;
    tex->floating = image.floating;
    tex->worldToCamera = image.worldToCamera;
    tex->worldToNDC = image.worldToNDC;
    tex->swrap = tex->twrap = settings.plainWrap;
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
        for (int i = 0; i < 6; ++i) {
            std::copy_n(image.pixel(0, i * face.height), face.data.size(), face.data.data());
            tex->tiles[i] = makeTextureFrom(face, settings);
        }
        return tex;
    }
    tex->levels.push_back(levelOf(image, image.bits == 8 && !image.floating));
    if (tex->kind == Kind::Shadow) return tex; // depths have no mean
    // The levels that the file has; below the last of them (files may end at 2x1) they are made.
    const size_t stored = storedLevels(image);
    for (size_t i = 0; i < stored; ++i) tex->levels.push_back(levelOf(image.levels[i], false));
    bool round = tex->kind == Kind::LatLong;
    for (const display::Image& l : reducedLevels(stored ? image.levels[stored - 1] : image, {},
                                                 round ? Wrap::Periodic : tex->swrap, round ? Wrap::Clamp : tex->twrap))
        tex->levels.push_back(levelOf(l, false));
    return tex;
}

/// One file or request: loaded once, by whoever comes first.
struct TextureSystem::Entry {
    std::once_flag once;
    std::shared_ptr<const Texture> texture;
};

TextureSystem::TextureSystem(Diagnostics& d, TextureSettings s) : diags_(d), settings_(s) {}
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
            if (settings_.linearise && linearise(*image)) {
                image->floating = true; // values are no longer codes
                image->levels.clear();
            }
            auto tex = std::const_pointer_cast<Texture>(makeTextureFrom(*image, settings_));
            tex->path = path;
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
    Diagnostic d;
    d.place = place;
    if (!found) {
        d.severity = Severity::Error;
        d.code = Rie::NoFile;
        d.message = "texture \"" + name + "\" was not found";
        std::string dirs;
        for (const std::string& s : searchPath) dirs += (dirs.empty() ? "" : ":") + (s.empty() ? "." : s);
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

std::shared_ptr<const Texture> TextureSystem::loadTiles(const std::string& name, const std::vector<std::string>& searchPath,
                                                        const SourcePlace& place) {
    size_t at = name.find("UDIM"), from = at, length = 4;
    if (at > 0 && name[at - 1] == '<' && at + 4 < name.size() && name[at + 4] == '>') {
        --from;
        length = 6;
    }
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
        bool tiles = name.find("UDIM") != std::string::npos && !find(name, searchPath);
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
    bool there = find(name, searchPath);
    if (size_t at = name.find("UDIM"); !there && at != std::string::npos) {
        size_t length = 4;
        if (at > 0 && name[at - 1] == '<' && at + 4 < name.size() && name[at + 4] == '>') --at, length = 6;
        for (int number = 1001; number <= 1100 && !there; ++number) {
            std::string tile = name;
            there = find(tile.replace(at, length, std::to_string(number)), searchPath);
        }
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
    i.viewing = t.worldToCamera;
    if (t.worldToNDC) i.projection = *t.worldToNDC * inverse(display::screenToNDC());
    return i;
}

size_t TextureSystem::bytes() const {
    std::lock_guard lock(mutex_);
    size_t n = 0;
    for (auto& [path, e] : byPath_)
        if (e->texture) n += e->texture->bytes();
    return n;
}

void TextureSystem::forget() {
    std::lock_guard lock(mutex_);
    byRequest_.clear();
    byPath_.clear();
}

} // namespace alpenglow::texture

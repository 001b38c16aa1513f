#include "texture/maketexture.h"
#include "base/exact.h"
#include "base/realpath.h"
#include "display/imageio.h"
#include "pointcloud/bakefile.h"
#include "pointcloud/brickstream.h"
#include "texture/lookup.h"
#include <cmath>

namespace alpenglow::texture {
namespace {

constexpr int tileSide = 64; // 48 KiB of rgb floats: one disk read, a few cache ways

/// Reads baked data as a picture of light or data.
std::optional<display::Image> readBaked(const std::string& path, const MakeOptions& o, Diagnostics& diags) {
    const auto baked = pointcloud::loadBaked(path, diags, o.place);
    if (!baked) return {};
    pointcloud::BakedPicture p = pointcloud::pictureOf(*baked);
    if (p.outside > 0)
        diags.report(Severity::Warning, Rie::Range, o.place,
                     "\"" + path + "\": " + std::to_string(p.outside) + " of " + std::to_string(baked->size()) +
                         " points have s or t outside of 0 to 1; they are dropped");
    display::Image image = display::makeImage(p.side, p.side, display::defaultChannels(p.channels));
    image.data = std::move(p.pixels);
    image.metadata["colorspace"] = kLight;
    return image;
}

/// Whether a map would replace its own source, which is an error and reported.
bool replacesIts(const char* source, const std::string& path, const std::string& map, const MakeOptions& o, Diagnostics& diags) {
    if (!sameFile(path, map)) return false;
    diags.report(Severity::Error, Rie::Consistency, o.place,
                 "\"" + map + "\" is not made: it would replace the " + source + " \"" + path + "\", of which it is made",
                 "give it another name");
    return true;
}

/// Reads the picture for `map`.
std::optional<display::Image> readPicture(const std::string& given, const std::string& map, const MakeOptions& o,
                                          Diagnostics& diags) {
    bool binary = false;
    const std::string name = pointcloud::bakeFileName(given, &binary);
    std::string outside;
    auto found = findFile(name, o.searchPath, o.read, &outside);
    if (!found && !outside.empty()) {
        diags.report(outsideMessage("picture", name, outside, o.place));
        return {};
    }
    if (!found) {
        diags.report(Severity::Error, Rie::NoFile, o.place, "picture \"" + name + "\" was not found");
        return {};
    }
    if (found->otherCase || found->baseNameOnly)
        diags.report(Severity::Warning, Rie::NoError, o.place,
                     "picture \"" + name + "\" was not found as named; \"" + found->path + "\" is used");
    if (replacesIts("picture", found->path, map, o, diags)) return {};
    if (pointcloud::isBaked(found->path)) return readBaked(found->path, o, diags);
    display::ReadOptions r;
    r.place = o.place;
    auto image = display::readImage(found->path, diags, r);
    if (image) {
        // A map is not part of a larger picture.
        image->originX = image->originY = image->fullWidth = image->fullHeight = 0;
        if (o.colours == MakeOptions::Colours::Auto) {
            if (image->bits == 8 && !image->floating && !image->metadata.contains("colorspace") &&
                !image->metadata.contains("gamma"))
                image->metadata["colorspace"] = kEightBits;
        } else {
            if (o.colours == MakeOptions::Colours::Srgb) toLight(*image);
            image->metadata.erase("gamma");
            image->metadata["colorspace"] = kLight;
        }
    }
    return image;
}

bool writeMap(const std::string& name, const display::Image& image, const MakeOptions& o, Diagnostics& diags) {
    display::WriteOptions w;
    w.format = display::Format::Exr;
    w.sample = image.floating && image.bits == 16 ? display::Sample::Half : display::Sample::Float;
    w.tile = tileSide;
    w.policy = o.policy;
    w.place = o.place;
    return display::writeImage(name, image, w, diags);
}

Wrap wrapOr(const std::string& name, Wrap fallback, const MakeOptions& o, Diagnostics& diags) {
    if (auto w = wrapByName(name)) return *w;
    diags.report(Severity::Error, Rie::BadToken, o.place,
                 "unknown wrap mode \"" + name + "\"; \"" + nameOf(fallback) + "\" is used",
                 "wrap modes are black, clamp, periodic, mirror");
    return fallback;
}

Reduction reductionOf(const MakeOptions& o, Diagnostics& diags) {
    Reduction r{o.filter, o.swidth, o.twidth};
    if (!isReductionFilter(o.filter)) {
        diags.report(Severity::Error, Rie::BadToken, o.place, "unknown filter \"" + o.filter + "\"; \"box\" is used");
        r.filter = "box";
    }
    for (float* w : {&r.swidth, &r.twidth})
        if (!(*w > 0 && *w <= 1024)) {
            diags.report(Severity::Error, Rie::Range, o.place, "a filter width must be > 0 and at most 1024; 1 is used");
            *w = 1;
        }
    return r;
}

bool makeMap(const std::string& picture, const std::string& texture, const MakeOptions& o, Wrap swrap, Wrap twrap,
             const char* format, Diagnostics& diags) {
    auto image = readPicture(picture, texture, o, diags);
    if (!image) return false;
    image->metadata["wrapmodes"] = std::string(nameOf(swrap)) + "," + nameOf(twrap);
    image->metadata["textureformat"] = format;
    image->metadata["Software"] = "Alpenglow";
    try {
        image->levels = reducedLevels(*image, reductionOf(o, diags), swrap, twrap);
    } catch (const std::bad_alloc&) {
        diags.report(Severity::Error, Rie::NoMem, o.place, "picture \"" + picture + "\": out of memory");
        return false;
    }
    return writeMap(texture, *image, o, diags);
}

} // namespace

bool makeTexture(const std::string& picture, const std::string& texture, const MakeOptions& o, Diagnostics& diags) {
    Wrap s = wrapOr(o.swrap, Wrap::Black, o, diags), t = wrapOr(o.twrap, Wrap::Black, o, diags);
    return makeMap(picture, texture, o, s, t, "Plain Texture", diags);
}

bool makeLatLongEnvironment(const std::string& picture, const std::string& texture, const MakeOptions& o, Diagnostics& diags) {
    return makeMap(picture, texture, o, Wrap::Periodic, Wrap::Clamp, "LatLong Environment", diags);
}

bool makeShadow(const std::string& zfile, const std::string& shadow, const MakeOptions& o, Diagnostics& diags) {
    auto image = readPicture(zfile, shadow, o, diags);
    if (!image) return false;
    display::Image z = display::selectChannels(*image, {image->channel("z") >= 0 ? "z" : image->channels[0]});
    z.channels = {"z"};
    z.deep = image->deep;
    z.metadata["textureformat"] = "Shadow";
    z.metadata["Software"] = "Alpenglow";
    z.bits = 32;
    if (!z.worldToCamera || !z.worldToNDC)
        diags.report(Severity::Warning, Rie::MissingData, o.place,
                     "depth picture \"" + zfile + "\" has no matrices; shadow() cannot use the map");
    return writeMap(shadow, z, o, diags);
}

bool makeCubeFaceEnvironment(const std::vector<std::string>& pictures, const std::string& texture, float fov,
                             const MakeOptions& o, Diagnostics& diags) {
    auto refuse = [&](const std::string& why) {
        diags.report(Severity::Error, Rie::Consistency, o.place, "cube map \"" + texture + "\": " + why);
        return false;
    };
    if (pictures.size() != 6) return refuse("it takes six pictures, not " + std::to_string(pictures.size()));
    if (!(fov > 0 && fov < 180)) return refuse("its field of view must be between 0 and 180 degrees");
    display::Image all;
    int height = 0; // of one face
    for (const std::string& name : pictures) {
        auto face = readPicture(name, texture, o, diags);
        if (!face) return false;
        if (all.channels.empty()) {
            all = *face;
            all.height = 0;
            all.data.clear();
            all.worldToCamera.reset();
            all.worldToNDC.reset();
        }
        if (height == 0) height = face->height;
        if (face->width != all.width || face->height != height || face->channels != all.channels)
            return refuse("\"" + name + "\" differs from the first picture in size or channels");
        for (const char* key : {"colorspace", "gamma"})
            if (textOf(*face, key) != textOf(all, key))
                return refuse("\"" + name +
                              "\" declares another colour space than the first picture; choose one with --srgb or --linear");
        all.height += face->height;
        all.data.insert(all.data.end(), face->data.begin(), face->data.end());
    }
    const std::string space = textOf(all, "colorspace"), gamma = textOf(all, "gamma");
    all.metadata = {{"textureformat", cubeFormat},
                    {"wrapmodes", "clamp,clamp"},
                    {"Software", "Alpenglow"},
                    {"fovcot", std::to_string(1 / exact::tan(double(fov) * kPi / 360))}};
    if (!space.empty()) all.metadata["colorspace"] = space;
    if (!gamma.empty()) all.metadata["gamma"] = gamma;
    return writeMap(texture, all, o, diags);
}

bool makeBrickMap(const std::vector<std::string>& names, const std::string& bricks, const MakeOptions& o, Diagnostics& diags) {
    std::vector<std::string> paths;
    for (const std::string& name : names) {
        std::string outside;
        const auto found = findFile(name, o.searchPath, o.read, &outside);
        if (!found) {
            if (outside.empty())
                diags.report(Severity::Error, Rie::NoFile, o.place, "point cloud \"" + name + "\" was not found");
            else diags.report(outsideMessage("point cloud", name, outside, o.place));
            return false;
        }
        if (replacesIts("point cloud", found->path, bricks, o, diags)) return false;
        paths.push_back(found->path);
    }
    return pointcloud::brickMapOfFiles(paths, bricks, o.policy, diags, o.place);
}

bool runMakeRequest(const std::string& request, const std::vector<std::string>& strings, const std::vector<float>& numbers,
                    const MakeOptions& base, Diagnostics& diags) {
    MakeOptions o = base;
    size_t needed = request == "MakeCubeFaceEnvironment" ? 7 : 2;
    if (strings.size() < needed) {
        diags.report(Severity::Error, Rie::Consistency, o.place, request + " takes " + std::to_string(needed) + " names");
        return false;
    }
    auto string = [&](size_t i, std::string& to) {
        if (i < strings.size()) to = strings[i];
    };
    auto widths = [&](size_t i) {
        if (i < numbers.size()) o.swidth = numbers[i];
        if (i + 1 < numbers.size()) o.twidth = numbers[i + 1];
    };
    if (request == "MakeTexture" || request == "MakeBump") {
        string(2, o.swrap);
        string(3, o.twrap);
        string(4, o.filter);
        widths(0);
        if (request == "MakeBump" && o.colours == MakeOptions::Colours::Auto) o.colours = MakeOptions::Colours::Light; // heights
        return makeTexture(strings[0], strings[1], o, diags);
    }
    if (request == "MakeLatLongEnvironment") {
        string(2, o.filter);
        widths(0);
        return makeLatLongEnvironment(strings[0], strings[1], o, diags);
    }
    if (request == "MakeCubeFaceEnvironment") {
        string(7, o.filter);
        widths(1);
        return makeCubeFaceEnvironment({strings.begin(), strings.begin() + 6}, strings[6], numbers.empty() ? 90.0f : numbers[0],
                                       o, diags);
    }
    if (request == "MakeShadow") return makeShadow(strings[0], strings[1], o, diags);
    if (request == "MakeBrickMap") return makeBrickMap({strings.begin(), strings.end() - 1}, strings.back(), o, diags);
    diags.report(Severity::Error, Rie::Unimplement, o.place, request + " is not available");
    return false;
}

} // namespace alpenglow::texture

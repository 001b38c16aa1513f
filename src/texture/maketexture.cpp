#include "texture/maketexture.h"
#include "display/imageio.h"

namespace alpenglow::texture {
namespace {

constexpr int tileSide = 64; // 48 KiB of rgb floats: a disk read, a few cache ways

std::optional<display::Image> readPicture(const std::string& name, const MakeOptions& o, Diagnostics& diags) {
    auto found = findFile(name, o.searchPath);
    if (!found) {
        diags.report(Severity::Error, Rie::NoFile, o.place, "picture \"" + name + "\" was not found");
        return {};
    }
    if (found->otherCase || found->baseNameOnly)
        diags.report(Severity::Warning, Rie::NoError, o.place, "picture \"" + name + "\" was not found as named; \"" + found->path + "\" is used");
    display::ReadOptions r;
    r.place = o.place;
    auto image = display::readImage(found->path, diags, r);
    if (image) {
        // A map has no place in a larger picture.
        image->originX = image->originY = image->fullWidth = image->fullHeight = 0;
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
    diags.report(Severity::Error, Rie::BadToken, o.place, "unknown wrap mode \"" + name + "\"; \"" + nameOf(fallback) + "\" is used",
                 "wrap modes are black, clamp, periodic");
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
            diags.report(Severity::Error, Rie::Range, o.place, "a filter width is above 0 and at most 1024; 1 is used");
            *w = 1;
        }
    return r;
}

bool makeMap(const std::string& picture, const std::string& texture, const MakeOptions& o, Wrap swrap, Wrap twrap, const char* format,
             Diagnostics& diags) {
    auto image = readPicture(picture, o, diags);
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
    auto image = readPicture(zfile, o, diags);
    if (!image) return false;
    display::Image z = display::selectChannels(*image, {image->channel("z") >= 0 ? "z" : image->channels[0]});
    z.channels = {"z"};
    z.metadata["textureformat"] = "Shadow";
    z.metadata["Software"] = "Alpenglow";
    z.bits = 32;
    if (!z.worldToCamera || !z.worldToNDC)
        diags.report(Severity::Warning, Rie::MissingData, o.place, "depth picture \"" + zfile + "\" has no matrices; shadow() cannot place the map");
    return writeMap(shadow, z, o, diags);
}

} // namespace alpenglow::texture

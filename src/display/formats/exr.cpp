// OpenEXR: scan-line and tiled, flat, half/float/uint channels; MIP-mapped tiles for textures.
// Deep pictures: exrdeep.cpp. Not read: subsampled chroma; of several parts the first.
#include "display/formats/exr.h"
#include "base/limits.h"
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>
#include <algorithm>

namespace alpenglow::display {
namespace {

uint32_t u32(const uint8_t* p) { return uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24; }
int32_t i32(const uint8_t* p) { return int32_t(u32(p)); }

/// Checks the headers before the library, which allocates by their values. Returns an error message, or "".
std::string checkHeaders(Bytes b) {
    const char* bad = "its header is damaged";
    if (b.size() < 8) return "it is truncated";
    uint32_t version = u32(b.data() + 4);
    bool multi = version & 0x1000, singleTiled = version & 0x200;
    size_t at = 8;
    for (int part = 0; part < 64; ++part) {
        if (at >= b.size()) return "it is truncated";
        if (multi && part > 0 && b[at] == 0) return {};
        bool window = false, tiled = false;
        uint64_t tileW = 0, tileH = 0, w = 0, h = 0;
        while (true) {
            if (at >= b.size()) return "it is truncated";
            if (b[at] == 0) {
                ++at;
                break;
            }
            auto text = [&](std::string& s) {
                while (at < b.size() && b[at] && s.size() < 256) s += char(b[at++]);
                if (at >= b.size()) return false;
                return b[at++] == 0;
            };
            std::string name, type;
            if (!text(name) || !text(type)) return bad;
            if (b.size() - at < 4) return "it is truncated";
            int32_t n = i32(b.data() + at);
            at += 4;
            if (n < 0) return bad;
            if (size_t(n) > b.size() - at) return "it is truncated";
            const uint8_t* v = b.data() + at;
            if (name == "dataWindow" || name == "displayWindow") {
                if (n != 16) return bad;
                int64_t box[4];
                for (int i = 0; i < 4; ++i) {
                    box[i] = i32(v + 4 * i);
                    if (box[i] > (1 << 30) || box[i] < -(1 << 30)) return bad;
                }
                int64_t bw = box[2] - box[0] + 1, bh = box[3] - box[1] + 1;
                if (bw <= 0 || bh <= 0) return "it has no pixels";
                if (name == "dataWindow") {
                    if (bw > limits::kImageSide || bh > limits::kImageSide)
                        return "a side is longer than " + std::to_string(limits::kImageSide) + " pixels";
                    window = true;
                    w = uint64_t(bw);
                    h = uint64_t(bh);
                }
            } else if (name == "tiles") {
                if (n != 9) return bad;
                tiled = true;
                tileW = u32(v);
                tileH = u32(v + 4);
                if (!tileW || !tileH || tileW > uint64_t(limits::kImageSide) || tileH > uint64_t(limits::kImageSide)) return bad;
            } else if (name == "channels") {
                int count = 0;
                for (int i = 0; i < n - 1;) {
                    while (i < n && v[i]) ++i;
                    i += 17;
                    if (++count > limits::kImageChannels)
                        return "it has more than " + std::to_string(limits::kImageChannels) + " channels";
                }
            } else if (name == "chunkCount") {
                if (n != 4 || i32(v) < 0 || uint64_t(i32(v)) * 8 > b.size()) return bad;
            } else if (type == "preview") {
                if (n < 8 || uint64_t(u32(v)) * u32(v + 4) * 4 + 8 != uint64_t(n)) return bad;
            }
            at += size_t(n);
        }
        if (!window) return bad;
        // Every chunk has an entry in the offset table: at most 256 lines a chunk, or one tile.
        uint64_t chunks = tiled ? ((w + tileW - 1) / tileW) * ((h + tileH - 1) / tileH) : h / 256;
        if (chunks * 8 > b.size()) return "it is too short for its stated size";
        if (singleTiled && !tiled && !multi) return bad;
        if (!multi) return {};
    }
    return "it has too many parts";
}

/// EXR sorts channels by name; this restores r g b a z, then layers, each in its natural order.
struct ChannelOrder {
    std::string layer;
    int rank;
    std::string name;
    bool operator<(const ChannelOrder& o) const { return std::tie(layer, rank, name) < std::tie(o.layer, o.rank, o.name); }
};
ChannelOrder orderOf(const std::string& name) {
    size_t dot = name.rfind('.');
    std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
    std::string leaf = dot == std::string::npos ? name : name.substr(dot + 1);
    static constexpr const char* ranks[] = {"r",     "R", "red", "x",    "X", "Y", "y", "g", "G",
                                            "green", "b", "B",   "blue", "z", "Z", "a", "A", "alpha"};
    static constexpr int values[] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3};
    int rank = 10;
    for (size_t i = 0; i < std::size(values); ++i)
        if (leaf == ranks[i]) rank = values[i];
    if (layer.empty() && (leaf == "Z" || leaf == "z")) rank = 4;
    if (layer.empty() && rank == 10) layer = "\x01"; // AOVs without layer come after the picture itself
    return {layer, rank, name};
}

const std::pair<const char*, const char*> bareNames[] = {{"r", "R"}, {"g", "G"}, {"b", "B"}, {"a", "A"}, {"z", "Z"}, {"y", "Y"}};
std::string ours(const std::string& n) {
    for (auto& [our, exr] : bareNames)
        if (n == exr) return our;
    return n;
}
std::string theirs(const std::string& n) {
    for (auto& [our, exr] : bareNames)
        if (n == our) return exr;
    return n;
}

Imf::FrameBuffer frameBuffer(Image& m, const std::vector<std::string>& fileNames, const Imath::Box2i& window) {
    Imf::FrameBuffer fb;
    size_t stride = sizeof(float) * m.channels.size();
    for (size_t c = 0; c < fileNames.size(); ++c)
        fb.insert(fileNames[c], Imf::Slice::Make(Imf::FLOAT, m.data.data() + c, window, stride, stride * size_t(m.width)));
    return fb;
}

} // namespace

void readAttributes(const Imf::Header& h, Image& m) {
    for (auto i = h.begin(); i != h.end(); ++i) {
        std::string name = i.name();
        if (name == "name" || name == "type") continue;
        if (auto* s = dynamic_cast<const Imf::StringAttribute*>(&i.attribute())) m.metadata[name] = s->value();
        else if (auto* f = dynamic_cast<const Imf::FloatAttribute*>(&i.attribute());
                 f && name != "pixelAspectRatio" && name != "screenWindowWidth")
            m.metadata[name] = std::to_string(f->value());
        else if (auto* n = dynamic_cast<const Imf::IntAttribute*>(&i.attribute()); n && name != "chunkCount" && name != "version")
            m.metadata[name] = std::to_string(n->value());
    }
    if (auto* a = h.findTypedAttribute<Imf::M44fAttribute>("worldToCamera")) m.worldToCamera = toMatrix(a->value());
    if (auto* a = h.findTypedAttribute<Imf::M44fAttribute>("worldToNDC")) m.worldToNDC = toMatrix(a->value());
}

void writeAttributes(const Image& m, Imf::Header& h) {
    if (m.worldToCamera) h.insert("worldToCamera", Imf::M44fAttribute(fromMatrix(*m.worldToCamera)));
    if (m.worldToNDC) h.insert("worldToNDC", Imf::M44fAttribute(fromMatrix(*m.worldToNDC)));
    for (auto& [key, value] : m.metadata)
        if (!key.empty() && key.size() < 200 && h.find(key) == h.end()) h.insert(key, Imf::StringAttribute(value));
}

static std::optional<Image> decodeExr(Bytes b, const DecodeContext& ctx) {
    if (std::string why = checkHeaders(b); !why.empty()) return ctx.refuse(why);
    try {
        MemoryStream stream(b, ctx.name);
        Imf::MultiPartInputFile file(stream, 0);
        const Imf::Header& h = file.header(0);
        if (file.parts() > 1) ctx.warn("it has " + std::to_string(file.parts()) + " parts; the first is used");
        if (h.hasType() && (h.type() == Imf::DEEPSCANLINE || h.type() == Imf::DEEPTILE)) return decodeDeep(file, ctx);
        if (h.hasType() && h.type() != Imf::SCANLINEIMAGE && h.type() != Imf::TILEDIMAGE)
            return ctx.refuse("its type \"" + h.type() + "\" is unknown");
        Imath::Box2i dw = h.dataWindow(), full = h.displayWindow();
        Image m;
        m.bits = 0;
        std::vector<ChannelOrder> order;
        for (auto c = h.channels().begin(); c != h.channels().end(); ++c) {
            if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
                return ctx.refuse(std::string("its channel \"") + c.name() + "\" is subsampled, which is not supported");
            order.push_back(orderOf(c.name()));
            m.bits = std::max(m.bits, c.channel().type == Imf::HALF ? 16 : 32);
        }
        m.width = dw.max.x - dw.min.x + 1;
        m.height = dw.max.y - dw.min.y + 1;
        if (!ctx.sizeAllowed(uint64_t(m.width), uint64_t(m.height), order.size())) return {};
        std::sort(order.begin(), order.end());
        std::vector<std::string> names;
        for (auto& o : order) {
            names.push_back(o.name);
            // "R" becomes "r" unless the file also has an "r".
            bool taken = ours(o.name) != o.name && h.channels().findChannel(ours(o.name));
            m.channels.push_back(taken ? o.name : ours(o.name));
        }
        m.originX = dw.min.x - full.min.x;
        m.originY = dw.min.y - full.min.y;
        if (!(dw == full)) {
            m.fullWidth = full.max.x - full.min.x + 1;
            m.fullHeight = full.max.y - full.min.y + 1;
        }
        m.pixelAspect = h.pixelAspectRatio();
        readAttributes(h, m);
        m.data.assign(m.sampleCount(), 0.0f);
        bool levels = ctx.options.levels && h.hasTileDescription() && h.tileDescription().mode == Imf::MIPMAP_LEVELS;
        if (!levels) {
            Imf::InputPart part(file, 0);
            part.setFrameBuffer(frameBuffer(m, names, dw));
            part.readPixels(dw.min.y, dw.max.y);
            return m;
        }
        Imf::TiledInputPart part(file, 0);
        for (int l = 0; l < part.numLevels(); ++l) {
            Imath::Box2i w = part.dataWindowForLevel(l);
            Image* level = &m;
            if (l > 0) {
                m.levels.push_back(makeImage(w.max.x - w.min.x + 1, w.max.y - w.min.y + 1, m.channels));
                level = &m.levels.back();
            }
            part.setFrameBuffer(frameBuffer(*level, names, w));
            part.readTiles(0, part.numXTiles(l) - 1, 0, part.numYTiles(l) - 1, l);
        }
        return m;
    } catch (const std::bad_alloc&) { throw; } catch (const std::exception& e) {
        return ctx.refuse(e.what());
    }
}

static bool encodeExr(OutputFile& out, const Image& m, const WriteOptions& o, Diagnostics&, std::string& why) {
    if (m.deep) return encodeDeep(out, m, why);
    try {
        Imath::Box2i dw({m.originX, m.originY}, {m.originX + m.width - 1, m.originY + m.height - 1}), full = dw;
        if (m.fullWidth > 0 && m.fullHeight > 0) full = {{0, 0}, {m.fullWidth - 1, m.fullHeight - 1}};
        Imf::Compression compression = o.compression == "none"   ? Imf::NO_COMPRESSION
                                       : o.compression == "rle"  ? Imf::RLE_COMPRESSION
                                       : o.compression == "zips" ? Imf::ZIPS_COMPRESSION
                                       : o.compression == "piz"  ? Imf::PIZ_COMPRESSION
                                                                 : Imf::ZIP_COMPRESSION;
        Imf::Header h(full, dw, m.pixelAspect, {0, 0}, 1, Imf::INCREASING_Y, compression);
        bool half = o.sample != Sample::Float;
        for (const std::string& c : m.channels) h.channels().insert(theirs(c), Imf::Channel(half ? Imf::HALF : Imf::FLOAT));
        writeAttributes(m, h);

        // OpenEXR needs pixels in the file's type: converts to half, with overflow to infinity.
        std::vector<Imath::half> halves;
        auto buffer = [&](const Image& level, const Imath::Box2i& w) {
            Imf::FrameBuffer fb;
            size_t n = m.channels.size(), unit = half ? 2 : 4;
            const char* base = reinterpret_cast<const char*>(level.data.data());
            if (half) {
                halves.assign(level.data.begin(), level.data.end());
                base = reinterpret_cast<const char*>(halves.data());
            }
            for (size_t c = 0; c < n; ++c)
                fb.insert(theirs(m.channels[c]), Imf::Slice::Make(half ? Imf::HALF : Imf::FLOAT, base + c * unit, w, unit * n,
                                                                  unit * n * size_t(level.width)));
            return fb;
        };
        FileStream stream(out);
        if (o.tile <= 0) {
            Imf::OutputFile file(stream, h, 0);
            file.setFrameBuffer(buffer(m, dw));
            file.writePixels(m.height);
            return true;
        }
        bool mip = !m.levels.empty();
        h.setTileDescription(
            Imf::TileDescription(unsigned(o.tile), unsigned(o.tile), mip ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL, Imf::ROUND_DOWN));
        Imf::TiledOutputFile file(stream, h, 0);
        if (mip && file.numLevels() != int(m.levels.size()) + 1) {
            why = "its levels are not a MIP-map";
            return false;
        }
        for (int l = 0; l < file.numLevels(); ++l) {
            const Image& level = l == 0 ? m : m.levels[size_t(l - 1)];
            Imath::Box2i w = file.dataWindowForLevel(l);
            if (level.width != w.max.x - w.min.x + 1 || level.height != w.max.y - w.min.y + 1 ||
                level.channels.size() != m.channels.size() || level.data.size() != level.sampleCount()) {
                why = "its levels are not a MIP-map";
                return false;
            }
            file.setFrameBuffer(buffer(level, w));
            file.writeTiles(0, file.numXTiles(l) - 1, 0, file.numYTiles(l) - 1, l);
        }
        return true;
    } catch (const std::bad_alloc&) { throw; } catch (const std::exception& e) {
        why = e.what();
        return false;
    }
}

PictureFormat exrFormat() {
    static const WrittenFormat kWritten{
        .name = "OpenEXR",
        .extensions = {"exr"},
        .codes = false,
        .displays = {"openexr", "exr"},
        .doc = "OpenEXR. Floating point whatever Quantize says; AOVs are layers. Parameters: \"string "
               "exrpixeltype\" float (default) or half; "
               "\"string exrcompression\" none, rle, zips, zip (default), piz."};
    return {kWritten.name, [](Bytes b) { return starts(b, {0x76, 0x2f, 0x31, 0x01}); }, decodeExr, encodeExr, &kWritten};
}

} // namespace alpenglow::display

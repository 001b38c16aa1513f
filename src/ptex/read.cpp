// Reads Ptex files. They are untrusted: every size is checked against the file before memory is allocated.
#include "base/randomfile.h"
#include "ptex/cache.h"
#include "ptex/limits.h"
#include "ptex/numbers.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

namespace alpenglow::ptex {

namespace {

constexpr size_t kHeader = 64, kExtended = 40, kFaceInfo = 20, kLevelInfo = 16, kBarrier = 8;

/// File position and encoding of a face's data.
struct Block {
    uint64_t at = 0;
    uint32_t header = 0;
};

class File final : public Texture {
public:
    File(const std::string& path, std::shared_ptr<Cache> cache, Diagnostics& d)
        : bytes_(path), path_(path), cache_(std::move(cache)), diagnostics_(d) {
        number_ = cache_->number();
    }
    /// "": fine.
    std::string open();
    const Head& head() const override { return head_; }
    std::shared_ptr<const Image> image(uint32_t face, int halvings) const override;
    std::shared_ptr<const Tiles> tiles(uint32_t face, int halvings) const override;
    std::shared_ptr<const Image> tile(uint32_t face, int halvings, const Tiles&, uint32_t number) const override;

private:
    std::string readHeader();
    std::string readFaces();
    std::string readLevels();
    std::string readLevel(size_t k, uint64_t at, uint64_t size, uint32_t headerSize, uint32_t count);
    std::string readMetas(std::span<const uint8_t>);
    std::string readLargeMetas();
    std::string readEdits();
    std::string editFace(std::span<const uint8_t>, uint64_t at);
    std::string checkFace(const Face&) const;
    std::string keep(Meta);
    bool unpack(uint64_t at, uint64_t packed, uint64_t size, std::vector<uint8_t>& to) const;
    size_t pixelBytes() const { return sizeOf(head_.number) * size_t(head_.channels); }
    bool decode(const Block&, int ulog, int vlog, std::vector<float>& to) const;
    bool readTiles(uint64_t at, uint32_t header, int ulog, int vlog, Tiles&) const;
    bool decodeTiles(uint64_t at, uint32_t header, int ulog, int vlog, std::vector<float>& to) const;
    bool decodePlain(std::span<const uint8_t>, Encoding, size_t pixels, std::vector<float>& to) const;
    const Block* blockOf(uint32_t face, int halvings) const;
    Image constantOf(uint32_t face) const;
    Image halvedOf(uint32_t face, int halvings) const;
    std::shared_ptr<const Image> makeTile(uint32_t face, int halvings, const Tiles&, uint32_t number) const;
    void sayDamaged(uint32_t face) const;
    Image make(uint32_t face, int halvings) const;
    void multiply(std::vector<float>&) const;

    RandomFile bytes_;
    std::string path_;
    std::shared_ptr<Cache> cache_;
    Diagnostics& diagnostics_;
    uint64_t number_ = 0;
    Head head_;
    std::vector<uint8_t> constants_;
    uint32_t extended_ = 0, faceInfoSize_ = 0, constantSize_ = 0, levelInfoSize_ = 0, levels_ = 0, faceCount_ = 0;
    uint64_t levelDataSize_ = 0, largeSize_ = 0, editAt_ = 0;
    uint64_t headBytes_ = 0; ///< memory for data of all faces
    std::unordered_map<std::string, size_t> metaAt_;
    uint32_t metaZip_ = 0, metaSize_ = 0, largeZip_ = 0, largeHeader_ = 0;
    std::vector<std::vector<Block>> blocks_; ///< by level, then by face in the level
    std::vector<uint32_t> place_;            ///< by face: in levels behind the first
    std::map<uint32_t, Block> edited_;       ///< faces that were edited: their data
    std::vector<bool> stale_;                ///< their levels are out of date
};

std::string File::open() {
    if (!bytes_.regular()) return "it is not a regular file";
    if (std::string f = readHeader(); !f.empty()) return f;
    if (std::string f = readFaces(); !f.empty()) return f;
    if (std::string f = readLevels(); !f.empty()) return f;
    std::vector<uint8_t> metas;
    const uint64_t at = kHeader + extended_ + uint64_t(faceInfoSize_) + constantSize_ + levelInfoSize_ + levelDataSize_;
    if (metaSize_ > limits::kPtexMetaBytes) return "its meta data are too large";
    if (metaSize_ > 0) {
        if (!unpack(at, metaZip_, metaSize_, metas)) return "its meta data are damaged";
        if (std::string f = readMetas(metas); !f.empty()) return f;
    }
    if (std::string f = readLargeMetas(); !f.empty()) return f;
    return readEdits();
}

/// Rejects a stream that is much longer than its contents, which no encoder would write.
bool File::unpack(uint64_t at, uint64_t packed, uint64_t size, std::vector<uint8_t>& to) const {
    std::vector<uint8_t> zip;
    return packed <= size + size / 8 + 1024 && bytes_.read(at, packed, zip) && inflated(zip, size_t(size), to);
}

std::string File::readHeader() {
    std::vector<uint8_t> b;
    if (!bytes_.read(0, kHeader, b)) return "it is cut short";
    if (std::memcmp(b.data(), "Ptex", 4) != 0) return "it is no Ptex file";
    const auto u32 = [&](size_t at) { return take<uint32_t>(&b[at]); };
    if (u32(4) != 1) return "it has version " + std::to_string(u32(4)) + ", this program reads version 1";
    if (u32(8) > 1 || u32(12) > 3) return "its header is damaged";
    head_.mesh = Mesh(u32(8));
    head_.number = Number(u32(12));
    head_.channels = take<uint16_t>(&b[20]);
    head_.alpha = int32_t(u32(16));
    if (head_.channels < 1 || head_.channels > limits::kPtexChannels)
        return "it has " + std::to_string(head_.channels) + " channels, 1 to " + std::to_string(limits::kPtexChannels) +
               " can be read";
    if (head_.alpha < 0 || head_.alpha >= head_.channels) head_.alpha = -1;
    levels_ = take<uint16_t>(&b[22]);
    faceCount_ = u32(24);
    extended_ = u32(28);
    faceInfoSize_ = u32(32);
    constantSize_ = u32(36);
    levelInfoSize_ = u32(40);
    levelDataSize_ = take<uint64_t>(&b[48]);
    metaZip_ = u32(56);
    metaSize_ = u32(60);
    if (faceCount_ > limits::kPtexFaces) return "it has more than " + std::to_string(limits::kPtexFaces) + " faces";
    headBytes_ = uint64_t(faceCount_) * (sizeof(Face) + sizeof(Block) + sizeof(uint32_t) + pixelBytes());
    if (headBytes_ > limits::kPtexHeadBytes) return "its face data is too large";
    if (levels_ > 32 || levelInfoSize_ != levels_ * kLevelInfo) return "its header does not match its levels";
    if (uint64_t(extended_) + faceInfoSize_ + constantSize_ + levelInfoSize_ + kHeader > bytes_.size() ||
        levelDataSize_ > bytes_.size())
        return "it is cut short";
    std::vector<uint8_t> e;
    if (!bytes_.read(kHeader, std::min<uint64_t>(extended_, kExtended), e)) return "it is cut short";
    e.resize(kExtended); // missing in older files: 0
    const auto border = [&](size_t at) { return take<uint32_t>(&e[at]) <= 2 ? Border(e[at]) : Border::Clamp; };
    head_.uBorder = border(0);
    head_.vBorder = border(4);
    largeZip_ = take<uint32_t>(&e[8]);
    largeHeader_ = take<uint32_t>(&e[12]);
    largeSize_ = take<uint64_t>(&e[16]);
    editAt_ = take<uint64_t>(&e[32]);
    return "";
}

std::string File::checkFace(const Face& f) const {
    if (f.ulog > limits::kPtexSide || f.vlog > limits::kPtexSide) return "it has a face of more than 32768 pixels along a side";
    if ((size_t(head_.channels) << (f.ulog + f.vlog)) > limits::kPtexFaceNumbers) return "it has a face of too many pixels";
    if (head_.mesh == Mesh::Triangle && f.ulog != f.vlog) return "it has a triangle that is not square";
    for (const int32_t a : f.adjacent)
        if (a < -1 || a >= int64_t(faceCount_)) return "it has a face adjacent to one that does not exist";
    return "";
}

std::string File::readFaces() {
    std::vector<uint8_t> b;
    if (!unpack(kHeader + uint64_t(extended_), faceInfoSize_, uint64_t(faceCount_) * kFaceInfo, b))
        return "its face data is damaged";
    head_.faces.reserve(faceCount_);
    for (uint32_t i = 0; i < faceCount_; ++i) {
        head_.faces.push_back(faceOf(&b[i * kFaceInfo]));
        if (std::string fault = checkFace(head_.faces.back()); !fault.empty()) return fault;
    }
    if (!unpack(kHeader + uint64_t(extended_) + faceInfoSize_, constantSize_, uint64_t(faceCount_) * pixelBytes(), constants_))
        return "the means of its faces are damaged";
    stale_.assign(faceCount_, false);
    return "";
}

std::string File::readLevels() {
    const uint64_t infos = kHeader + uint64_t(extended_) + faceInfoSize_ + constantSize_;
    std::vector<uint8_t> b;
    if (!bytes_.read(infos, levelInfoSize_, b)) return "it is cut short";
    std::vector<uint32_t> order;
    for (uint32_t f = 0; f < faceCount_; ++f)
        if (!head_.faces[f].constant) order.push_back(f);
    const auto least = [&](uint32_t f) { return std::min(head_.faces[f].ulog, head_.faces[f].vlog); };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t x, uint32_t y) { return least(x) > least(y); });
    place_.assign(faceCount_, ~0u);
    for (uint32_t i = 0; i < order.size(); ++i) place_[order[i]] = i;
    uint64_t at = infos + levelInfoSize_, left = levelDataSize_;
    for (uint32_t k = 0; k < levels_; ++k) {
        const uint8_t* info = &b[k * kLevelInfo];
        const uint64_t size = take<uint64_t>(info);
        if (size > left) return "its levels are larger than declared";
        if (std::string f = readLevel(k, at, size, take<uint32_t>(info + 8), take<uint32_t>(info + 12)); !f.empty()) return f;
        at += size, left -= size;
    }
    if (levels_ == 0 && !order.empty()) return "it has faces without pixels";
    return "";
}

std::string File::readLevel(size_t k, uint64_t at, uint64_t size, uint32_t headerSize, uint32_t count) {
    if (headerSize > size || count > faceCount_ || (k == 0 && count != faceCount_)) return "a level of it is damaged";
    if (k > 0 && (headBytes_ += count * sizeof(Block)) > limits::kPtexHeadBytes) return "its face data is too large";
    std::vector<uint8_t> b;
    if (!unpack(at, headerSize, uint64_t(count) * 4, b)) return "a level of it is damaged";
    std::vector<Block>& blocks = blocks_.emplace_back();
    blocks.reserve(count);
    uint64_t next = at + headerSize;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t header = take<uint32_t>(&b[4 * size_t(i)]);
        // Constant faces have their pixel elsewhere.
        const bool elsewhere = k == 0 && head_.faces[i].constant;
        const uint64_t bytes = elsewhere ? 0 : blockSize(header);
        if (next + bytes > at + size) return "the faces of a level are larger than declared";
        blocks.push_back({next, header});
        next += bytes;
    }
    return next > bytes_.size() ? "it is cut short" : "";
}

/// Parses a stream of small items. They replace existing items with the same key.
std::string File::readMetas(std::span<const uint8_t> b) {
    for (size_t at = 0; at < b.size();) {
        const size_t key = b[at];
        if (key < 1 || at + 1 + key + 5 > b.size()) return "its meta data are damaged";
        Meta m{std::string(reinterpret_cast<const char*>(&b[at + 1]), key - 1), b[at + 1 + key], {}};
        const uint32_t size = take<uint32_t>(&b[at + 2 + key]);
        at += 6 + key;
        if (m.type > 5 || size > b.size() - at) return "its meta data are damaged";
        m.bytes.assign(b.begin() + long(at), b.begin() + long(at + size));
        at += size;
        if (std::string f = keep(std::move(m)); !f.empty()) return f;
    }
    return "";
}

std::string File::keep(Meta m) {
    const auto [at, fresh] = metaAt_.try_emplace(m.key, head_.metas.size());
    if (!fresh) head_.metas[at->second] = std::move(m);
    else if (head_.metas.size() >= limits::kPtexMetas) return "its meta data are too many";
    else head_.metas.push_back(std::move(m));
    return "";
}

std::string File::readLargeMetas() {
    if (largeHeader_ == 0) return "";
    uint64_t at =
        kHeader + uint64_t(extended_) + faceInfoSize_ + constantSize_ + levelInfoSize_ + levelDataSize_ + metaZip_ + kBarrier;
    if (largeHeader_ > limits::kPtexMetaBytes) return "its meta data are too large";
    std::vector<uint8_t> b;
    if (!unpack(at, largeZip_, largeHeader_, b)) return "its large meta data are damaged";
    at += largeZip_;
    uint64_t all = 0;
    for (size_t i = 0; i < b.size();) {
        const size_t key = b[i];
        if (key < 1 || i + 1 + key + 9 > b.size()) return "its large meta data are damaged";
        Meta m{std::string(reinterpret_cast<const char*>(&b[i + 1]), key - 1), b[i + 1 + key], {}};
        const uint32_t size = take<uint32_t>(&b[i + 2 + key]), packed = take<uint32_t>(&b[i + 6 + key]);
        i += 10 + key;
        if ((all += size) > limits::kPtexMetaBytes) return "its meta data are too large";
        if (m.type > 5 || !unpack(at, packed, size, m.bytes)) return "its large meta data are damaged";
        at += packed;
        if (std::string f = keep(std::move(m)); !f.empty()) return f;
    }
    return "";
}

std::string File::readEdits() {
    if (editAt_ == 0) return "";
    std::vector<uint8_t> b;
    for (uint64_t at = editAt_; at + 5 <= bytes_.size();) {
        if (!bytes_.read(at, 5, b)) return "it is cut short";
        const uint8_t type = b[0];
        const uint32_t size = take<uint32_t>(&b[1]);
        if (type == 0 && size == 0) break;
        at += 5;
        if (size > bytes_.size() - at) return "an edit in it is truncated";
        if (type == 1) {
            if (!bytes_.read(at, std::min<uint64_t>(size, 28 + pixelBytes()), b)) return "it is cut short";
            if (std::string f = editFace(b, at + 28 + pixelBytes()); !f.empty()) return f;
        } else if (type == 2) {
            std::vector<uint8_t> metas;
            if (size < 8 || !bytes_.read(at, 8, b) || take<uint32_t>(&b[4]) > limits::kPtexMetaBytes ||
                take<uint32_t>(&b[0]) > size - 8 || !unpack(at + 8, take<uint32_t>(&b[0]), take<uint32_t>(&b[4]), metas))
                return "an edit of its meta data is damaged";
            if (std::string f = readMetas(metas); !f.empty()) return f;
        }
        at += size;
    }
    return "";
}

std::string File::editFace(std::span<const uint8_t> b, uint64_t at) {
    if (b.size() < 28 + pixelBytes()) return "an edit in it is damaged";
    const uint32_t face = take<uint32_t>(b.data());
    if (face >= faceCount_) return "an edit in it is of a face that does not exist";
    const Face f = faceOf(&b[4]);
    if (std::string fault = checkFace(f); !fault.empty()) return fault;
    const uint32_t header = take<uint32_t>(&b[24]);
    if (blockSize(header) > bytes_.size() - std::min(at, bytes_.size())) return "an edit in it is truncated";
    head_.faces[face] = f;
    stale_[face] = true;
    edited_[face] = {at, header};
    std::copy(b.begin() + 28, b.begin() + 28 + long(pixelBytes()), constants_.begin() + long(face * pixelBytes()));
    return "";
}

/// Pixels side by side from channels one behind the other.
bool File::decodePlain(std::span<const uint8_t> b, Encoding how, size_t pixels, std::vector<float>& to) const {
    const size_t channels = size_t(head_.channels), size = sizeOf(head_.number);
    to.resize(pixels * channels);
    if (how == kConstant) {
        if (b.size() < pixelBytes()) return false;
        for (size_t c = 0; c < channels; ++c) {
            const float v = toFloat(head_.number, &b[c * size]);
            for (size_t i = 0; i < pixels; ++i) to[i * channels + c] = v;
        }
        return true;
    }
    std::vector<uint8_t> data;
    if (how == kTiled || !inflated(b, pixels * pixelBytes(), data)) return false;
    if (how == kDifferences) addUp(size, data);
    for (size_t c = 0; c < channels; ++c)
        for (size_t i = 0; i < pixels; ++i) to[i * channels + c] = toFloat(head_.number, &data[(c * pixels + i) * size]);
    return true;
}

/// Reads the positions of the tiles of a block.
bool File::readTiles(uint64_t at, uint32_t header, int ulog, int vlog, Tiles& t) const {
    std::vector<uint8_t> b, headers;
    const uint64_t end = at + blockSize(header);
    if (blockSize(header) < 6 || !bytes_.read(at, 6, b) || b[0] > ulog || b[1] > vlog) return false;
    t.u = 1 << ulog, t.v = 1 << vlog, t.tu = b[0], t.tv = b[1];
    const size_t count = size_t(1) << (ulog + vlog - t.tu - t.tv);
    const uint64_t packed = take<uint32_t>(&b[2]);
    if (count > limits::kPtexTiles || packed > blockSize(header) - 6 || !unpack(at + 6, packed, count * 4, headers)) return false;
    at += 6 + packed;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t h = take<uint32_t>(&headers[4 * i]);
        if (blockSize(h) > end - at || encodingOf(h) == kTiled) return false;
        t.at.push_back(at);
        t.headers.push_back(h);
        at += blockSize(h);
    }
    return true;
}

bool File::decodeTiles(uint64_t at, uint32_t header, int ulog, int vlog, std::vector<float>& to) const {
    Tiles t;
    if (!readTiles(at, header, ulog, vlog, t)) return false;
    const size_t across = size_t(1) << (ulog - t.tu), channels = size_t(head_.channels), row = channels << ulog,
                 part = channels << t.tu;
    to.resize(row << vlog);
    std::vector<float> tile;
    for (size_t i = 0; i < t.at.size(); ++i) {
        if (!decode({t.at[i], t.headers[i]}, t.tu, t.tv, tile)) return false;
        for (size_t j = 0; j < size_t(1) << t.tv; ++j)
            std::copy(tile.begin() + long(j * part), tile.begin() + long((j + 1) * part),
                      to.begin() + long(((i / across << t.tv) + j) * row + i % across * part));
    }
    return true;
}

bool File::decode(const Block& block, int ulog, int vlog, std::vector<float>& to) const {
    std::vector<uint8_t> b;
    // More data than tiles of one pixel can have.
    if (blockSize(block.header) > ((pixelBytes() + 64) << (ulog + vlog)) + 1024) return false;
    if (encodingOf(block.header) == kTiled) return decodeTiles(block.at, block.header, ulog, vlog, to);
    if (!bytes_.read(block.at, blockSize(block.header), b)) return false;
    return decodePlain(b, encodingOf(block.header), size_t(1) << (ulog + vlog), to);
}

void File::multiply(std::vector<float>& values) const {
    const size_t channels = size_t(head_.channels), a = size_t(head_.alpha);
    for (size_t i = 0; i < values.size(); i += channels)
        for (size_t c = 0; c < channels; ++c)
            if (c != a) values[i + c] *= values[i + a];
}

void makeFinite(std::vector<float>& values) {
    for (float& v : values)
        if (!std::isfinite(v)) v = 0;
}

Image File::constantOf(uint32_t face) const {
    Image m;
    for (int c = 0; c < head_.channels; ++c)
        m.values.push_back(toFloat(head_.number, &constants_[face * pixelBytes() + size_t(c) * sizeOf(head_.number)]));
    if (head_.alpha >= 0) multiply(m.values);
    makeFinite(m.values);
    return m;
}

/// Where a level of a face is stored; null: it is not, or the face is constant.
const Block* File::blockOf(uint32_t face, int k) const {
    const Face& f = head_.faces[face];
    if (f.constant) return nullptr;
    if (const auto edit = edited_.find(face); k == 0 && edit != edited_.end()) return &edit->second;
    if (k == 0) return blocks_.empty() ? nullptr : &blocks_[0][face];
    const bool there = !stale_[face] && size_t(k) < blocks_.size() && place_[face] < blocks_[size_t(k)].size();
    return there && k <= f.ulog && k <= f.vlog ? &blocks_[size_t(k)][place_[face]] : nullptr;
}

void File::sayDamaged(uint32_t face) const {
    diagnostics_.reportOnce("ptex:" + path_ + std::to_string(face),
                            {Severity::Error,
                             Rie::BadFile,
                             {},
                             "Ptex file \"" + path_ + "\": face " + std::to_string(face) + " is damaged; its mean is used",
                             {},
                             {}});
}

/// Halves a level. If it is stored in tiles, reads two of them at a time and keeps none.
Image File::halvedOf(uint32_t face, int halvings) const {
    const auto t = tiles(face, halvings);
    if (!t) return halved(*image(face, halvings), head_.channels, head_.mesh);
    std::pair<uint32_t, std::shared_ptr<const Image>> last[2]; // inverted triangles are stored elsewhere
    return halved(*t, head_.channels, head_.mesh, [&](int i, int j) {
        const uint32_t n = t->numberOf(i, j);
        if (!last[0].second || last[0].first != n) std::swap(last[0], last[1]);
        if (!last[0].second || last[0].first != n) last[0] = {n, makeTile(face, halvings, *t, n)};
        return &last[0].second->values[t->within(i, j) * size_t(head_.channels)];
    });
}

Image File::make(uint32_t face, int halvings) const {
    const Face& f = head_.faces[face];
    const int most = std::max(f.ulog, f.vlog), k = std::min(halvings, most);
    const Block* block = blockOf(face, k);
    if (f.constant || (k == 0 && !block)) return constantOf(face);
    if (!block) return halvedOf(face, k - 1);
    Image m{1 << (f.ulog - k), 1 << (f.vlog - k), {}};
    if (!decode(*block, f.ulog - k, f.vlog - k, m.values)) {
        sayDamaged(face);
        return constantOf(face);
    }
    if (head_.alpha >= 0 && k == 0) multiply(m.values); // coarser ones are stored so
    makeFinite(m.values);
    return m;
}

std::shared_ptr<const Tiles> File::tiles(uint32_t face, int halvings) const {
    const Face& f = head_.faces[face];
    const int u = f.ulog - halvings, v = f.vlog - halvings;
    if (u < 0 || v < 0 || (size_t(head_.channels) << (u + v)) <= limits::kPtexWholeNumbers) return nullptr;
    const Block* block = blockOf(face, halvings);
    if (!block || encodingOf(block->header) != kTiled) return nullptr;
    const Cache::Key key{number_, face, halvings, Cache::kTable};
    if (auto known = cache_->find(key)) return std::static_pointer_cast<const Tiles>(known);
    auto t = std::make_shared<Tiles>();
    if (!readTiles(block->at, block->header, u, v, *t)) return nullptr; // image() reports it
    cache_->keep(key, t, t->at.size() * (sizeof(uint64_t) + sizeof(uint32_t)));
    return t;
}

std::shared_ptr<const Image> File::makeTile(uint32_t face, int halvings, const Tiles& t, uint32_t number) const {
    auto m = std::make_shared<Image>(Image{1 << t.tu, 1 << t.tv, {}});
    if (!decode({t.at[number], t.headers[number]}, t.tu, t.tv, m->values)) {
        sayDamaged(face);
        const Image mean = constantOf(face);
        m->values.clear();
        for (size_t i = 0; i < size_t(1) << (t.tu + t.tv); ++i)
            m->values.insert(m->values.end(), mean.values.begin(), mean.values.end());
    } else {
        if (head_.alpha >= 0 && halvings == 0) multiply(m->values);
        makeFinite(m->values);
    }
    return m;
}

std::shared_ptr<const Image> File::tile(uint32_t face, int halvings, const Tiles& t, uint32_t number) const {
    const Cache::Key key{number_, face, halvings, number};
    if (auto known = cache_->find(key)) return known;
    auto made = makeTile(face, halvings, t, number);
    cache_->keep(key, made);
    return made;
}

std::shared_ptr<const Image> File::image(uint32_t face, int halvings) const {
    const Cache::Key key{number_, face, halvings};
    if (auto known = cache_->find(key)) return known;
    auto made = std::make_shared<const Image>(make(face, halvings));
    cache_->keep(key, made);
    return made;
}

} // namespace

std::shared_ptr<const Texture> openTexture(const std::string& path, std::shared_ptr<Cache> cache, Diagnostics& d,
                                           const SourcePlace& place) {
    auto file = std::make_shared<File>(path, std::move(cache), d);
    const std::string fault = file->open();
    if (fault.empty()) return file;
    d.report(Severity::Error, Rie::BadFile, place, "Ptex file \"" + path + "\" cannot be read: " + fault,
             "alpenglow maketx -ptex makes such files");
    return nullptr;
}

} // namespace alpenglow::ptex

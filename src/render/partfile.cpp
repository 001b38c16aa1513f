#include "render/partfile.h"
#include "base/limits.h"
#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <zlib.h>

namespace alpenglow::render {

namespace {

constexpr char kMagic[8] = {'A', 'L', 'P', 'G', 'P', 'A', 'R', 'T'};
constexpr uint32_t kVersion = 3;       // 1 had no sums of samples that hit a surface, 2 had eight replicas per pixel
constexpr uint32_t kSpreadVersion = 4; // adaptive films; others stay readable by older programs
constexpr uint32_t kSignedVersion = 5; // films whose samples have weights, adaptive or not
constexpr size_t kPrefix = 20;         // magic, version, header size, header CRC
constexpr size_t kPixelBytes = 16 * 4 + 16 * kReplicas + 32 + 4 * kReplicas + 16 + 4 * kReplicas;
constexpr size_t kDeflateRatio = 1040; // deflate cannot compress better than 1032 : 1

struct PartWriter {
    std::vector<uint8_t> bytes;
    template <class T> void number(T v) {
        for (size_t i = 0; i < sizeof(T); ++i) bytes.push_back(uint8_t(v >> (8 * i)));
    }
    void text(const std::string& s) {
        number(uint32_t(s.size()));
        bytes.insert(bytes.end(), s.begin(), s.end());
    }
};

struct PartReader {
    std::span<const uint8_t> bytes;
    size_t at = 0;
    bool ok = true;
    template <class T> T number() {
        T v = 0;
        if (bytes.size() - at < sizeof(T)) {
            ok = false;
            return v;
        }
        for (size_t i = 0; i < sizeof(T); ++i) v |= T(bytes[at + i]) << (8 * i);
        at += sizeof(T);
        return v;
    }
    std::string text() {
        uint32_t n = number<uint32_t>();
        if (!ok || bytes.size() - at < n) {
            ok = false;
            return {};
        }
        std::string s(bytes.begin() + long(at), bytes.begin() + long(at + n));
        at += n;
        return s;
    }
};

uint32_t crc(std::span<const uint8_t> b) {
    uLong c = crc32(0, nullptr, 0);
    for (size_t at = 0; at < b.size();) {
        uInt n = uInt(std::min<size_t>(b.size() - at, 1u << 30));
        c = crc32(c, b.data() + at, n);
        at += n;
    }
    return uint32_t(c);
}

// One row of pixels at a time through zlib: a film is not held twice.
class Packer {
public:
    explicit Packer(OutputFile& f) : file_(f) { ready_ = deflateInit(&z_, 1) == Z_OK; }
    ~Packer() {
        if (ready_) deflateEnd(&z_);
    }
    bool put(const std::vector<uint8_t>& in, bool last) {
        if (!ready_) return false;
        uint8_t out[65536];
        for (size_t at = 0;;) {
            uInt n = uInt(std::min<size_t>(in.size() - at, 1u << 30));
            z_.next_in = const_cast<uint8_t*>(in.data() + at);
            z_.avail_in = n;
            at += n;
            int flush = last && at == in.size() ? Z_FINISH : Z_NO_FLUSH;
            do {
                z_.next_out = out;
                z_.avail_out = sizeof out;
                deflate(&z_, flush);
                size_t got = sizeof out - z_.avail_out;
                crc_ = crc32(crc_, out, uInt(got));
                if (!file_.write(out, got)) return false;
            } while (z_.avail_out == 0);
            if (at == in.size()) return true;
        }
    }
    uint32_t checksum() const { return uint32_t(crc_); }

private:
    OutputFile& file_;
    z_stream z_{};
    uLong crc_ = crc32(0, nullptr, 0);
    bool ready_ = false;
};

class Unpacker {
public:
    explicit Unpacker(std::span<const uint8_t> in) : in_(in) { ready_ = inflateInit(&z_) == Z_OK; }
    ~Unpacker() {
        if (ready_) inflateEnd(&z_);
    }
    /// Fills the buffer; returns false if the stream is damaged or ends early.
    bool get(std::vector<uint8_t>& out) {
        if (!ready_) return false;
        for (size_t at = 0; at < out.size();) {
            if (!step(out.data() + at, std::min<size_t>(out.size() - at, 1u << 30), &at)) return false;
        }
        return true;
    }
    /// True at the end of the stream.
    bool atEnd() {
        uint8_t extra;
        size_t got = 0;
        while (!ended_ && step(&extra, 1, &got)) {}
        return ended_ && got == 0 && z_.avail_in == 0 && used_ == in_.size();
    }

private:
    bool step(uint8_t* to, size_t room, size_t* at) {
        if (ended_) return false;
        if (z_.avail_in == 0) {
            uInt n = uInt(std::min<size_t>(in_.size() - used_, 1u << 30));
            z_.next_in = const_cast<uint8_t*>(in_.data() + used_);
            z_.avail_in = n;
            used_ += n;
        }
        z_.next_out = to;
        z_.avail_out = uInt(room);
        uInt before = z_.avail_in;
        int r = inflate(&z_, Z_NO_FLUSH);
        size_t got = room - z_.avail_out;
        *at += got;
        ended_ = r == Z_STREAM_END;
        return (r == Z_OK || ended_) && (got > 0 || z_.avail_in < before || ended_);
    }
    std::span<const uint8_t> in_;
    size_t used_ = 0;
    z_stream z_{};
    bool ready_ = false, ended_ = false;
};

} // namespace

/// Accesses the integers of Film.
struct FilmIo {
    static std::vector<uint8_t> header(const Film& f) {
        const FilmDescription& d = f.description_;
        PartWriter w;
        for (int v : {d.width, d.height, d.window.x0, d.window.y0, d.window.x1, d.window.y1}) w.number(uint32_t(v));
        w.number(d.seed);
        w.text(d.scene);
        w.number(uint32_t(d.channels.size()));
        for (const Channel& c : d.channels) {
            w.number(uint8_t(c.rule));
            w.text(c.name);
        }
        w.number(uint32_t(f.ranges_.size()));
        for (auto r : f.ranges_) {
            w.number(r.begin);
            w.number(r.end);
        }
        for (uint64_t v : {f.nonFinite_, f.nonFiniteAovs_, f.saturated_, f.firstDropped_[0], f.firstDropped_[1]}) w.number(v);
        w.number(uint32_t(f.metadata.size()));
        for (const auto& [k, v] : f.metadata) {
            w.text(k);
            w.text(v);
        }
        if (d.negative) {
            w.number(std::bit_cast<uint64_t>(*d.negative));
            w.number(uint8_t(f.spread_.has_value()));
        }
        if (f.spread_) w.number(f.spread_->steps);
        return std::move(w.bytes);
    }

    /// Writes the sums of one entry of pixels_.
    static void sums(const Film& f, size_t i, PartWriter& w) {
        const size_t n = f.description_.channels.size();
        const Film::Pixel& p = f.pixels_[i];
        for (Int128 v : p.rgb) w.number(UInt128(v));
        w.number(UInt128(p.alpha));
        for (Int128 v : p.replicaY) w.number(UInt128(v));
        for (uint64_t v : p.y2.limb) w.number(v);
        for (uint32_t v : p.replicaCount) w.number(v);
        w.number(UInt128(p.surfaceY));
        for (uint32_t v : p.surfaceCount) w.number(v);
        for (size_t c = 0; c < n; ++c) w.number(UInt128(f.aovs_[i * n + c]));
        if (f.description_.negative) w.number(UInt128(f.weights_[i]));
    }

    static void row(const Film& f, int y, PartWriter& w) {
        const size_t first = f.index(f.window().x0, y);
        for (size_t i = first; i < first + size_t(f.window().width()); ++i) {
            for (size_t at = i; at < f.pixels_.size(); at = f.below(at)) sums(f, at, w);
            if (f.spread_) w.number(f.spread_->rates[i]);
        }
    }

    static size_t sumsBytes(const FilmDescription& d) {
        const size_t one = kPixelBytes + 16 * d.channels.size();
        return d.negative ? 2 * (one + 16) : one;
    }
    static size_t pixelBytes(const Film& f) { return sumsBytes(f.description_) + (f.spread_ ? sizeof f.spread_->rates[0] : 0); }

    /// Returns false if the sums cannot result from the counted samples, because later arithmetic could overflow.
    static bool readSums(Film& f, size_t i, PartReader& r) {
        const size_t n = f.description_.channels.size();
        Film::Pixel& p = f.pixels_[i];
        for (Int128& v : p.rgb) v = Int128(r.number<UInt128>());
        p.alpha = Int128(r.number<UInt128>());
        for (Int128& v : p.replicaY) v = Int128(r.number<UInt128>());
        for (uint64_t& v : p.y2.limb) v = r.number<uint64_t>();
        for (uint32_t& v : p.replicaCount) v = r.number<uint32_t>();
        p.surfaceY = Int128(r.number<UInt128>());
        for (uint32_t& v : p.surfaceCount) v = r.number<uint32_t>();
        for (size_t c = 0; c < n; ++c) f.aovs_[i * n + c] = Int128(r.number<UInt128>());
        if (f.description_.negative) f.weights_[i] = Int128(r.number<UInt128>());
        uint64_t samples = 0;
        for (uint32_t v : p.replicaCount) samples += v;
        if (samples > limits::kSamplesPerPixel) return false;
        Int128 most = Int128(samples) << (60 + kFixedBits);
        auto fits = [&](Int128 v) { return v <= most && v >= -most; };
        bool ok = fits(p.rgb[0]) && fits(p.rgb[1]) && fits(p.rgb[2]) && fits(p.alpha);
        for (uint32_t k = 0; k < kReplicas; ++k) ok = ok && fits(p.replicaY[k]) && p.surfaceCount[k] <= p.replicaCount[k];
        ok = ok && fits(p.surfaceY);
        if (f.description_.negative) ok = ok && fits(f.weights_[i]) && f.weights_[i] >= 0;
        for (size_t c = 0; c < n; ++c)
            ok = ok && (isSum(f.description_.channels[c].rule) ? fits(f.aovs_[i * n + c])
                                                               : f.aovs_[i * n + c] == int32_t(f.aovs_[i * n + c]));
        return ok;
    }

    static bool readRow(Film& f, int y, PartReader& r) {
        const size_t first = f.index(f.window().x0, y);
        for (size_t i = first; i < first + size_t(f.window().width()); ++i) {
            for (size_t at = i; at < f.pixels_.size(); at = f.below(at))
                if (!readSums(f, at, r)) return false;
            if (!f.spread_) continue;
            f.spread_->rates[i] = r.number<uint16_t>();
            if (f.spread_->rates[i] > Spread::kMost || f.spread_->held(i) > limits::kSamplesPerPixel) return false;
        }
        return r.ok;
    }

    /// Makes the film without sums; returns null if the header is invalid. packed: bytes of packed sums in the file.
    static std::unique_ptr<Film> parseHeader(PartReader& r, uint32_t version, size_t packed, const std::string& name,
                                             Diagnostics& diag) {
        FilmDescription d;
        for (int* v : {&d.width, &d.height, &d.window.x0, &d.window.y0, &d.window.x1, &d.window.y1})
            *v = int(r.number<uint32_t>());
        d.seed = r.number<uint64_t>();
        d.scene = r.text();
        uint32_t channels = r.number<uint32_t>();
        for (uint32_t i = 0; r.ok && i < channels; ++i) {
            uint8_t rule = r.number<uint8_t>();
            r.ok = r.ok && rule <= uint8_t(ChannelRule::PartOfBlue);
            d.channels.push_back({r.text(), ChannelRule(rule)});
        }
        std::vector<SampleRange> ranges;
        uint32_t count = r.number<uint32_t>();
        for (uint32_t i = 0; r.ok && i < count; ++i) {
            SampleRange s;
            s.begin = r.number<uint32_t>();
            s.end = r.number<uint32_t>();
            ranges.push_back(s);
        }
        uint64_t counters[5];
        for (uint64_t& c : counters) c = r.number<uint64_t>();
        std::map<std::string, std::string> metadata;
        count = r.number<uint32_t>();
        for (uint32_t i = 0; r.ok && i < count; ++i) {
            std::string key = r.text();
            metadata[key] = r.text();
        }
        bool spread = version == kSpreadVersion;
        if (version == kSignedVersion) {
            d.negative = std::bit_cast<double>(r.number<uint64_t>());
            spread = r.number<uint8_t>() == 1;
            r.ok = r.ok && *d.negative >= 0 && *d.negative < 1e9;
        }
        const uint32_t steps = spread ? r.number<uint32_t>() : 0;
        SourcePlace place{name, 0, 0};
        if (!r.ok || r.at != r.bytes.size()) {
            diag.report(Severity::Error, Rie::BadFile, place, "the header of the part file is damaged");
            return nullptr;
        }
        if (!Film::check(d, diag, place)) return nullptr;
        size_t raw = d.window.pixels() * sumsBytes(d);
        if (raw / kDeflateRatio > packed) {
            diag.report(Severity::Error, Rie::BadFile, place, "the part file is too short for a picture of its size");
            return nullptr;
        }
        auto film = std::make_unique<Film>(std::move(d));
        for (auto s : ranges)
            if (!film->addRange(s)) {
                diag.report(Severity::Error, Rie::BadFile, place, "the part file holds the same samples twice");
                return nullptr;
            }
        if (spread) {
            if (!film->spread(std::vector<uint16_t>(film->window().pixels())) || !film->addSteps(steps)) {
                diag.report(Severity::Error, Rie::BadFile, place, "the part file's numbers of samples are damaged");
                return nullptr;
            }
        }
        film->nonFinite_ = counters[0];
        film->nonFiniteAovs_ = counters[1];
        film->saturated_ = counters[2];
        film->firstDropped_[0] = counters[3];
        film->firstDropped_[1] = counters[4];
        film->metadata = std::move(metadata);
        return film;
    }
};

bool savePart(const Film& film, const std::string& path, const OutputPolicy& policy, Diagnostics& diag,
              const SourcePlace& place) {
    auto file = OutputFile::open(path, policy, diag, place);
    if (!file) return false;
    std::vector<uint8_t> header = FilmIo::header(film);
    if (header.size() > limits::kPartHeaderBytes) {
        diag.report(Severity::Error, Rie::Limit, place,
                    "the header of a part file would be " + std::to_string(header.size()) + " bytes");
        return false;
    }
    PartWriter prefix;
    for (char c : kMagic) prefix.number(uint8_t(c));
    prefix.number(film.description().negative ? kSignedVersion : film.spread() ? kSpreadVersion : kVersion);
    prefix.number(uint32_t(header.size()));
    prefix.number(crc(header));
    file->write(prefix.bytes.data(), prefix.bytes.size());
    file->write(header.data(), header.size());
    Packer packer(*file);
    const Window& w = film.window();
    bool ok = true;
    for (int y = w.y0; ok && y < w.y1; ++y) {
        PartWriter row;
        row.bytes.reserve(size_t(w.width()) * FilmIo::pixelBytes(film));
        FilmIo::row(film, y, row);
        ok = packer.put(row.bytes, y + 1 == w.y1);
    }
    if (!ok && file->ok()) {
        diag.report(Severity::Error, Rie::NoMem, place, "no memory to pack the part file");
        return false;
    }
    PartWriter trailer;
    trailer.number(packer.checksum());
    file->write(trailer.bytes.data(), trailer.bytes.size());
    return file->commit(diag);
}

std::unique_ptr<Film> parsePart(std::span<const uint8_t> bytes, const std::string& name, Diagnostics& diag) {
    auto bad = [&](Rie code, const char* what) -> std::unique_ptr<Film> {
        diag.report(Severity::Error, code, SourcePlace{name, 0, 0}, what);
        return nullptr;
    };
    if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
        return bad(Rie::BadFile, "not a part file");
    PartReader prefix{bytes.subspan(0, std::min(bytes.size(), kPrefix)), sizeof kMagic};
    uint32_t version = prefix.number<uint32_t>(), size = prefix.number<uint32_t>(), sum = prefix.number<uint32_t>();
    if (!prefix.ok) return bad(Rie::BadFile, "the part file is truncated");
    if (version < kVersion || version > kSignedVersion)
        return bad(Rie::Version, version < kVersion
                                     ? "a part file of an older version of this program, which kept other sums of each "
                                       "pixel; render that part again"
                                     : "a part file of a newer version of this program; use that to read it");
    if (size > limits::kPartHeaderBytes || bytes.size() - kPrefix < size_t(size) + 4)
        return bad(Rie::BadFile, "the part file is truncated");
    std::span<const uint8_t> header = bytes.subspan(kPrefix, size), rest = bytes.subspan(kPrefix + size);
    std::span<const uint8_t> packed = rest.first(rest.size() - 4);
    if (crc(header) != sum) return bad(Rie::BadFile, "the header of the part file is damaged");
    PartReader trailer{rest.last(4)};
    if (trailer.number<uint32_t>() != crc(packed)) return bad(Rie::BadFile, "the part file is damaged or truncated");
    PartReader h{header};
    auto film = FilmIo::parseHeader(h, version, packed.size(), name, diag);
    if (!film) return nullptr;
    Unpacker unpacker(packed);
    const Window& w = film->window();
    std::vector<uint8_t> row(size_t(w.width()) * FilmIo::pixelBytes(*film));
    for (int y = w.y0; y < w.y1; ++y) {
        if (!unpacker.get(row)) return bad(Rie::BadFile, "the sums of the part file are damaged");
        PartReader r{row};
        if (!FilmIo::readRow(*film, y, r)) return bad(Rie::BadFile, "the sums of the part file contradict their counts");
    }
    if (!unpacker.atEnd()) return bad(Rie::BadFile, "the part file holds more than its picture");
    return film;
}

std::unique_ptr<Film> loadPart(const std::string& path, Diagnostics& diag) {
    auto bytes = readWholeFile(path, limits::kPartFileBytes, diag);
    return bytes ? parsePart(*bytes, path, diag) : nullptr;
}

void removePart(const std::string& path) {
    char magic[sizeof kMagic];
    std::ifstream in(path, std::ios::binary);
    std::error_code e;
    if (in.read(magic, sizeof magic) && std::memcmp(magic, kMagic, sizeof kMagic) == 0) std::filesystem::remove(path, e);
}

std::unique_ptr<Film> mergeParts(const std::vector<std::string>& paths, Diagnostics& diag) {
    std::unique_ptr<Film> whole;
    for (const std::string& path : paths) {
        auto part = loadPart(path, diag);
        if (!part || (whole && !whole->merge(*part, diag, SourcePlace{path, 0, 0}))) return nullptr;
        if (!whole) whole = std::move(part);
    }
    if (!whole) diag.report(Severity::Error, Rie::MissingData, {}, "no parts to merge");
    return whole;
}

} // namespace alpenglow::render

#include "ri/zip.h"
#include "base/limits.h"
#include "base/randomfile.h"
#include "ri/limits.h"
#include <algorithm>
#include <cctype>
#include <cstring>
#include <fmt/format.h>
#include <zlib.h>

namespace alpenglow::ri {

namespace {

constexpr uint32_t kLocalRecord = 0x04034b50, kCentralRecord = 0x02014b50, kEndRecord = 0x06054b50, kEnd64 = 0x06064b50,
                   kLocator64 = 0x07064b50;
constexpr size_t kLocalBytes = 30, kCentralBytes = 46, kEndBytes = 22, kEnd64Bytes = 56, kLocatorBytes = 20;
constexpr size_t kComment = 65535;          // bytes of the longest comment, at the end of the file
constexpr uint32_t kElsewhere = 0xffffffff; // the value of this field is in the extension for large files
constexpr unsigned kStored = 0, kDeflated = 8;

using Bytes = std::vector<uint8_t>;

uint64_t little(const Bytes& b, size_t at, int n) {
    uint64_t v = 0;
    for (int i = n - 1; i >= 0; --i) v = v << 8 | b[at + size_t(i)];
    return v;
}

struct Member {
    std::string name;
    unsigned flags = 0, method = 0;
    uint32_t crc = 0;
    uint64_t packed = 0, size = 0, at = 0; ///< at: of its local header
};

bool fail(std::string* why, std::string reason) {
    if (why) *why = std::move(reason);
    return false;
}

/// Where the directory lies.
struct Directory {
    uint64_t at = 0, bytes = 0, entries = 0;
};

bool findDirectory(const RandomFile& f, Directory& d, std::string* why) {
    const uint64_t tail = std::min<uint64_t>(f.size(), kEndBytes + kComment);
    Bytes b;
    if (f.size() < kEndBytes || !f.read(f.size() - tail, tail, b)) return fail(why, "it is no zip archive");
    for (size_t i = b.size() - kEndBytes + 1; i-- > 0;) {
        if (little(b, i, 4) != kEndRecord) continue;
        d = {little(b, i + 16, 4), little(b, i + 12, 4), little(b, i + 10, 2)};
        const uint64_t end = f.size() - tail + i;
        Bytes large;
        if (end >= kLocatorBytes && f.read(end - kLocatorBytes, kLocatorBytes, large) && little(large, 0, 4) == kLocator64) {
            const uint64_t at = little(large, 8, 8);
            if (!f.read(at, kEnd64Bytes, large) || little(large, 0, 4) != kEnd64) return fail(why, "its directory is damaged");
            d = {little(large, 48, 8), little(large, 40, 8), little(large, 32, 8)};
        }
        return true;
    }
    return fail(why, "it is no zip archive, or its end is missing");
}

/// The fields that the extension for large files has in place of those of 32 bits.
bool takeLarge(const Bytes& b, size_t at, size_t n, Member& m) {
    for (const size_t end = at + n; at + 4 <= end;) {
        const size_t id = size_t(little(b, at, 2)), bytes = size_t(little(b, at + 2, 2));
        at += 4;
        if (bytes > end - at) return false;
        if (id == 1) {
            size_t next = at;
            for (uint64_t* field : {&m.size, &m.packed, &m.at}) {
                if (*field != kElsewhere) continue;
                if (next + 8 > at + bytes) return false;
                *field = little(b, next, 8);
                next += 8;
            }
            return true;
        }
        at += bytes;
    }
    return m.size != kElsewhere && m.packed != kElsewhere && m.at != kElsewhere;
}

/// Calls `each` for the members until it returns false. False if the directory is damaged.
template <class Each> bool eachMember(const RandomFile& f, std::string* why, Each&& each) {
    Directory d;
    if (!f.regular()) return fail(why, "it cannot be opened, or is no file");
    if (!findDirectory(f, d, why)) return false;
    if (d.entries > limits::kZipEntries || d.bytes > limits::kZipDirectoryBytes) return fail(why, "it holds too many files");
    Bytes b;
    if (!f.read(d.at, d.bytes, b)) return fail(why, "its directory lies outside of it");
    for (size_t at = 0; at + kCentralBytes <= b.size() && little(b, at, 4) == kCentralRecord;) {
        const size_t name = size_t(little(b, at + 28, 2)), extra = size_t(little(b, at + 30, 2)),
                     comment = size_t(little(b, at + 32, 2));
        if (name + extra + comment > b.size() - at - kCentralBytes) return fail(why, "its directory is damaged");
        Member m;
        m.name.assign(reinterpret_cast<const char*>(&b[at]) + kCentralBytes, name);
        m.flags = unsigned(little(b, at + 8, 2));
        m.method = unsigned(little(b, at + 10, 2));
        m.crc = uint32_t(little(b, at + 16, 4));
        m.packed = little(b, at + 20, 4);
        m.size = little(b, at + 24, 4);
        m.at = little(b, at + 42, 4);
        if (!takeLarge(b, at + kCentralBytes + name, extra, m)) return fail(why, "its directory is damaged");
        if (!each(m)) return true;
        at += kCentralBytes + name + extra + comment;
    }
    return true;
}

/// A name as it is compared where none is the same.
std::string plain(std::string_view name) {
    std::string out;
    for (const char c : name) out += c == '\\' ? '/' : char(std::tolower(static_cast<unsigned char>(c)));
    while (out.starts_with("./")) out.erase(0, 2);
    while (out.starts_with('/')) out.erase(0, 1);
    return out;
}

class Inside : public ByteSource {
public:
    Inside(std::unique_ptr<RandomFile> f, const Member& m, uint64_t at)
        : file_(std::move(f)), member_(m), at_(at), end_(at + m.packed) {
        deflated_ = m.method == kDeflated;
        if (deflated_ && inflateInit2(&z_, -15) != Z_OK) end("zlib could not be started");
    }
    ~Inside() override {
        if (deflated_) inflateEnd(&z_);
    }
    size_t read(char* out, size_t size) override {
        if (over_ || size == 0) return 0;
        const size_t n = deflated_ ? inflated(out, size) : stored(out, size);
        crc_ = uint32_t(crc32(crc_, reinterpret_cast<const Bytef*>(out), uInt(n)));
        total_ += n;
        if (total_ > member_.size || total_ > limits::kGzipBytes) {
            limitHit_ = total_ > limits::kGzipBytes;
            return end("the zip member is longer than it says");
        }
        if (n == 0 && failure_.empty()) {
            over_ = true;
            if (total_ != member_.size || crc_ != member_.crc) end("the zip member is damaged: its check sum is another one");
        }
        return n;
    }

private:
    size_t end(std::string why) {
        over_ = true;
        if (failure_.empty()) failure_ = std::move(why);
        return 0;
    }
    bool refill(size_t most) {
        const uint64_t n = std::min<uint64_t>(most, end_ - at_);
        if (n == 0 || !file_->read(at_, n, in_)) return false;
        at_ += n;
        return true;
    }
    size_t stored(char* out, size_t size) {
        if (at_ == end_) return 0;
        if (!refill(size)) return end("the zip archive ends early");
        std::memcpy(out, in_.data(), in_.size());
        return in_.size();
    }
    size_t inflated(char* out, size_t size) {
        const size_t want = std::min<size_t>(size, 1u << 30);
        z_.next_out = reinterpret_cast<Bytef*>(out);
        z_.avail_out = uInt(want);
        while (z_.avail_out == want && !finished_) {
            if (z_.avail_in == 0) {
                constexpr size_t kPiece = 64u << 10;
                if (!refill(kPiece)) return end("the zip archive ends early");
                z_.next_in = in_.data();
                z_.avail_in = uInt(in_.size());
            }
            const int r = inflate(&z_, Z_NO_FLUSH);
            if (r == Z_STREAM_END) finished_ = true;
            else if (r != Z_OK && r != Z_BUF_ERROR) return end("the zip member is damaged");
        }
        return want - z_.avail_out;
    }

    std::unique_ptr<RandomFile> file_;
    const Member member_;
    uint64_t at_, end_; ///< what is not read yet
    Bytes in_;
    z_stream z_{};
    bool deflated_ = false, finished_ = false, over_ = false;
    uint64_t total_ = 0;
    uint32_t crc_ = 0;
};

/// Where a member's bytes begin.
bool findData(const RandomFile& f, const Member& m, uint64_t& at, std::string* why) {
    Bytes b;
    if (!f.read(m.at, kLocalBytes, b) || little(b, 0, 4) != kLocalRecord) return fail(why, "its directory is damaged");
    at = m.at + kLocalBytes + little(b, 26, 2) + little(b, 28, 2);
    if (at > f.size() || m.packed > f.size() - at) return fail(why, "it ends early");
    return true;
}

} // namespace

std::vector<std::string> zipMembers(const std::string& zip, size_t most, std::string* why) {
    std::vector<std::string> names;
    eachMember(RandomFile(zip), why, [&](const Member& m) {
        if (!m.name.ends_with('/')) names.push_back(m.name);
        return names.size() < most;
    });
    return names;
}

std::unique_ptr<ByteSource> zipSource(const std::string& zip, const std::string& name, std::string* why) {
    auto f = std::make_unique<RandomFile>(zip);
    std::optional<Member> member;
    const std::string wanted = plain(name);
    const bool read = eachMember(*f, why, [&](const Member& m) {
        if (m.name == name) member = m;
        else if (!member && plain(m.name) == wanted) member = m;
        return m.name != name;
    });
    if (!read) return nullptr;
    uint64_t at = 0;
    if (!member) fail(why, fmt::format("there is no \"{}\" in it", name));
    else if (member->flags & 1) fail(why, "it is encrypted");
    else if (member->method != kStored && member->method != kDeflated)
        fail(why, fmt::format("it is packed by method {}; stored and deflated ones are read", member->method));
    else if (member->size > limits::kGzipBytes || member->size / limits::kGzipRatio > std::max<uint64_t>(member->packed, 1024))
        fail(why, "it inflates beyond the limit");
    else if (findData(*f, *member, at, why)) return std::make_unique<Inside>(std::move(f), *member, at);
    return nullptr;
}

std::unique_ptr<ByteSource> onlyRibOfZip(const std::string& zip, std::string* why) {
    std::vector<std::string> ribs;
    std::string reason;
    for (std::string& m : zipMembers(zip, limits::kZipEntries, &reason)) {
        const std::string name = plain(m);
        if (name.ends_with(".rib") || name.ends_with(".ribz") || name.ends_with(".rib.gz")) ribs.push_back(std::move(m));
    }
    if (ribs.size() == 1) return zipSource(zip, ribs[0], why);
    if (ribs.empty()) fail(why, reason.empty() ? "no RIB file is in it" : reason);
    else fail(why, fmt::format("{} RIB files are in it; name one of them: \"{}!{}\"", ribs.size(), zip, ribs[0]));
    return nullptr;
}

} // namespace alpenglow::ri

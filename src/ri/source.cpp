#include "ri/source.h"
#include "base/limits.h"
#include "ri/zip.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>
#include <zlib.h>

namespace alpenglow::ri {
namespace {

class Memory : public ByteSource {
public:
    explicit Memory(std::string_view t) : text_(t) {}
    size_t read(char* out, size_t size) override {
        size_t n = std::min(size, text_.size());
        if (n) std::memcpy(out, text_.data(), n);
        text_.remove_prefix(n);
        return n;
    }

private:
    std::string_view text_;
};

class Stream : public ByteSource {
public:
    explicit Stream(std::istream& in) : in_(in) {}
    size_t read(char* out, size_t size) override {
        // One blocking byte, then what is buffered: a pipe's requests are seen as soon as they are written.
        if (!size || !in_.get(*out)) return 0;
        return 1 + size_t(std::max<std::streamsize>(0, in_.readsome(out + 1, std::streamsize(size - 1))));
    }

private:
    std::istream& in_;
};

class File : public ByteSource {
public:
    File(int fd, bool owned, const StopFlag* stop) : fd_(fd), owned_(owned), stop_(stop) {}
    ~File() override {
        if (owned_) ::close(fd_);
    }
    size_t read(char* out, size_t size) override {
        ssize_t n;
        do {
            if (!waitForBytes()) return 0;
            n = ::read(fd_, out, size); // what is available: requests of a pipe are executed at once
        } while (n < 0 && (errno == EINTR || errno == EAGAIN));
        if (n < 0) failure_ = std::string("read error: ") + std::strerror(errno);
        return n > 0 ? size_t(n) : 0;
    }

private:
    /// Until there is something, be it the end; false: stopped. A system call that waits would begin anew after a signal.
    bool waitForBytes() const {
        constexpr int kMilliseconds = 50;
        pollfd p{fd_, POLLIN, 0};
        while (stop_ && !*stop_ && ::poll(&p, 1, kMilliseconds) <= 0) {}
        return !stop_ || !*stop_;
    }
    int fd_;
    bool owned_;
    const StopFlag* stop_; ///< may be null
};

/// Bytes already taken from a stream, then the rest of it; null: there is none.
class Prefixed : public ByteSource {
public:
    Prefixed(std::string head, std::unique_ptr<ByteSource> rest) : head_(std::move(head)), rest_(std::move(rest)) {}
    size_t read(char* out, size_t size) override {
        if (used_ < head_.size()) {
            size_t n = std::min(size, head_.size() - used_);
            std::memcpy(out, head_.data() + used_, n);
            used_ += n;
            return n;
        }
        size_t n = rest_ ? rest_->read(out, size) : 0;
        if (n == 0 && rest_) failure_ = rest_->failure();
        return n;
    }

private:
    std::string head_;
    size_t used_ = 0;
    std::unique_ptr<ByteSource> rest_;
};

class Gzip : public ByteSource {
public:
    Gzip(std::unique_ptr<ByteSource> raw, size_t most) : raw_(std::move(raw)), most_(most), in_(64 << 10) {
        ok_ = inflateInit2(&z_, 15 + 16) == Z_OK;
        if (!ok_) failure_ = "zlib could not be started";
    }
    ~Gzip() override { inflateEnd(&z_); }
    size_t read(char* out, size_t size) override {
        if (!ok_ || size == 0) return 0;
        size_t want = std::min<size_t>(size, 1u << 30);
        z_.next_out = reinterpret_cast<Bytef*>(out);
        z_.avail_out = uInt(want);
        while (z_.avail_out == want) {
            if (z_.avail_in == 0 && !refill()) return end(between_ ? "" : "the gzip data ends early");
            if (between_ && !nextMember()) return 0;
            int r = inflate(&z_, Z_NO_FLUSH);
            if (r == Z_STREAM_END) {
                between_ = true;
            } else if (r != Z_OK && r != Z_BUF_ERROR) {
                size_t n = want - z_.avail_out;
                if (n == 0) return end(std::string("damaged gzip data") + (z_.msg ? std::string(": ") + z_.msg : ""));
                ok_ = false;
                failure_ = "damaged gzip data";
                return n;
            }
        }
        size_t n = want - z_.avail_out;
        total_ += n;
        constexpr size_t kFree = 1 << 20; // small files may compress well
        if (total_ > most_ || (total_ > kFree && total_ / limits::kGzipRatio > consumed_)) {
            limitHit_ = true;
            return end("the gzip data inflates beyond the limit");
        }
        return n;
    }

private:
    size_t end(std::string why) {
        ok_ = false;
        failure_ = std::move(why);
        return 0;
    }
    bool refill() {
        size_t n = raw_->read(in_.data(), in_.size());
        z_.next_in = reinterpret_cast<Bytef*>(in_.data());
        z_.avail_in = uInt(n);
        consumed_ += n;
        return n > 0;
    }
    /// After a member: another one, or padding, which is skipped like gunzip does.
    bool nextMember() {
        if (*z_.next_in != 0x1f) {
            end("");
            return false;
        }
        between_ = false;
        return inflateReset(&z_) == Z_OK;
    }

    std::unique_ptr<ByteSource> raw_;
    size_t most_; ///< inflated bytes
    std::vector<char> in_;
    z_stream z_{};
    bool ok_ = false, between_ = false;
    size_t total_ = 0, consumed_ = 0;
};

} // namespace

std::unique_ptr<ByteSource> memorySource(std::string_view text) { return std::make_unique<Memory>(text); }
std::unique_ptr<ByteSource> streamSource(std::istream& in) { return std::make_unique<Stream>(in); }

std::unique_ptr<ByteSource> fileSource(const std::string& path, std::string* why, bool regular, const StopFlag* stop) {
    std::error_code ec;
    if (const auto inside = zipName(path); inside && !std::filesystem::exists(path, ec))
        return zipSource(inside->zip, inside->member, why);
    if (zipName(path + "!") && std::filesystem::is_regular_file(path, ec)) return onlyRibOfZip(path, why);
    const bool waits = stop && std::filesystem::is_fifo(path, ec); // for its writer: where it is read, not where it is opened
    if (std::filesystem::is_directory(path, ec)) {
        if (why) *why = "it is a directory";
        return nullptr;
    }
    int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | (regular || waits ? O_NONBLOCK : 0));
    if (fd < 0) {
        if (why) *why = std::strerror(errno);
        return nullptr;
    }
    struct stat st{};
    if (regular && (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode))) {
        if (why) *why = "it is not a regular file";
        ::close(fd);
        return nullptr;
    }
    return std::make_unique<File>(fd, true, stop);
}

std::unique_ptr<ByteSource> inMemory(std::unique_ptr<ByteSource> source, size_t most) {
    std::string head;
    char part[4096];
    while (head.size() < most) {
        const size_t n = source->read(part, sizeof part);
        if (n == 0) break;
        head.append(part, n);
    }
    if (head.size() < most && source->failure().empty()) source.reset();
    return std::make_unique<Prefixed>(std::move(head), std::move(source));
}

std::unique_ptr<ByteSource> standardInput(const StopFlag* stop) { return std::make_unique<File>(STDIN_FILENO, false, stop); }

std::unique_ptr<ByteSource> inflating(std::unique_ptr<ByteSource> raw, size_t most) {
    std::string head;
    while (head.size() < 2) {
        char c;
        if (raw->read(&c, 1) == 0) break;
        head += c;
        if (head[0] != '\x1f') break;
    }
    bool gzip = head == "\x1f\x8b";
    auto whole = std::make_unique<Prefixed>(std::move(head), std::move(raw));
    if (gzip) return std::make_unique<Gzip>(std::move(whole), most);
    return whole;
}

} // namespace alpenglow::ri

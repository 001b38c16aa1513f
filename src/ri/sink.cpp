#include "ri/sink.h"
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

namespace alpenglow::ri {
namespace {

class TextSink : public ByteSink {
public:
    explicit TextSink(std::string& to) : to_(to) {}
    bool write(std::string_view bytes) override {
        to_ += bytes;
        return true;
    }
    bool flush() override { return true; }

private:
    std::string& to_;
};

class StreamSink : public ByteSink {
public:
    explicit StreamSink(std::ostream& to) : to_(to) {}
    bool write(std::string_view bytes) override { return good(bool(to_.write(bytes.data(), std::streamsize(bytes.size())))); }
    bool flush() override { return good(bool(to_.flush())); }

private:
    bool good(bool yes) {
        if (!yes && failure_.empty()) failure_ = "the stream takes no more";
        return yes;
    }
    std::ostream& to_;
};

class DescriptorSink : public ByteSink {
public:
    DescriptorSink(int fd, bool owned) : fd_(fd), owned_(owned) {}
    ~DescriptorSink() override {
        if (fd_ >= 0 && owned_) ::close(fd_);
    }
    bool write(std::string_view bytes) override {
        while (!bytes.empty()) {
            if (fd_ < 0 || !failure_.empty()) return false;
            const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) failure_ = std::strerror(errno);
            else bytes.remove_prefix(size_t(n));
        }
        return true;
    }
    bool flush() override { return failure_.empty(); }
    bool finish() override {
        if (owned_ && fd_ >= 0 && ::close(fd_) != 0 && failure_.empty()) failure_ = std::strerror(errno); // full disks over NFS
        if (owned_) fd_ = -1;
        return failure_.empty();
    }

private:
    int fd_;
    bool owned_;
};

class OutputSink : public ByteSink {
public:
    explicit OutputSink(OutputFile& to) : to_(to) {}
    bool write(std::string_view bytes) override {
        if (to_.write(bytes.data(), bytes.size())) return true;
        failure_ = "writing failed"; // the file keeps the reason and reports it when it is committed
        return false;
    }
    bool flush() override { return to_.ok(); }

private:
    OutputFile& to_;
};

class Deflating : public ByteSink {
public:
    explicit Deflating(std::unique_ptr<ByteSink> to) : to_(std::move(to)) {
        constexpr int kGzip = 15 + 16, kMemory = 8;
        ok_ = deflateInit2(&z_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) == Z_OK;
        if (!ok_) failure_ = "zlib could not be started";
    }
    ~Deflating() override { deflateEnd(&z_); }
    bool write(std::string_view bytes) override {
        while (!bytes.empty() && ok_) {
            const size_t n = std::min<size_t>(bytes.size(), 1u << 30);
            z_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
            z_.avail_in = uInt(n);
            if (!pump(Z_NO_FLUSH)) return false;
            bytes.remove_prefix(n);
        }
        return ok_;
    }
    bool flush() override { return pump(Z_SYNC_FLUSH) && below(to_->flush()); }
    bool finish() override { return pump(Z_FINISH) && below(to_->finish()); }

private:
    /// Runs zlib until it has consumed its input and written all output of this kind of flush.
    bool pump(int how) {
        if (!ok_) return false;
        int r;
        do {
            z_.next_out = reinterpret_cast<Bytef*>(out_.data());
            z_.avail_out = uInt(out_.size());
            r = deflate(&z_, how); // Z_BUF_ERROR: there is nothing to do
            const size_t n = out_.size() - z_.avail_out;
            if (n > 0 && !below(to_->write({out_.data(), n}))) return false;
        } while (z_.avail_out == 0 && r != Z_STREAM_END);
        return true;
    }
    bool below(bool yes) {
        if (!yes) {
            ok_ = false;
            failure_ = to_->failure();
        }
        return yes;
    }

    std::unique_ptr<ByteSink> to_;
    z_stream z_{};
    bool ok_ = false;
    std::array<char, 64 << 10> out_;
};

} // namespace

std::unique_ptr<ByteSink> stringSink(std::string& to) { return std::make_unique<TextSink>(to); }
std::unique_ptr<ByteSink> streamSink(std::ostream& to) { return std::make_unique<StreamSink>(to); }
std::unique_ptr<ByteSink> descriptorSink(int fd) { return std::make_unique<DescriptorSink>(fd, false); }

std::unique_ptr<ByteSink> fileSink(const std::string& path, std::string* why) {
    constexpr mode_t kMode = 0666; // less what the user masks
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
    if (fd < 0) {
        if (why) *why = std::strerror(errno);
        return nullptr;
    }
    return std::make_unique<DescriptorSink>(fd, true);
}

std::unique_ptr<ByteSink> outputSink(OutputFile& to) { return std::make_unique<OutputSink>(to); }
std::unique_ptr<ByteSink> deflating(std::unique_ptr<ByteSink> to) { return std::make_unique<Deflating>(std::move(to)); }

} // namespace alpenglow::ri

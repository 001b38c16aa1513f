#include "render/framerecords.h"
#include <cstring>
#include <map>
#include <type_traits>

namespace alpenglow::render {
namespace {

// Members in one order for both directions.
template <class A> void each(A& a, SourcePlace& p) { a(p.file, p.line, p.column); }
template <class A> void each(A& a, FixIt& f) { a(f.place, f.length, f.text); }
template <class A> void each(A& a, Diagnostic& d) {
    a(d.severity, d.code, d.place, d.message, d.hint, d.sourceLine, d.id, d.length, d.notes, d.fixes, d.always, d.ignored,
      d.once);
}
template <class A> void each(A& a, RenderStats& s) {
    a(s.width, s.height, s.spp, s.sppLeast, s.sppMost, s.renderSec, s.cpuSec, s.totalRays, s.noise, s.curve, s.threads,
      s.peakMemoryBytes, s.threadBytes, s.parseSec, s.compileSec, s.buildSec, s.nonFinite, s.saturated, s.rays, s.classic,
      s.shading, s.guide, s.lightGuide, s.depth, s.errors, s.warnings, s.lanesUsed, s.lanesRun, s.depthSum, s.paths);
}
template <class A> void each(A& a, FrameStats::Picture& p) { a(p.file, p.type, p.channels); }
template <class A> void each(A& a, FrameStats::Texture& t) { a(t.file, t.fileBytes, t.memoryBytes, t.scratchBytes); }
template <class A> void each(A& a, FrameStats& f) {
    a(f.frame, f.scene, f.sceneHash, f.hider, f.seed, f.pictures, f.textures, f.figures);
}
template <class A> void each(A& a, FrameResult& r) { a(r.outcome, r.stats, r.parseSec, r.grown); }

class RecordPacker {
public:
    template <class... T> void operator()(T&... values) { (put(values), ...); }
    std::string bytes;

private:
    template <class T> void put(T& v) {
        if constexpr (std::is_trivially_copyable_v<T>) bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
        else each(*this, v);
    }
    void count(uint64_t n) { put(n); }
    void put(std::string& s) {
        count(s.size());
        bytes += s;
    }
    template <class T> void put(std::vector<T>& all) {
        count(all.size());
        for (T& v : all) put(v);
    }
    template <class T> void put(std::map<std::string, T>& all) {
        count(all.size());
        for (auto& [key, v] : all) {
            std::string name = key;
            (*this)(name, v);
        }
    }
    template <class T> void put(std::optional<T>& v) {
        count(v ? 1 : 0);
        if (v) put(*v);
    }
};

/// If bytes are missing, sets `fine` to false and reads nothing more.
class RecordUnpacker {
public:
    explicit RecordUnpacker(std::string_view b) : bytes_(b) {}
    template <class... T> void operator()(T&... values) { (get(values), ...); }
    bool fine() const { return fine_ && bytes_.empty(); }

private:
    bool take(void* to, size_t n) {
        if (!(fine_ &= n <= bytes_.size())) return false;
        std::memcpy(to, bytes_.data(), n);
        bytes_.remove_prefix(n);
        return true;
    }
    template <class T> void get(T& v) {
        if constexpr (std::is_trivially_copyable_v<T>) take(&v, sizeof v);
        else each(*this, v);
    }
    size_t count() { // each element has at least one byte
        uint64_t n = 0;
        get(n);
        if (!(fine_ &= n <= bytes_.size())) return 0;
        return size_t(n);
    }
    void get(std::string& s) {
        s.resize(count());
        take(s.data(), s.size());
    }
    template <class T> void get(std::vector<T>& all) {
        all.resize(count());
        for (T& v : all) get(v);
    }
    template <class T> void get(std::map<std::string, T>& all) {
        all.clear();
        for (size_t n = count(); n > 0; --n) {
            std::string key;
            get(key);
            get(all[key]);
        }
    }
    template <class T> void get(std::optional<T>& v) {
        v.reset();
        if (count()) get(v.emplace());
    }
    std::string_view bytes_;
    bool fine_ = true;
};

template <class T> std::string bytesOf(T& v) {
    RecordPacker p;
    each(p, v);
    return std::move(p.bytes);
}

template <class T> bool fromBytes(std::string_view bytes, T& v) {
    RecordUnpacker u(bytes);
    each(u, v);
    return u.fine();
}

} // namespace

std::string packed(Diagnostic d) { return bytesOf(d); }
std::string packed(FrameResult r) { return bytesOf(r); }
bool unpack(std::string_view bytes, Diagnostic& d) { return fromBytes(bytes, d); }
bool unpack(std::string_view bytes, FrameResult& r) { return fromBytes(bytes, r); }

} // namespace alpenglow::render

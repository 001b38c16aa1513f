#include "rsl/jit/kernelfile.h"
#include "base/digest.h"
#include <cstring>

namespace alpenglow::rsl::jit {
namespace {

constexpr char kMagic[] = "alpenglow kernel 5\n";
constexpr size_t kDigest = 16; // digits

// One function a type describes both directions: `a(x)` writes x or reads it.
struct Writer {
    std::string bytes;
    static constexpr bool kReads = false;
    bool ok = true;
    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void operator()(T& v) {
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    void operator()(std::string& s) {
        uint64_t n = s.size();
        (*this)(n);
        bytes += s;
    }
    template <class T> void operator()(std::vector<T>& v);
};

struct Loader {
    const std::string& bytes;
    size_t at;
    bool ok = true;
    static constexpr bool kReads = true;
    template <class T>
        requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void operator()(T& v) {
        if (bytes.size() - at < sizeof v) {
            ok = false;
            return;
        }
        std::memcpy(&v, bytes.data() + at, sizeof v);
        at += sizeof v;
    }
    void operator()(std::string& s) {
        uint64_t n = 0;
        (*this)(n);
        if (!ok || n > bytes.size() - at) {
            ok = false;
            return;
        }
        s.assign(bytes, at, n);
        at += n;
    }
    template <class T> void operator()(std::vector<T>& v);
};

template <class A> void item(A& a, Type& t) {
    a(t.base);
    a(t.array);
}
template <class A> void item(A& a, Place& p) {
    a(p.file);
    a(p.line);
    a(p.column);
}
template <class A> void item(A& a, std::string& s) { a(s); }
template <class A> void item(A& a, ir::Kind& k) { a(k); }
template <class A> void item(A& a, ir::Input& i) {
    a(i.name);
    a(i.kind);
    item(a, i.type);
    a(i.array);
    a(i.uniform);
    a(i.order);
}
template <class A> void item(A& a, ir::OutputSlot& o) {
    a(o.name);
    a(o.kind);
    item(a, o.type);
}
template <class A> void item(A& a, ir::Site& s) {
    a(s.op);
    a(s.strings);
    a(s.names);
    a(s.pairStrings);
    a(s.argKinds);
    a(s.argTypes);
    a(s.resultKinds);
    a(s.resultNames);
    item(a, s.resultType);
    a(s.pure);
    item(a, s.place);
    std::string name = s.shadeop ? s.shadeop->name : std::string();
    a(name);
    if (A::kReads) s.shadeop = name.empty() ? nullptr : findShadeop(name);
}
template <class A> void item(A& a, ir::KernelFacts::NonLinear& n) {
    a(n.op);
    a(n.why);
    item(a, n.place);
}
template <class A> void item(A& a, ir::KernelFacts& f) {
    a(f.affine);
    a(f.whyNot);
    a(f.suspends);
    a(f.lightLoops);
    a(f.direct);
    a(f.ambientLight);
    a(f.blocks);
    a(f.opacity);
    a(f.writes);
}
template <class A> void item(A& a, Diagnostic& d) {
    a(d.severity);
    a(d.code);
    a(d.place.file);
    a(d.place.line);
    a(d.place.column);
    a(d.message);
    a(d.id);
    a(d.hint);
    a(d.sourceLine);
}
template <class A> void item(A& a, KernelFile& k) {
    a(k.key);
    a(k.inputs);
    a(k.outputs);
    a(k.sites);
    a(k.files);
    item(a, k.facts);
    a(k.strings);
    a(k.strip);
    a(k.suspending);
    a(k.localBytes);
    a(k.messages);
    a(k.object);
}

template <class T> void Writer::operator()(std::vector<T>& v) {
    uint64_t n = v.size();
    (*this)(n);
    for (T& t : v) item(*this, t);
}

template <class T> void Loader::operator()(std::vector<T>& v) {
    uint64_t n = 0;
    (*this)(n);
    if (n > bytes.size() - at) ok = false; // every element takes a byte at least
    for (uint64_t i = 0; ok && i < n; i++) {
        T t{};
        item(*this, t);
        v.push_back(std::move(t));
    }
}

} // namespace

std::string pack(const KernelFile& k) {
    Writer w;
    KernelFile copy = k;
    item(w, copy);
    return kMagic + digestText(digest(w.bytes)) + w.bytes;
}

std::optional<KernelFile> unpack(const std::string& bytes) {
    const size_t head = sizeof kMagic - 1;
    if (bytes.size() < head + kDigest || bytes.compare(0, head, kMagic) != 0) return {};
    if (digestText(digest(std::string_view(bytes).substr(head + kDigest))) != bytes.substr(head, kDigest)) return {};
    Loader r{bytes, head + kDigest};
    KernelFile k;
    item(r, k);
    if (!r.ok || r.at != bytes.size()) return {};
    return k;
}

} // namespace alpenglow::rsl::jit

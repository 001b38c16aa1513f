#include "ri/c/client.h"
#include "ri/c/errors.h"
#include "ri/c/strings.h"
#include "ri/decimal.h"
#include "ri/parser.h"
#include "scene/scene.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <fmt/format.h>
#include <mutex>
#include <new>

namespace alpenglow::ri {

namespace {

thread_local Client* tLibrary = nullptr; ///< whose calls this thread's are while it makes content
thread_local int tDepth = 0;             ///< calls of ri.h within each other
std::atomic<Client*> gOfProcess{nullptr};

std::recursive_mutex& callsMutex() {
    static auto* m = new std::recursive_mutex; // also for calls while the program ends
    return *m;
}

constexpr size_t kMostPairs = 10'000; // a list without RI_NULL runs into what is behind it; not for ever

} // namespace

Client* Client::current() { return tLibrary ? tLibrary : gOfProcess.load(); }
void Client::setOfProcess(Client* c) { gOfProcess = c; }

LibraryCalls::LibraryCalls(Interpreter& to, const Call& call)
    : target_(to), client_{target_, call.place, ", called by a library"}, outer_(tLibrary) {
    tLibrary = &client_;
}
LibraryCalls::~LibraryCalls() { tLibrary = outer_; }

CallsTo::CallsTo(Target& to, const SourcePlace& place, const char* by) : client_{to, place, by}, outer_(tLibrary) {
    tLibrary = &client_;
}
CallsTo::~CallsTo() { tLibrary = outer_; }

Boundary::Boundary() : locked_(!tLibrary) {
    if (locked_) callsMutex().lock();
    if (tDepth++ == 0 && locked_)
        if (Client* c = Client::current()) ++c->place.line;
}

Boundary::~Boundary() {
    --tDepth;
    if (!locked_) return;
    callsMutex().unlock();
    if (tDepth == 0) deliverErrors();
}

Pairs::Pairs(va_list list) {
    while (tokens.size() < kMostPairs) {
        RtToken token = va_arg(list, RtToken);
        if (!token) return;
        tokens.push_back(token);
        values.push_back(va_arg(list, RtPointer));
    }
}

int64_t total(const RtInt* counts, int64_t n) {
    int64_t sum = 0;
    for (int64_t i = 0; i < n; ++i) {
        if (counts[i] < 0) return -1;
        sum += counts[i];
    }
    return sum;
}

double numberOf(RtFloat f) { return f == std::floor(f) && std::fabs(f) < 1e7f ? double(f) : decimalOf(f); }

RtPointer newHandle(Client& c) { return reinterpret_cast<RtPointer>(uintptr_t(c.to.nextHandle())); }

std::string handleName(const Client& c, RtPointer handle) {
    const auto number = reinterpret_cast<uintptr_t>(handle);
    return c.to.handleName(number <= uintptr_t(INT32_MAX) ? int(number) : 0);
}

Building::Building(const char* request) : client_(Client::current()) {
    if (!client_) noteNotStarted(fmt::format("Ri{}", request).c_str());
    if (client_ && client_->to.stopped()) client_ = nullptr;
    if (client_) request_ = findRequest(request);
    if (!request_) client_ = nullptr;
}

void Building::drop(Rie code, const std::string& why, const std::string& hint) {
    report(Severity::Error, code, why, hint);
    client_ = nullptr;
}

void Building::report(Severity severity, Rie code, const std::string& why, const std::string& hint) {
    if (!client_) return;
    client_->to.reporter().report(severity, code, client_->place, fmt::format("Ri{}{}: {}", request_->name, client_->by, why),
                                  hint);
}

bool Building::may(int64_t n, std::initializer_list<const void*> arrays) {
    if (n < 0) drop(Rie::Consistency, "a count is negative");
    else if (n > 0 && std::find(arrays.begin(), arrays.end(), nullptr) != arrays.end())
        drop(Rie::Consistency, "an argument is a null pointer");
    return client_ != nullptr;
}

Value& Building::add(Value::Kind kind, bool array) {
    Value& v = values_.emplace_back();
    v.kind = kind;
    v.array = array;
    v.line = client_->place.line;
    v.column = client_->place.column;
    return v;
}

Building& Building::number(double d) {
    if (client_) add(Value::Kind::Numbers, false).numbers = {d};
    return *this;
}

Building& Building::number(RtFloat f) { return number(numberOf(f)); }

template <class T> void Building::addNumbers(const T* from, int64_t n, double (*number)(T)) {
    if (!may(n, {from})) return;
    if (!endsWhereItCanBeRead(from, size_t(n) * sizeof(T)))
        return drop(Rie::Consistency, fmt::format("an array is shorter than the {} numbers that it should have", n));
    try {
        Value& v = add(n ? Value::Kind::Numbers : Value::Kind::Empty, true);
        v.numbers.resize(size_t(n));
        std::transform(from, from + n, v.numbers.begin(), number);
    } catch (const std::bad_alloc&) { // not through the frames of the caller
        drop(Rie::NoMem, "there is no memory for it");
    }
}

Building& Building::numbers(const RtFloat* f, int64_t n) {
    addNumbers<RtFloat>(f, n, numberOf);
    return *this;
}

Building& Building::ints(const RtInt* i, int64_t n) {
    addNumbers<RtInt>(i, n, [](RtInt k) { return double(k); });
    return *this;
}

Building& Building::text(const char* s) {
    if (may(1, {s})) add(Value::Kind::Strings, false).strings = {s};
    return *this;
}

Building& Building::texts(const RtToken* s, int64_t n) {
    if (!may(n, {s})) return *this;
    if (!endsWhereItCanBeRead(s, size_t(n) * sizeof *s)) {
        drop(Rie::Consistency, fmt::format("an array is shorter than the {} strings that it should have", n));
        return *this;
    }
    for (int64_t i = 0; i < n; ++i)
        if (!may(1, {s[i]})) return *this;
    add(n ? Value::Kind::Strings : Value::Kind::Empty, true).strings.assign(s, s + n);
    return *this;
}

void Building::stringValues(const char* token, const void* values, int64_t n) {
    if (const auto text = textInsteadOfAddress(values)) {
        client_->to.reporter().once(
            fmt::format("ri:c:text:{}", token), Severity::Warning, Rie::Consistency, client_->place,
            fmt::format("Ri{}{}: the value of \"{}\" is a text, where the address of an RtString is due; the text is taken",
                        request_->name, client_->by, std::string(token).substr(0, 80)),
            "RtString on = \"on\"; and &on as the value");
        const RtToken one = text->c_str();
        texts(&one, 1);
        return;
    }
    texts(static_cast<const RtToken*>(values), n);
}

void Building::parameter(const char* token, const void* values, const scene::VariableCounts& counts,
                         const std::string& category) {
    // A connection of RIS: its values are texts whatever the type behind the word.
    const std::string_view whole = token;
    const bool connects = whole.starts_with("reference ");
    const Resolved r = client_->to.declarations().resolve(connects ? whole.substr(10) : whole, category);
    if (!r.declaration) {
        client_->to.reporter().error(Rie::BadToken, client_->place,
                                     fmt::format("Ri{}{}: \"{}\" is not declared and left out", request_->name, client_->by,
                                                 std::string(token).substr(0, 80)),
                                     "RiDeclare, or the declaration in the token: \"varying float name\"");
        return;
    }
    const Declaration& d = *r.declaration;
    int64_t n = counts.of(d.cls) * std::max(1, d.arrayLength);
    const int samples = client_->to.colorSamples();
    if (!connects) n *= d.type == scene::Type::Color ? samples : scene::componentCount(d.type);
    text(token);
    if (!may(n, {values})) return;
    if (connects || d.type == scene::Type::String) stringValues(token, values, n);
    else if (d.type == scene::Type::Integer) ints(static_cast<const RtInt*>(values), n);
    else addNumbers<RtFloat>(static_cast<const RtFloat*>(values), n, [](RtFloat f) { return double(f); }); // kept as floats
}

Building& Building::parameters(RtInt n, const RtToken* tokens, const RtPointer* values, const scene::VariableCounts* counts,
                               const std::string& category) {
    scene::VariableCounts one;
    one.varying = one.vertex = one.faceVarying = 1;
    if (!may(n, {tokens, values})) return *this;
    for (RtInt i = 0; i < n && client_; ++i)
        if (may(1, {tokens[i]})) parameter(tokens[i], values[i], counts ? *counts : one, category);
    return *this;
}

Building& Building::variables(RtInt n, const RtToken* tokens, const RtPointer* values, const scene::Primitive& p) {
    if (!client_) return *this;
    const scene::VariableCounts counts = counted(p);
    return client_ ? parameters(n, tokens, values, &counts) : *this;
}

scene::VariableCounts Building::counted(const scene::Primitive& p) {
    scene::VariableCounts counts;
    std::string why;
    if (!scene::variableCounts(p, &counts, &why)) drop(Rie::Consistency, why);
    return counts;
}

void Building::finish(const std::function<void(const Call&)>& how) {
    if (!client_) return;
    Client& client = *client_;
    const auto failed = [&](Rie code, const std::string& what) {
        client.to.reporter().error(code, client.place, fmt::format("Ri{}{}: {}", request_->name, client.by, what));
    };
    try {
        Call call;
        call.place = client.place;
        call.request = request_;
        if (matchArguments(values_, call, client.to.reporter())) how(call);
    } catch (const std::bad_alloc&) { // not through the frames of the caller
        failed(Rie::NoMem, "there is no memory for it");
    } catch (const std::exception& e) { failed(Rie::Bug, e.what()); }
}

} // namespace alpenglow::ri

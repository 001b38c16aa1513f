#include "ri/c/client.h"
#include "ri/parser.h"
#include "scene/scene.h"
#include <algorithm>
#include <fmt/format.h>
#include <new>

namespace alpenglow::ri {

namespace {

thread_local Client* tCurrent = nullptr;

constexpr size_t kMostPairs = 10'000; // a list without RI_NULL runs into what is behind it; not for ever

} // namespace

Client::Client(Interpreter& to, const Call& call) : in(to), by(call), outer_(tCurrent) { tCurrent = this; }
Client::~Client() { tCurrent = outer_; }
Client* Client::current() { return tCurrent; }

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

RtPointer newHandle(Client& c, std::string& name) {
    RtPointer handle = reinterpret_cast<RtPointer>(uintptr_t(c.in.nextHandle()));
    name = handleName(handle);
    return handle;
}

std::string handleName(RtPointer handle) { return fmt::format("library:{}", reinterpret_cast<uintptr_t>(handle)); }

Building::Building(const char* request) : client_(Client::current()) {
    if (client_ && client_->in.stopped()) client_ = nullptr;
    if (client_) request_ = findRequest(request);
    if (!request_) client_ = nullptr;
}

void Building::drop(const std::string& why) {
    if (!client_) return;
    client_->in.reporter.error(Rie::Consistency, client_->by.place,
                               fmt::format("Ri{}, called by a library: {}", request_->name, why));
    client_ = nullptr;
}

bool Building::may(int64_t n, std::initializer_list<const void*> arrays) {
    if (n < 0) drop("a count is negative");
    else if (n > 0 && std::find(arrays.begin(), arrays.end(), nullptr) != arrays.end()) drop("an argument is a null pointer");
    return client_ != nullptr;
}

Value& Building::add(Value::Kind kind, bool array) {
    Value& v = values_.emplace_back();
    v.kind = kind;
    v.array = array;
    v.line = client_->by.place.line;
    v.column = client_->by.place.column;
    return v;
}

Building& Building::number(double d) {
    if (client_) add(Value::Kind::Numbers, false).numbers = {d};
    return *this;
}

Building& Building::numbers(const RtFloat* f, int64_t n) {
    if (may(n, {f})) add(n ? Value::Kind::Numbers : Value::Kind::Empty, true).numbers.assign(f, f + n);
    return *this;
}

Building& Building::ints(const RtInt* i, int64_t n) {
    if (may(n, {i})) add(n ? Value::Kind::Numbers : Value::Kind::Empty, true).numbers.assign(i, i + n);
    return *this;
}

Building& Building::text(const char* s) {
    if (may(1, {s})) add(Value::Kind::Strings, false).strings = {s};
    return *this;
}

Building& Building::texts(const RtToken* s, int64_t n) {
    if (!may(n, {s})) return *this;
    for (int64_t i = 0; i < n; ++i)
        if (!may(1, {s[i]})) return *this;
    add(n ? Value::Kind::Strings : Value::Kind::Empty, true).strings.assign(s, s + n);
    return *this;
}

void Building::parameter(const char* token, const void* values, const scene::VariableCounts& counts,
                         const std::string& category) {
    const Interpreter& in = client_->in;
    const Resolved r = in.declarations.resolve(token, category);
    if (!r.declaration) {
        client_->in.reporter.error(Rie::BadToken, client_->by.place,
                                   fmt::format("Ri{}, called by a library: \"{}\" is not declared and left out", request_->name,
                                               std::string(token).substr(0, 80)),
                                   "RiDeclare, or the declaration in the token: \"varying float name\"");
        return;
    }
    const Declaration& d = *r.declaration;
    int64_t n = counts.of(d.cls) * std::max(1, d.arrayLength);
    if (d.type == scene::Type::Color && !in.nRGB.empty()) n *= int64_t(in.nRGB.size() / 3);
    else n *= scene::componentCount(d.type);
    text(token);
    if (!may(n, {values})) return;
    if (d.type == scene::Type::String) texts(static_cast<const RtToken*>(values), n);
    else if (d.type == scene::Type::Integer) ints(static_cast<const RtInt*>(values), n);
    else numbers(static_cast<const RtFloat*>(values), n);
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
    if (!scene::variableCounts(p, &counts, &why)) drop(why);
    return counts;
}

void Building::run() {
    if (!client_) return;
    Interpreter& in = client_->in;
    try {
        Call call;
        call.place = client_->by.place;
        call.request = request_;
        if (matchArguments(values_, call, in.reporter)) in.execute(call);
    } catch (const std::bad_alloc&) { // not through the frames of the library
        in.reporter.error(Rie::NoMem, client_->by.place,
                          fmt::format("Ri{}, called by a library: there is no memory for it", request_->name));
    }
}

} // namespace alpenglow::ri

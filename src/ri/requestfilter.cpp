#include "ri/requestfilter.h"
#include "ri/requests/request.h"
#include "ri/writer.h"
#include <algorithm>

namespace alpenglow::ri {

namespace {

constexpr size_t kShown = 16; // numbers or strings of an array that patterns see

template <class T> std::vector<T> firstOf(const std::vector<T>& v) {
    return {v.begin(), v.begin() + long(std::min(v.size(), kShown))};
}

class Collected : public RequestReceiver {
public:
    void request(const Call& c) override { calls.push_back(c); }
    void unknown(const std::string&, const std::vector<Value>&) override {}
    void comment(const std::string&, const std::string&) override {}
    std::vector<Call> calls;
};

} // namespace

std::string headOf(const Call& call) {
    Call head;
    head.request = call.request;
    for (const Argument& a : call.arguments) head.arguments.push_back({a.given, firstOf(a.numbers), firstOf(a.strings)});
    for (const RawParam& p : call.params) {
        Value shown{p.value.kind, p.value.array, 0, 0, firstOf(p.value.numbers), firstOf(p.value.strings)};
        head.params.push_back({p.token, std::move(shown), 0, 0});
    }
    std::string line;
    RibWriter w(stringSink(line), {.indentation = 0, .columns = 0});
    w.write(head);
    w.finish();
    line.pop_back(); // its newline
    return line;
}

std::optional<RequestPattern> RequestPattern::make(const std::string& text, std::string& error) {
    RequestPattern p;
    p.pattern_ = Pattern::make("^(" + text + ")( |$)", error);
    if (!p.pattern_) return {};
    return p;
}

void RequestFilter::begin() {
    if (begun_) return;
    begun_ = true;
    for (const Call& c : rules_.before) to_.request(c);
}

bool RequestFilter::wanted(const std::string& line) const {
    const auto fits = [&](const RequestPattern& p) { return p.matches(line); };
    if (std::any_of(rules_.drop.begin(), rules_.drop.end(), fits)) return false;
    return rules_.only.empty() || std::any_of(rules_.only.begin(), rules_.only.end(), fits);
}

bool RequestFilter::elsewhere(const Call& call) {
    static const Request* const begins = findRequest("FrameBegin");
    static const Request* const ends = findRequest("FrameEnd");
    if (call.request == begins) {
        const int number = call.integer(0);
        if (skipped_ == 0) frames_.insert(number);
        const bool left =
            !rules_.frames.empty() && std::find(rules_.frames.begin(), rules_.frames.end(), number) == rules_.frames.end();
        if (skipped_ > 0 || left) ++skipped_;
    } else if (call.request == ends && skipped_ > 0) {
        --skipped_;
        return true;
    }
    return skipped_ > 0;
}

void RequestFilter::request(const Call& call) {
    if (!begun_ && call.request->name != "version") begin();
    if (elsewhere(call)) return;
    if (rules_.drop.empty() && rules_.only.empty() && rules_.replacements.empty()) return to_.request(call);
    const std::string line = headOf(call);
    for (const FilterRules::Replacement& r : rules_.replacements)
        if (r.of.matches(line)) {
            for (const Call& c : r.by) to_.request(c);
            return;
        }
    if (wanted(line)) to_.request(call);
}

void RequestFilter::unknown(const std::string& name, const std::vector<Value>& values) {
    begin();
    if (skipped_ == 0 && wanted(name)) to_.unknown(name, values);
}

void RequestFilter::comment(const std::string& kind, const std::string& text) {
    if (skipped_ == 0 && rules_.only.empty()) to_.comment(kind, text);
}

std::vector<Call> requestsOf(const std::string& text, const std::string& name, Diagnostics& reported) {
    Collected c;
    passOnText(text, name, c, reported);
    return std::move(c.calls);
}

} // namespace alpenglow::ri

#include "ri/requeststats.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace alpenglow::ri {

namespace {

constexpr size_t kNames = 100'000; // that are kept of hostile files

constexpr uint64_t kCode = 2, kNumber = 4; // bytes in binary

void hold(RequestStats::Count& c, const std::vector<double>& numbers, const std::vector<std::string>& strings) {
    c.numbers += numbers.size();
    c.bytes += kNumber * numbers.size();
    for (const std::string& s : strings) c.bytes += s.size() + 1;
}

void keep(std::set<std::string>& names, const std::string& name) {
    if (!name.empty() && names.size() < kNames) names.insert(name);
}

std::string listed(const char* what, const std::set<std::string>& names) {
    if (names.empty()) return "";
    std::string line = fmt::format("{} ({}):", what, names.size());
    for (const std::string& n : names) line += " " + n;
    return line + "\n";
}

} // namespace

void RequestStats::add(const Call& call) {
    const Request& r = *call.request;
    Count one{1, 0, kCode};
    for (const Argument& a : call.arguments) hold(one, a.numbers, a.strings);
    for (const RawParam& p : call.params) {
        one.bytes += p.token.size() + 1;
        hold(one, p.value.numbers, p.value.strings);
    }
    const auto count = [&](Count& c) {
        c.times += one.times;
        c.numbers += one.numbers;
        c.bytes += one.bytes;
    };
    count(requests[std::string(r.name)]);
    count(all);
    if (r.kind == Kind::Primitive) count(primitives);
    if (r.kind == Kind::Light && !r.args.empty() && r.args[0].form == ArgSpec::Form::String && r.name != "EnableLightFilter")
        count(lights);
    if ((r.kind == Kind::Shader || r.kind == Kind::Light) && call.given(0) && !call.arguments[0].strings.empty())
        keep(shaders, call.text(0));
    if (r.name == "ReadArchive") keep(archives, call.text(0));
    if (r.name == "Procedural" && call.text(0) == "DelayedReadArchive" && !call.strings(1).empty())
        keep(archives, call.strings(1)[0]);
    frames += r.name == "FrameBegin";
    worlds += r.name == "WorldBegin";
    if (r.name.ends_with("Begin")) depth = std::max(depth, ++open_);
    if (r.name.ends_with("End")) open_ = std::max(0, open_ - 1);
}

void RequestStats::addUnknown(const std::string& name, const std::vector<Value>& values) {
    if (requests.size() >= kNames && !requests.count(name)) return;
    for (Count* c : {&requests[name], &all}) {
        ++c->times;
        c->bytes += kCode;
        for (const Value& v : values) hold(*c, v.numbers, v.strings);
    }
}

std::string statsText(const RequestStats& s) {
    const auto line = [](const std::string& name, const RequestStats::Count& c) {
        return fmt::format("{:<28}{:>12}{:>14}{:>14}\n", name, c.times, c.numbers, c.bytes);
    };
    std::vector<std::pair<std::string, RequestStats::Count>> sorted(s.requests.begin(), s.requests.end());
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second.times > b.second.times; });
    std::string text = fmt::format("{:<28}{:>12}{:>14}{:>14}\n", "request", "times", "numbers", "bytes");
    for (const auto& [name, c] : sorted) text += line(name, c);
    text += line("all requests", s.all) + line("primitives", s.primitives) + line("lights", s.lights);
    text += fmt::format("frames: {}, worlds: {}, deepest block: {}\n", s.frames, s.worlds, s.depth);
    return text + listed("shaders", s.shaders) + listed("archives", s.archives);
}

} // namespace alpenglow::ri

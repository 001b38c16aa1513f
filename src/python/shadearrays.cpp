#include "python/shadearrays.h"
#include "rsl/front/protocol.h"
#include "rsl/kernelrunner.h"
#include "rsl/printlog.h"
#include "rsl/services_basic.h"
#include "rsl/spilledarrays.h"
#include "services/withoutscene.h"
#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace alpenglow::python {
namespace {

constexpr int kBatch = 4096;

/// A predefined variable where nothing is given: its value and how that changes along u and v.
struct Standard {
    const char* name;
    float value[3], du[3], dv[3];
};
constexpr Standard kStandard[] = {
    {"u", {0.5f}, {1}, {0}},
    {"v", {0.5f}, {0}, {1}},
    {"s", {0.5f}, {1}, {0}},
    {"t", {0.5f}, {0}, {1}},
    {"du", {1}, {}, {}},
    {"dv", {1}, {}, {}},
    {"time", {0}, {}, {}},
    {"dtime", {0}, {}, {}},
    {"ncomps", {3}, {}, {}},
    {"alpha", {1}, {}, {}},
    {"P", {}, {1}, {0, 1}},
    {"dPdu", {1}, {}, {}},
    {"dPdv", {0, 1}, {}, {}},
    {"dPdtime", {}, {}, {}},
    {"N", {0, 0, 1}, {}, {}},
    {"Ng", {0, 0, 1}, {}, {}},
    {rsl::kSideNormal, {0, 0, 1}},
    {"I", {0, 0, 0}, {1}, {0, 1}},
    {"E", {0.5f, 0.5f, 1}, {}, {}},
    {"Cs", {1, 1, 1}, {}, {}},
    {"Os", {1, 1, 1}, {}, {}},
    {"Ci", {}, {}, {}},
    {"Oi", {1, 1, 1}, {}, {}},
};

const Standard* standardOf(const std::string& name) {
    for (const Standard& s : kStandard)
        if (name == s.name) return &s;
    return nullptr;
}

class Job {
public:
    Job(const rsl::CompiledKernel& k, const std::vector<rsl::ParameterValue>& values, const ShadeRequest& r, Diagnostics& d)
        : kernel_(k), values_(values), request_(r), diagnostics_(d), services_(r.searchPaths, d), runner_(k, kBatch) {
        for (const auto& o : k.outputs()) results_.push_back({o.name, rsl::ir::components(o.kind), {}});
    }

    std::vector<ShadeOutput> run() {
        for (first_ = 0; first_ < request_.points; first_ += kBatch) {
            count_ = std::min(size_t(kBatch), request_.points - first_);
            fill();
            runner_.run(count_, [this](int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
                serve(site, first, mask, lanes, in, out);
            });
            prints_.flush();
            spilled_.clear();
            take();
        }
        std::erase_if(results_, [](const ShadeOutput& o) { return o.width == 0; });
        return std::move(results_);
    }

private:
    void serve(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
        if (services_.answer(kernel_, site, first, mask, lanes, in, out)) return;
        const rsl::ir::Site& s = kernel_.sites()[size_t(site)];
        if (spilled_.answer(s, first, mask, lanes, in, out, diagnostics_, &kernel_.files())) return;
        rsl::basicService(
            s, mask, lanes, in, out, diagnostics_,
            [&](int lane, const std::string& text) {
                rsl::PrintKey key;
                key.sample = int64_t(first_) + first + lane;
                prints_.add(key, text);
            },
            &kernel_.files());
        if (s.op.ends_with("transform") && s.op != "ctransform") { // every space is "current": names come first, then the value
            int row = 0;
            for (const rsl::ir::Kind k : s.argKinds) row += k == rsl::ir::Kind::String;
            std::copy_n(in + row * lanes, rsl::ir::components(s.resultKinds[0]) * lanes, out);
        }
    }

    /// What was given for a variable, or for the one that it follows.
    const PointRows* given(const std::string& name) const {
        if (const auto i = request_.variables.find(name); i != request_.variables.end()) return &i->second;
        if (name == "s") return given("u");
        if (name == "t") return given("v");
        return name == "Ng" || name == rsl::kSideNormal ? given("N") : nullptr;
    }

    static float at(const PointRows& r, size_t point, int c) {
        if (r.width == 1) c = 0; // one number for a colour is grey
        const size_t i = (r.each ? point * size_t(r.width) : 0) + size_t(c);
        return c < r.width && i < r.numbers.size() ? r.numbers[i] : 0;
    }

    float variable(const std::string& name, size_t point, int c, int part) const {
        if (c > 2) return 0;
        if (part == 0) {
            if (const PointRows* r = given(name)) return at(*r, point, c);
            if (name == "P" && c < 2) return variable(c == 0 ? "u" : "v", point, 0, 0);
            if (name == "I") return variable("P", point, c, 0) - variable("E", point, c, 0);
        } else if (name == "P" || name == "I") {
            if (part == 1) return variable("dPdu", point, c, 0);
            return part == 2 ? variable("dPdv", point, c, 0) : 0;
        }
        const Standard* s = standardOf(name);
        return !s ? 0 : part == 0 ? s->value[c] : part == 1 ? s->du[c] : part == 2 ? s->dv[c] : 0;
    }

    /// Whether a part of a variable differs from point to point.
    bool varies(const std::string& name, int part) const {
        if (part > 0) return (name == "P" || name == "I") && part < 3 && varies(part == 1 ? "dPdu" : "dPdv", 0);
        if (const PointRows* r = given(name)) return r->each;
        if (name == "P") return varies("u", 0) || varies("v", 0);
        return name == "I" && (varies("P", 0) || varies("E", 0));
    }

    float parameter(const std::string& name, const rsl::ParameterValue* v, size_t point, int component, int element,
                    int components, int part) const {
        if (part > 0) return 0;
        const auto r = request_.parameters.find(name);
        if (r != request_.parameters.end() && r->second.each) return at(r->second, point, component);
        const size_t number = size_t(element * components + component);
        return v && number < v->numbers.size() ? v->numbers[number] : 0;
    }

    void fill() {
        std::vector<Vec3> points;
        for (size_t p = 0; p < count_; ++p)
            points.push_back({variable("P", first_ + p, 0, 0), variable("P", first_ + p, 1, 0), variable("P", first_ + p, 2, 0)});
        services_.setPoints({variable("E", first_, 0, 0), variable("E", first_, 1, 0), variable("E", first_, 2, 0)}, points);
        for (size_t k = 0; k < kernel_.inputs().size(); ++k) fill(kernel_.inputs()[k], runner_.input(k));
    }

    void fill(const rsl::ir::Input& i, float* rows) const {
        const int parts = rsl::inputParts(i), n = rsl::ir::components(i.kind);
        const rsl::InputName name = rsl::InputName::parse(i.name);
        const bool isParameter = name.kind == rsl::InputName::Kind::Parameter;
        const rsl::ParameterValue* value = nullptr;
        for (const rsl::ParameterValue& v : values_)
            if (isParameter && v.name == name.name) value = &v;
        for (int e = 0; e < std::max(1, i.array); ++e)
            for (int c = 0; c < n; ++c)
                for (int part = 0; part < parts; ++part) {
                    const size_t row = size_t(e * n + c) * size_t(parts) + size_t(part);
                    const auto number = [&](size_t p) {
                        if (i.kind == rsl::ir::Kind::Matrix && !isParameter) return c % 5 == 0 ? 1.f : 0.f; // "current"
                        return isParameter ? parameter(name.name, value, p, c, e, n, part) : variable(i.name, p, c, part);
                    };
                    if (i.uniform) {
                        rows[row] = number(first_);
                        continue;
                    }
                    float* r = rows + row * kBatch;
                    const PointRows* own = isParameter || part > 0 ? nullptr : given(i.name);
                    if (own && own->each)
                        for (size_t p = 0; p < count_; ++p) r[p] = at(*own, first_ + p, c);
                    else if (!isParameter && !varies(i.name, part)) std::fill_n(r, count_, number(first_));
                    else
                        for (size_t p = 0; p < count_; ++p) r[p] = number(first_ + p);
                }
    }

    void take() {
        for (size_t o = 0; o < results_.size(); ++o) {
            ShadeOutput& r = results_[o];
            if (kernel_.outputs()[o].kind == rsl::ir::Kind::String) r.width = 0;
            for (size_t p = 0; p < count_; ++p)
                for (int c = 0; c < r.width; ++c) r.numbers.push_back(runner_.output(o, c)[p]);
        }
    }

    const rsl::CompiledKernel& kernel_;
    const std::vector<rsl::ParameterValue>& values_;
    const ShadeRequest& request_;
    Diagnostics& diagnostics_;
    services::WithoutScene services_;
    rsl::KernelRunner runner_;
    rsl::PrintLog prints_;
    rsl::SpilledArrays spilled_;
    std::vector<ShadeOutput> results_;
    size_t first_ = 0, count_ = 0;
};

void refuse(Diagnostics& d, const rsl::CompiledShader& s, const std::string& what, const std::string& hint = {}) {
    d.report(Severity::Error, Rie::BadToken, {s.path()}, what, hint);
}

/// The parameters that are one value for all points. Nothing: reported.
std::optional<std::vector<rsl::ParameterValue>> constants(const rsl::CompiledShader& shader,
                                                          const std::vector<rsl::ParameterValue>& values, const ShadeRequest& r,
                                                          std::vector<std::string>& varying, Diagnostics& d) {
    std::vector<rsl::ParameterValue> given;
    std::vector<std::string> names;
    for (const auto& v : values) names.push_back(v.name);
    const auto find = [&](const std::string& name) {
        const auto i = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.name == name; });
        if (i == values.end()) {
            const std::string near = nearestName(name, names);
            refuse(d, shader, "it has no parameter \"" + name + "\"", near.empty() ? "" : "did you mean " + near + "?");
        }
        return i == values.end() ? nullptr : &*i;
    };
    for (const auto& [name, text] : r.strings) {
        const rsl::ParameterValue* v = find(name);
        if (!v) return {};
        if (v->type.base != shadeops::Base::String)
            return refuse(d, shader, "parameter \"" + name + "\" takes numbers, not a string"), std::nullopt;
        given.push_back(*v);
        given.back().strings = {text};
    }
    for (const auto& [name, rows] : r.parameters) {
        const rsl::ParameterValue* v = find(name);
        if (!v) return {};
        const size_t want = v->numbers.size();
        if (v->type.base == shadeops::Base::String || (size_t(rows.width) != want && !(rows.width == 1 && want == 3)))
            return refuse(d, shader, fmt::format("parameter \"{}\" takes {} numbers, not {}", name, want, rows.width)),
                   std::nullopt;
        if (rows.each) {
            varying.push_back(name);
            continue;
        }
        given.push_back(*v);
        given.back().numbers = rows.numbers;
        if (rows.width == 1) given.back().numbers.assign(want, rows.numbers[0]);
    }
    return given;
}

} // namespace

std::vector<ShadeOutput> shadeArrays(rsl::ShaderCompiler& compiler, std::shared_ptr<const rsl::CompiledShader> shader,
                                     const ShadeRequest& r, Diagnostics& d) {
    for (const auto& [name, rows] : r.variables)
        if (!standardOf(name))
            return refuse(d, *shader, "there is no predefined variable \"" + name + "\""), std::vector<ShadeOutput>{};
    auto values = compiler.parameterValues(shader, d);
    rsl::KernelOptions options;
    options.lanes = r.lanes;
    options.outputs = r.outputs;
    const auto given = constants(*shader, values, r, options.varyingParameters, d);
    if (!given) return {};
    if (!given->empty()) values = compiler.parameterValues(shader, d, {}, *given); // defaults may read what is given
    std::set<std::string> names(options.varyingParameters.begin(), options.varyingParameters.end());
    for (const auto& v : *given) names.insert(v.name);
    options.computedParameters = shader->computedParameters(names, options.varyingParameters);
    for (const auto& v : values)
        if (v.type.base == shadeops::Base::String && v.type.array == 0 && !v.strings.empty())
            options.stringParameters.emplace_back(v.name, v.strings[0]);
    const auto kernel = compiler.kernel(shader, options, d);
    if (!kernel) return {};
    if (kernel->facts().suspends) {
        d.report(Severity::Error, Rie::IllState, {shader->path()}, "it waits for rays, and there is no scene here");
        return {};
    }
    if (kernel->outputs().empty())
        return refuse(d, *shader, "it writes nothing that could be given back"), std::vector<ShadeOutput>{};
    return Job(*kernel, values, r, d).run();
}

} // namespace alpenglow::python

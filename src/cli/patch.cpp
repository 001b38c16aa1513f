#include "cli/patch.h"
#include "cli/command.h"
#include "rsl/front/protocol.h"
#include "rsl/services_basic.h"
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>

namespace alpenglow::cli {
namespace {

constexpr int kPatchBatch = 4096; ///< points

/// Value, d/du and d/dv of a predefined variable at a point of the patch; see the footer of the help. False: not known.
bool predefined(const std::string& name, float u, float v, float du, float dv, int c, int part, float* out) {
    struct Row {
        const char* name;
        float value[3], du[3], dv[3];
    };
    const Row rows[] = {{"u", {u}, {1}, {0}},
                        {"v", {v}, {0}, {1}},
                        {"s", {u}, {1}, {0}},
                        {"t", {v}, {0}, {1}},
                        {"du", {du}, {}, {}},
                        {"dv", {dv}, {}, {}},
                        {"time", {0}, {}, {}},
                        {"dtime", {0}, {}, {}},
                        {"ncomps", {3}, {}, {}},
                        {"alpha", {1}, {}, {}},
                        {"P", {u, v, 0}, {1, 0, 0}, {0, 1, 0}},
                        {"dPdu", {1, 0, 0}, {}, {}},
                        {"dPdv", {0, 1, 0}, {}, {}},
                        {"dPdtime", {}, {}, {}},
                        {"N", {0, 0, 1}, {}, {}},
                        {"Ng", {0, 0, 1}, {}, {}},
                        {"I", {u - 0.5f, v - 0.5f, -1}, {1, 0, 0}, {0, 1, 0}},
                        {"E", {0.5f, 0.5f, 1}, {}, {}},
                        {"Cs", {1, 1, 1}, {}, {}},
                        {"Os", {1, 1, 1}, {}, {}},
                        {"Ci", {}, {}, {}},
                        {"Oi", {1, 1, 1}, {}, {}}};
    for (const Row& r : rows)
        if (name == r.name) {
            *out = c > 2 ? 0 : part == 0 ? r.value[c] : part == 1 ? r.du[c] : part == 2 ? r.dv[c] : 0;
            return true;
        }
    *out = 0;
    return false;
}

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// One number of an input that is the same at all points; nothing for predefined variables.
std::optional<float> constantOf(const rsl::ir::Input& i, const rsl::ParameterValue* value, size_t number, int component,
                                int part) {
    if (value) return part == 0 && number < value->numbers.size() ? value->numbers[number] : 0;
    if (i.kind == rsl::ir::Kind::Matrix) return component % 5 == 0 ? 1.f : 0.f; // every space is "current"
    return {};
}

} // namespace

Patch::Patch(const rsl::CompiledKernel& kernel, std::vector<rsl::ParameterValue> values,
             const std::vector<std::string>& texturePaths, int width, int height, Diagnostics& diagnostics)
    : kernel_(kernel), values_(std::move(values)), width_(width), height_(height), diagnostics_(diagnostics),
      services_(texturePaths, diagnostics), runner_(kernel, kPatchBatch), stop_(watchInterrupts()) {}

void Patch::answer(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
    if (services_.answer(kernel_, site, first, mask, lanes, in, out)) return;
    const auto& called = kernel_.sites()[size_t(site)];
    if (spilled_.answer(called, first, mask, lanes, in, out, diagnostics_, &kernel_.files())) return;
    rsl::basicService(
        called, mask, lanes, in, out, diagnostics_,
        [&](int lane, const std::string& text) {
            if (!print_) return;
            rsl::PrintKey key;
            key.sample = int64_t(begun_) + first + lane;
            prints_.add(key, text);
        },
        &kernel_.files());
}

void Patch::run(size_t points) {
    runner_.run(
        points,
        [this](int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
            answer(site, first, mask, lanes, in, out);
        },
        stop_);
}

void Patch::fillInput(const rsl::ir::Input& i, float* rows, const std::vector<Vec2>& at) const {
    const float du = 1.f / float(width_), dv = 1.f / float(height_);
    const int parts = rsl::inputParts(i), n = rsl::ir::components(i.kind);
    const rsl::InputName name = rsl::InputName::parse(i.name);
    const auto given = std::find_if(values_.begin(), values_.end(),
                                    [&](const rsl::ParameterValue& v) { return name == rsl::InputName::parameter(v.name); });
    const rsl::ParameterValue* value = given != values_.end() ? &*given : nullptr;
    for (int e = 0; e < std::max(1, i.array); ++e)
        for (int c = 0; c < n; ++c)
            for (int part = 0; part < parts; ++part) {
                const size_t number = size_t(e * n + c), row = number * size_t(parts) + size_t(part);
                const std::optional<float> constant = constantOf(i, value, number, c, part);
                if (i.uniform) {
                    rows[row] = constant.value_or(0);
                    if (!constant) predefined(i.name, at[0].x, at[0].y, du, dv, c, part, &rows[row]);
                    continue;
                }
                float* r = rows + row * size_t(kPatchBatch);
                for (size_t p = 0; p < at.size(); ++p) {
                    if (constant) r[p] = *constant;
                    else predefined(i.name, at[p].x, at[p].y, du, dv, c, part, &r[p]);
                }
            }
}

void Patch::fill(const std::vector<Vec2>& at) {
    std::vector<Vec3> points;
    for (const Vec2& p : at) points.push_back({p.x, p.y, 0});
    services_.setPoints({0.5f, 0.5f, 1}, points);
    for (size_t k = 0; k < kernel_.inputs().size(); ++k) fillInput(kernel_.inputs()[k], runner_.input(k), at);
}

std::vector<std::string> Patch::channels() const {
    std::vector<std::string> names;
    for (const auto& o : kernel_.outputs()) {
        const int n = rsl::ir::components(o.kind);
        if (o.kind == rsl::ir::Kind::String) continue;
        for (int c = 0; c < n; ++c)
            names.push_back(o.name == "Ci" ? std::string(1, "rgb"[c])
                            : n == 1       ? o.name
                                           : o.name + "." + (n == 3 ? std::string(1, "rgb"[c]) : std::to_string(c)));
    }
    return names;
}

/// Adds what came out of a batch to the pixels of its points.
void Patch::addBatch(display::Image& image, size_t first, size_t points, size_t samples) const {
    const size_t channels = image.channels.size();
    for (size_t p = 0; p < points; ++p) {
        float* pixel = image.data.data() + (first + p) / samples * channels;
        for (size_t o = 0; o < kernel_.outputs().size(); ++o) {
            if (kernel_.outputs()[o].kind == rsl::ir::Kind::String) continue;
            for (int c = 0; c < rsl::ir::components(kernel_.outputs()[o].kind); ++c)
                *pixel++ += runner_.output(o, c)[p] / float(samples);
        }
    }
}

display::Image Patch::picture(int side) {
    const int w = width_, h = height_;
    display::Image image = display::makeImage(w, h, channels());
    const size_t samples = size_t(side) * size_t(side), total = size_t(w) * size_t(h) * samples;
    const auto place = [&](size_t i) {
        size_t pixel = i / samples, s = i % samples;
        double x = double(pixel % size_t(w)) + (double(s % size_t(side)) + 0.5) / side,
               y = double(pixel / size_t(w)) + (double(s / size_t(side)) + 0.5) / side;
        return Vec2{float(x / w), float(y / h)};
    };
    for (size_t first = 0; first < total && !*stop_; first += size_t(kPatchBatch)) {
        std::vector<Vec2> at;
        for (size_t i = first; i < std::min(total, first + size_t(kPatchBatch)); ++i) at.push_back(place(i));
        fill(at);
        begun_ = first;
        run(at.size());
        prints_.flush();
        spilled_.clear();
        addBatch(image, first, at.size(), samples);
    }
    return image;
}

void Patch::printTimes(int iterations) {
    print_ = false;
    std::vector<Vec2> at; // one batch over the whole patch, again and again
    for (int i = 0; i < kPatchBatch; ++i) at.push_back({(float(i % 64) + 0.5f) / 64, (float(i / 64) + 0.5f) / 64});
    fill(at);
    double best = 1e300, all = 0;
    for (int k = 0; k < iterations && !*stop_; ++k) {
        double t = cpuSeconds();
        run(at.size());
        t = cpuSeconds() - t;
        best = std::min(best, t);
        all += t;
    }
    std::printf("%.4g ns a point (best of %d batches of %d points), mean %.4g ns, %d points a strip\n", best * 1e9 / kPatchBatch,
                iterations, kPatchBatch, all * 1e9 / kPatchBatch / iterations, kernel_.lanes());
}

} // namespace alpenglow::cli

#include "render/mattepass.h"
#include "base/limits.h"
#include "render/filterweights.h"
#include "scene/scene.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <unordered_map>

namespace alpenglow::render {
namespace {

constexpr int kBandRows = 16;               // of pixels that a task makes
constexpr const char* kUnnamed = "default"; // as other renderers call what has no name

/// The name that a surface has in a layer.
std::string nameIn(const scene::Attributes& a, const std::string& layer) {
    std::string name;
    if (layer == "material") {
        if (a.surface) name = a.surface->handle.empty() ? a.surface->name : a.surface->handle;
    } else if (const scene::Param* p = a.value(layer)) {
        if (!p->strings.empty()) name = p->strings[0];
        else if (!p->numbers.empty()) name = fmt::format("{}", p->numbers[0]);
    }
    return name.empty() ? kUnnamed : name;
}

/// "CryptoObject" and "CryptoMaterial" are what compositing programs look for first.
std::string layerName(const std::string& layer) {
    if (layer == "identifier:name" || layer == "identifier:object") return "CryptoObject";
    if (layer == "material") return "CryptoMaterial";
    std::string name = "Crypto_" + layer;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_'; // '.' would separate layer and channel
    return name;
}

/// A share of a pixel. own: of its own samples, all of one weight, for filters whose weights cancel.
struct Share {
    uint32_t id;
    double weighted, own;
};
struct PixelShares {
    double weights = 0, sizes = 0, samples = 0;
    std::vector<std::vector<Share>> of; ///< by layer
};

class MatteLoop {
public:
    MatteLoop(Job& job, const MattesAsked& asked, const PixelFilter& filter, int nx, int ny, Jitter jitter, uint64_t seed,
              std::vector<display::Matte>& out)
        : job_(job), asked_(asked), filter_(filter), bx_(border(filter.xw)), by_(border(filter.yw)), nx_(nx), ny_(ny),
          jitter_(jitter), seed_(seed), out_(out) {}
    /// Makes rows y0 to y1 of the window. `names`: gets those that cover something, by layer. False if stopped.
    bool band(int worker, int y0, int y1, std::vector<std::map<std::string, uint32_t>>& names);

private:
    /// The ids of a surface, by layer.
    using Ids = std::vector<uint32_t>;
    const Ids& idsOf(const scene::Attributes*);
    struct Seen {
        const Ids* ids;
        double share; ///< of what is behind the surfaces before it
    };
    bool row(int worker, int y);
    void see(const integrator::SampleResult&);
    void add(int x, int y, Vec2 place, const integrator::SampleResult&);
    void finish(const PixelShares&, size_t pixel);

    Job& job_;
    const MattesAsked& asked_;
    const FilterWeights filter_;
    const int bx_, by_, nx_, ny_;
    const Jitter jitter_;
    const uint64_t seed_;
    std::vector<display::Matte>& out_;
    Window part_;                                           ///< pixels of the band
    std::vector<PixelShares> pixels_;                       ///< of part_
    std::unordered_map<const scene::Attributes*, Ids> ids_; ///< only looked up, never walked through; Seen points into it
    std::vector<Seen> seen_;                                ///< by the sample that is added
    std::vector<integrator::SampleResult> results_;         ///< kept, with the memory of its lists
    std::vector<std::map<std::string, uint32_t>> names_;
};

const MatteLoop::Ids& MatteLoop::idsOf(const scene::Attributes* a) {
    const auto [at, fresh] = ids_.try_emplace(a);
    if (fresh)
        for (size_t i = 0; i < asked_.layers.size(); ++i) {
            std::string name = nameIn(*a, asked_.layers[i]);
            at->second.push_back(display::matteId(name));
            names_[i].emplace(std::move(name), at->second.back());
        }
    return at->second;
}

/// What a sample sees, in the order of its surfaces.
void MatteLoop::see(const integrator::SampleResult& sample) {
    seen_.clear();
    Color before(1);
    for (const integrator::DepthStep& s : sample.transmittance) {
        const Color hidden = before - s.transmittance;
        before = s.transmittance;
        const double share = (double(hidden.x) + double(hidden.y) + double(hidden.z)) / 3;
        if (s.surface && share > 0) seen_.push_back({&idsOf(s.surface), share});
    }
}

void MatteLoop::add(int x, int y, Vec2 place, const integrator::SampleResult& sample) {
    see(sample);
    for (int py = std::max(part_.y0, y - by_); py <= std::min(part_.y1 - 1, y + by_); ++py)
        for (int px = std::max(part_.x0, x - bx_); px <= std::min(part_.x1 - 1, x + bx_); ++px) {
            const double w = double(filter_(double(x - px) + double(place.x) - 0.5, double(y - py) + double(place.y) - 0.5));
            const double own = px == x && py == y;
            if (w == 0 && own == 0) continue;
            PixelShares& to = pixels_[size_t(py - part_.y0) * size_t(part_.width()) + size_t(px - part_.x0)];
            to.weights += w;
            to.sizes += std::fabs(w);
            to.samples += own;
            for (const Seen& s : seen_)
                for (size_t i = 0; i < s.ids->size(); ++i) {
                    std::vector<Share>& list = to.of[i];
                    const uint32_t id = (*s.ids)[i];
                    auto at = std::find_if(list.begin(), list.end(), [&](const Share& k) { return k.id == id; });
                    if (at == list.end()) at = list.insert(list.end(), {id, 0, 0});
                    at->weighted += w * s.share;
                    at->own += own * s.share;
                }
        }
}

bool MatteLoop::row(int worker, int y) {
    constexpr int64_t kSlice = 2048; // rays in a call
    const int samples = nx_ * ny_, x0 = part_.x0 - bx_;
    const int64_t all = int64_t(samples) * (part_.width() + 2 * bx_);
    ImageRays image(job_.camera, seed_, nx_, ny_, jitter_);
    for (int64_t begun = 0; begun < all; begun += kSlice) {
        image.clear();
        const int64_t end = std::min(all, begun + kSlice);
        for (int64_t i = begun; i < end; ++i) image.ask(x0 + int(i / samples), y, int(i % samples));
        image.make();
        for (integrator::CameraRay& r : image.rays()) r.depths = true;
        if (results_.size() < image.rays().size()) results_.resize(image.rays().size());
        const std::span<integrator::SampleResult> results(results_.data(), image.rays().size());
        if (!job_.trace(worker, image.rays(), results)) return false;
        for (int64_t i = begun; i < end; ++i)
            add(x0 + int(i / samples), y, image.places()[size_t(i - begun)], results[size_t(i - begun)]);
    }
    return true;
}

void MatteLoop::finish(const PixelShares& p, size_t pixel) {
    const bool cancels = !(p.weights > 1e-6 * p.sizes); // as in the picture (reconstruct.cpp)
    const double sum = cancels ? p.samples : p.weights;
    for (size_t i = 0; i < out_.size(); ++i) {
        std::vector<std::pair<double, uint32_t>> ranked;
        for (const Share& s : p.of[i])
            if (const double c = sum > 0 ? (cancels ? s.own : s.weighted) / sum : 0; c > 0) ranked.push_back({c, s.id});
        std::sort(ranked.begin(), ranked.end(),
                  [](const auto& a, const auto& b) { return a.first > b.first || (a.first == b.first && a.second < b.second); });
        display::Matte& m = out_[i];
        float* to = m.pairs.data() + pixel * size_t(2 * m.ranks);
        std::fill_n(to, 2 * m.ranks, 0.f);
        for (size_t k = 0; k < std::min(ranked.size(), size_t(m.ranks)); ++k, to += 2) {
            to[0] = std::bit_cast<float>(ranked[k].second);
            to[1] = float(std::min(ranked[k].first, 1.0)); // negative lobes of other samples may raise it
        }
    }
}

bool MatteLoop::band(int worker, int y0, int y1, std::vector<std::map<std::string, uint32_t>>& names) {
    const Window& w = job_.camera.window();
    part_ = {w.x0, y0, w.x1, y1};
    names_.assign(asked_.layers.size(), {});
    PixelShares none;
    none.of.resize(asked_.layers.size());
    pixels_.assign(part_.pixels(), none);
    for (int y = y0 - by_; y < y1 + by_; ++y)
        if (!row(worker, y)) return false;
    for (size_t i = 0; i < pixels_.size(); ++i) finish(pixels_[i], size_t(y0 - w.y0) * size_t(w.width()) + i);
    names = std::move(names_);
    return true;
}

} // namespace

MattesAsked mattesAsked(const scene::ParamList& params, size_t channels, const SourcePlace& place, Diagnostics& d) {
    MattesAsked asked;
    const auto wrong = [&](const std::string& why) { d.report(Severity::Error, Rie::Range, place, "Cryptomatte: " + why); };
    if (const scene::Param* p = scene::find(params, "layer"))
        for (const std::string& l : p->strings) {
            const bool known = l == "material" || l.find(':') != std::string::npos;
            if (!known) wrong("layer \"" + l + "\" is neither \"material\" nor an attribute \"class:name\"; it is left out");
            else if (std::find(asked.layers.begin(), asked.layers.end(), l) == asked.layers.end()) asked.layers.push_back(l);
        }
    if (asked.layers.size() > limits::kMatteLayers) {
        wrong(fmt::format("there are more than {} layers; the others are left out", limits::kMatteLayers));
        asked.layers.resize(limits::kMatteLayers);
    }
    if (asked.layers.empty()) asked.layers = {"identifier:name"};
    if (const scene::Param* p = scene::find(params, "levels"); p && !p->numbers.empty()) {
        if (p->numbers[0] >= 1 && p->numbers[0] <= limits::kMatteRanks) asked.ranks = 2 * ((int(p->numbers[0]) + 1) / 2);
        else wrong(fmt::format("\"levels\" must be in 1 to {}; {} is used", limits::kMatteRanks, asked.ranks));
    }
    // Each level has two channels: an id and its coverage.
    const size_t room = limits::kImageChannels - std::min(channels, size_t(limits::kImageChannels)), layers = asked.layers.size();
    if (2 * size_t(asked.ranks) * layers > room) {
        const int fit = std::max(2, int(room / (2 * layers)) / 2 * 2);
        d.report(
            Severity::Error, Rie::Limit, place,
            fmt::format("Cryptomatte: {} channels of the picture and {} layers of {} levels are more than {} channels; {} levels "
                        "are written",
                        channels, layers, asked.ranks, limits::kImageChannels, fit),
            "a display of its own for some of the layers, or fewer \"levels\"");
        asked.ranks = fit;
    }
    return asked;
}

display::MattesRef seeMattes(Job& job, const MattesAsked& asked, const PixelFilter& filter, int nx, int ny, Jitter jitter,
                             uint64_t seed) {
    const Window& w = job.camera.window();
    auto mattes = std::make_shared<std::vector<display::Matte>>();
    for (const std::string& l : asked.layers) {
        display::Matte& m = mattes->emplace_back();
        m.layer = layerName(l);
        m.ranks = asked.ranks;
        m.pairs.assign(w.pixels() * size_t(2 * asked.ranks), 0);
    }
    const size_t bands = size_t((w.height() + kBandRows - 1) / kBandRows);
    std::vector<std::vector<std::map<std::string, uint32_t>>> names(bands);
    const bool whole = job.runShown(bands, "mattes", [&](int worker, size_t i) {
        const int y0 = w.y0 + int(i) * kBandRows;
        MatteLoop(job, asked, filter, nx, ny, jitter, seed, *mattes).band(worker, y0, std::min(w.y1, y0 + kBandRows), names[i]);
    });
    if (!whole) return {};
    for (auto& band : names)
        for (size_t i = 0; i < band.size(); ++i) (*mattes)[i].names.merge(band[i]);
    return mattes;
}

} // namespace alpenglow::render

#include "render/outputs.h"
#include "base/srgb.h"
#include "display/driver.h"
#include "display/drivers/picture.h"
#include "display/mode.h"
#include "render/curve.h"
#include "render/imaging.h"
#include "render/outputnames.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace alpenglow::render {

namespace {

using Source = OutputVariable::Source;

constexpr float kFarAway = 1e38f; // RI_INFINITY: depth where nothing was hit

const scene::Param* numbers(const scene::ParamList& list, std::string_view name, size_t count, Diagnostics& diags) {
    const scene::Param* p = scene::find(list, name);
    if (!p) return nullptr;
    if (p->numbers.size() == count) return p;
    diags.report(Severity::Error, Rie::BadToken, p->place,
                 "display parameter \"" + std::string(name) + "\" takes " + std::to_string(count) + " numbers; it is dropped");
    return nullptr;
}

DepthFilter depthFilterOf(const scene::Options& o, Diagnostics& diags) {
    const scene::Param* p = scene::find(o.hiderParams, "depthfilter");
    if (!p)
        if (auto i = o.values.find("hider:depthfilter"); i != o.values.end()) p = &i->second;
    if (!p || p->strings.empty() || p->strings[0].empty()) return DepthFilter::Min; // Blender's exporters leave it empty
    if (auto d = depthFilterByName(p->strings[0])) return *d;
    diags.report(Severity::Error, Rie::Range, p->place, "depth filter \"" + p->strings[0] + "\" is not known; \"min\" is used",
                 nearestName(p->strings[0], {"min", "max", "average", "midpoint"}));
    return DepthFilter::Min;
}

OutputSpec specOf(const scene::Display& d, const scene::Options& o, const OutputBasis& basis, OutputPlan& plan,
                  Diagnostics& diags) {
    OutputSpec s;
    s.name = d.name;
    s.type = d.type;
    s.params = d.params;
    s.place = d.place;
    s.gain = basis.gain;
    s.gamma = basis.gamma;
    s.filter = basis.filter;
    s.depth = basis.depth;
    if (auto e = numbers(d.params, "exposure", 2, diags)) {
        s.gain = e->numbers[0];
        s.gamma = e->numbers[1];
        s.ownExposure = true;
        if (!(s.gamma > 0)) {
            diags.report(Severity::Error, Rie::Range, e->place,
                         "display parameter \"exposure\": gamma must be positive; 1 is used");
            s.gamma = 1;
        }
    }
    const scene::Param* filter = scene::find(d.params, "filter");
    const scene::Param* width = numbers(d.params, "filterwidth", 2, diags);
    std::string filterName_ = filter && !filter->strings.empty() ? filter->strings[0] : "";
    auto depth = depthFilterByName(filterName_);
    if (depth) s.depth = *depth;
    if ((!filterName_.empty() && !depth) || width) {
        PixelFilter f = makePixelFilter(filterName_.empty() || depth ? filterName(basis.filter.kind) : filterName_,
                                        width ? width->numbers[0] : basis.filter.xw, width ? width->numbers[1] : basis.filter.yw,
                                        d.place, diags);
        if (!basis.path) s.filter = f;
        else if (f.kind != basis.filter.kind || f.xw != basis.filter.xw || f.yw != basis.filter.yw)
            diags.report(Severity::Warning, Rie::Incapable, d.place,
                         "display \"" + d.name +
                             "\": under \"path\" all displays have the filter of PixelFilter, from which the samples are drawn");
    }
    bool askedRgba = false, askedZ = false;
    s.rgba = display::quantizationOf(basis.rgba, d.params, diags, &askedRgba);
    s.z = display::quantizationOf(basis.z, d.params, diags, &askedZ);
    s.quantizeAsked = askedRgba || askedZ;

    for (const display::ModeVariable& v : display::parseMode(d.mode, diags, d.place, o.displayChannels)) {
        OutputVariable out;
        out.name = v.name;
        out.channels = v.channels;
        out.typed = v.declared || v.name == "Ci" || v.name == "alpha" || v.name == "z";
        out.color = v.type == scene::Type::Color;
        if (v.name == "Ci") out.source = Source::Ci;
        else if (v.name == "alpha") out.source = Source::Alpha;
        else if (v.name == "z") out.source = Source::Z;
        else if (v.name == "Oi") out.source = Source::Oi;
        else setSource(out, o, plan, d.place, diags);
        if (out.source == Source::Engine) {
            auto& names = plan.engineOutputs;
            const std::string& wanted = out.asked.empty() ? out.name : out.asked;
            auto i = std::find(names.begin(), names.end(), wanted);
            out.engine = int(i - names.begin());
            if (i == names.end()) {
                names.push_back(wanted);
                plan.engineWidths.push_back(0);
            }
            int& engineWidth = plan.engineWidths[size_t(out.engine)];
            if (v.declared) engineWidth = std::max(engineWidth, int(v.channels.size()));
        }
        s.variables.push_back(std::move(out));
    }
    return s;
}

} // namespace

bool OutputSpec::has(Source s) const {
    return std::any_of(variables.begin(), variables.end(), [&](const OutputVariable& v) { return v.source == s; });
}

std::vector<std::string> OutputSpec::channels() const {
    std::vector<std::string> all;
    for (const OutputVariable& v : variables) all.insert(all.end(), v.channels.begin(), v.channels.end());
    return all;
}

int OutputPlan::engineFloats() const {
    int n = 0;
    for (int w : engineWidths) n += w;
    return n;
}

bool OutputPlan::anyDeep() const {
    return std::any_of(pictures.begin(), pictures.end(), [](const OutputSpec& p) { return p.deep; });
}

bool OutputPlan::anyMattes() const {
    return std::any_of(pictures.begin(), pictures.end(), [](const OutputSpec& p) { return p.asksMattes.has_value(); });
}

bool OutputPlan::onlyDeep() const {
    return std::all_of(pictures.begin(), pictures.end(), [](const OutputSpec& p) { return p.deep; });
}

bool OutputPlan::needs(Source s) const {
    return std::any_of(pictures.begin(), pictures.end(), [&](const OutputSpec& p) { return p.has(s); });
}

bool OutputPlan::needsDepth(DepthFilter d) const {
    return std::any_of(pictures.begin(), pictures.end(), [&](const OutputSpec& p) { return p.has(Source::Z) && p.depth == d; });
}

void OutputPlan::resolve(std::vector<int> widths, Diagnostics& diags, const std::vector<std::string>& missing) {
    engineWidths = std::move(widths);
    engineWidths.resize(engineOutputs.size(), 1);
    for (OutputSpec& p : pictures)
        for (OutputVariable& v : p.variables) {
            if (v.source == Source::Engine && v.instead != Source::Engine &&
                std::find(missing.begin(), missing.end(), v.name) != missing.end()) {
                v.source = v.instead;
                if (!basis.path) sayNeedsPath(v.name, p.place, diags);
            }
            if (v.source != Source::Engine || int(v.channels.size()) == engineWidths[size_t(v.engine)]) continue;
            int w = engineWidths[size_t(v.engine)];
            if (v.typed)
                diags.report(Severity::Warning, Rie::Consistency, p.place,
                             "display \"" + p.name + "\": \"" + v.name + "\" has " + std::to_string(w) +
                                 " numbers in the shaders, not " + std::to_string(v.channels.size()));
            v.channels.clear();
            if (w == 1) v.channels = {v.name};
            else if (w == 3) v.channels = {v.name + ".r", v.name + ".g", v.name + ".b"};
            else
                for (int k = 0; k < w; ++k) {
                    char number[16];
                    std::snprintf(number, sizeof number, ".%03d", k);
                    v.channels.push_back(v.name + number);
                }
            v.color = w == 3;
        }
}

OutputSpec singleOutput(const std::string& file, const OutputBasis& basis, Diagnostics& diags, display::Format format) {
    using display::Format;
    if (file != "-") format = display::formatOfExtension(file).value_or(Format::Tiff);
    const bool looked = !display::written(format).floats;
    scene::Display d;
    d.name = file;
    d.type = display::written(format).displays.front();
    d.mode = looked ? "rgb" : "rgba";
    OutputPlan unused;
    OutputSpec s = specOf(d, {}, basis, unused, diags);
    s.userFile = true;
    chooseCurve(s, basis);
    return s;
}

namespace {
/// Format for "-o -": that of the first display's type, else PNG.
display::Format formatOf(const std::vector<scene::Display>& displays) {
    if (displays.empty()) return display::Format::Png;
    const scene::Display& d = displays.front();
    const std::string likeAName = d.type == "file" ? d.name : d.type == "openexr" ? ".exr" : "." + d.type;
    return display::formatOfExtension(likeAName).value_or(display::Format::Png);
}

/// A window has no file of its own: it is dropped if another display writes the file of its name.
void leaveOutWindows(std::vector<OutputSpec>& pictures) {
    auto is = [](const OutputSpec& s, const char* driver) {
        const display::DriverDescriptor* d = display::findDriver(s.type);
        return d && d->names.front() == driver;
    };
    std::vector<OutputSpec> kept;
    for (OutputSpec& s : pictures) {
        auto same = std::find_if(kept.begin(), kept.end(), [&](const OutputSpec& k) {
            return (is(k, "framebuffer") || is(s, "framebuffer")) && !is(k, "null") && !is(s, "null") &&
                   fileIdentity(k.name) == fileIdentity(s.name);
        });
        if (same == kept.end()) kept.push_back(std::move(s));
        else if (!is(s, "framebuffer")) *same = std::move(s);
    }
    pictures = std::move(kept);
}
} // namespace

OutputPlan planOutputs(const scene::Options& o, const RenderSettings& settings, bool path, const std::string& file,
                       Diagnostics& diags) {
    OutputPlan plan;
    OutputBasis& b = plan.basis;
    b.path = path;
    b.gain = std::isfinite(o.gain) ? o.gain : 1;
    b.gamma = settings.gamma ? *settings.gamma : o.gamma;
    b.gammaGiven = settings.gamma.has_value();
    b.srgbAsked = settings.srgb;
    b.exposureGiven = o.exposureSet || o.gain != 1 || o.gamma != 1;
    if (!(b.gamma > 0) || !std::isfinite(b.gamma)) {
        diags.report(Severity::Error, Rie::Range, {}, "Exposure: gamma must be positive; 1 is used");
        b.gamma = 1;
    }
    b.rgba = o.quantizeRgba;
    b.z = o.quantizeZ;
    b.filter = makePixelFilter(o.filter.name, o.filter.xwidth, o.filter.ywidth, {}, diags);
    b.depth = depthFilterOf(o, diags);
    if (!file.empty()) plan.pictures.push_back(singleOutput(file, b, diags, formatOf(o.displays)));
    for (const NamedDisplay& d : displaysOf(o, settings, file.empty())) {
        const bool deep = display::findDriver(d.display.type) == &display::deepDriver;
        scene::Display display = d.display;
        if (deep) display.mode = "z"; // "deepopacity" and the like: it holds what it holds
        OutputSpec s = specOf(display, o, b, plan, diags);
        s.deep = deep;
        if (display::findDriver(s.type) == &display::cryptomatteDriver)
            s.asksMattes = mattesAsked(s.params, s.channels().size(), s.place, diags);
        if (settings.gamma && s.ownExposure && !isMap(d.display)) s.gamma = *settings.gamma;
        s.map = isMap(d.display);
        s.userFile = d.user;
        if (!s.map) chooseCurve(s, b);
        if (!s.variables.empty()) plan.pictures.push_back(std::move(s));
    }
    leaveOutWindows(plan.pictures);
    if (path) joinLightPaths(plan, diags);
    return plan;
}

std::vector<Channel> filmChannels(const OutputPlan& plan) {
    std::vector<Channel> c;
    if (plan.needs(Source::Oi))
        for (const char* n : {"Oi.r", "Oi.g", "Oi.b"}) c.push_back({n, ChannelRule::Average});
    if (plan.needsDepth(DepthFilter::Min)) c.push_back({"z", ChannelRule::Min});
    if (plan.needsDepth(DepthFilter::Max)) c.push_back({"z.max", ChannelRule::Max});
    if (plan.needsDepth(DepthFilter::Average)) {
        c.push_back({"z.sum", ChannelRule::Average});
        c.push_back({"z.hits", ChannelRule::Average});
    }
    if (plan.needsDepth(DepthFilter::Midpoint)) c.push_back({"z.mid", ChannelRule::Min});
    for (size_t i = 0; i < plan.engineOutputs.size(); ++i)
        for (int k = 0; k < plan.engineWidths[i]; ++k)
            c.push_back({"aov." + plan.engineOutputs[i] + "." + std::to_string(k), ChannelRule::Average});
    addLightChannels(plan, c);
    return c;
}

void filmValues(const OutputPlan& plan, const integrator::SampleResult& sample, std::vector<float>* out) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const auto& [opacity, z, zSecond, aovs] = std::tie(sample.opacity, sample.z, sample.zSecond, sample.aovs);
    bool hit = z < kFarAway;
    if (plan.needs(Source::Oi)) out->insert(out->end(), {opacity.x, opacity.y, opacity.z});
    if (plan.needsDepth(DepthFilter::Min)) out->push_back(hit ? z : inf);
    if (plan.needsDepth(DepthFilter::Max)) out->push_back(hit ? z : inf);
    if (plan.needsDepth(DepthFilter::Average)) out->insert(out->end(), {hit ? z : 0, hit ? 1.f : 0.f});
    if (plan.needsDepth(DepthFilter::Midpoint)) out->push_back(hit && zSecond < kFarAway ? 0.5f * (z + zSecond) : inf);
    size_t n = size_t(plan.engineFloats());
    for (size_t i = 0; i < n; ++i) out->push_back(i < aovs.size() ? aovs[i] : 0);
    addLightValues(plan, sample, out);
}

Image filmImage(const Film& film, const OutputPlan& plan, DepthFilter depth) {
    Image image;
    image.window = film.window();
    image.channels = {"r", "g", "b", "a", "Or", "Og", "Ob", "z"};
    const std::vector<Channel>& channels = film.description().channels;
    auto find = [&](const std::string& name) {
        for (size_t i = 0; i < channels.size(); ++i)
            if (channels[i].name == name) return int(i);
        return -1;
    };
    int oi = find("Oi.r"), hits = find("z.hits");
    int z = find(depth == DepthFilter::Min       ? "z"
                 : depth == DepthFilter::Max     ? "z.max"
                 : depth == DepthFilter::Average ? "z.sum"
                                                 : "z.mid");
    std::vector<int> aovs;
    for (size_t i = 0; i < channels.size(); ++i)
        if (channels[i].name.rfind("aov.", 0) == 0) {
            aovs.push_back(int(i));
            image.channels.push_back(channels[i].name.substr(4));
        }
    const size_t lights = image.channels.size();
    for (size_t i = 0; i < lightFloats(plan); ++i) image.channels.push_back("light." + std::to_string(i));
    size_t stride = image.channels.size();
    image.data.resize(image.window.pixels() * stride);
    float* p = image.data.data();
    for (int y = image.window.y0; y < image.window.y1; ++y)
        for (int x = image.window.x0; x < image.window.x1; ++x, p += stride) {
            Color c = film.mean(x, y);
            float a = film.alpha(x, y);
            p[0] = c.x;
            p[1] = c.y;
            p[2] = c.z;
            p[3] = a;
            for (int k = 0; k < 3; ++k) p[4 + k] = oi >= 0 ? film.aov(x, y, oi + k) : a;
            p[7] = z >= 0 ? film.aov(x, y, z) : kFarAway;
            if (depth == DepthFilter::Average && z >= 0) {
                float h = film.aov(x, y, hits);
                p[7] = h > 0 ? p[7] / h : kFarAway;
            }
            for (size_t k = 0; k < aovs.size(); ++k) p[8 + k] = film.aov(x, y, aovs[k]);
            addLightPixels(plan, film, x, y, p + lights);
        }
    return image;
}

namespace {
/// Position of an engine or light path variable after the first eight floats of a pixel.
size_t floatOf(const OutputPlan& plan, const OutputVariable& v, const std::vector<int>& firstFloat) {
    if (v.source == Source::Engine) return size_t(firstFloat[size_t(v.engine)]);
    return size_t(plan.engineFloats()) + lightFloat(plan, v);
}
} // namespace

std::optional<display::Image> finishedPicture(const OutputPlan& plan, const OutputSpec& s, const PictureFacts& facts,
                                              const Image& in, const Imager& imager) {
    std::vector<int> firstFloat(plan.engineOutputs.size());
    for (size_t i = 0, n = 0; i < firstFloat.size(); n += size_t(plan.engineWidths[i++])) firstFloat[i] = int(n);
    const int w = facts.window.width(), h = facts.window.height();
    std::vector<float> rx(size_t(w), 0.f), ry(size_t(w), 0.f), row(size_t(w) * 4);
    const float zeros[16] = {}; // hidden and raytrace have no light path outputs
    display::Image out = display::makeImage(w, h, s.channels());
    size_t stride = in.channels.size();
    for (int y = 0; y < h; ++y) {
        const float* src = in.data.data() + size_t(y + facts.window.y0 - in.window.y0) * size_t(in.window.width()) * stride;
        float *r = row.data(), *g = r + w, *b = g + w, *a = b + w;
        for (int x = 0; x < w; ++x) {
            const float* p = src + size_t(x) * stride;
            r[x] = expose(p[0], s.gain, s.gamma);
            g[x] = expose(p[1], s.gain, s.gamma);
            b[x] = expose(p[2], s.gain, s.gamma);
            a[x] = p[3];
            rx[size_t(x)] = float(facts.window.x0 + x) + 0.5f;
            ry[size_t(x)] = float(facts.window.y0 + y) + 0.5f;
        }
        if (imager && !imager(w, rx.data(), ry.data(), r, g, b, a)) return {};
        if (s.srgb) // after the imager, which works on linear light
            for (int i = 0; i < 3 * w; ++i) r[i] = srgbEncode(r[i]);
        for (int x = 0; x < w; ++x) {
            const float* p = src + size_t(x) * stride;
            float* q = out.pixel(x, y);
            for (const OutputVariable& v : s.variables) {
                size_t n = v.channels.size();
                switch (v.source) {
                case Source::Ci:
                    for (size_t k = 0; k < n; ++k) *q++ = k == 0 ? r[x] : k == 1 ? g[x] : b[x];
                    break;
                case Source::Alpha:
                    *q++ = a[x];
                    break;
                case Source::Z:
                    *q++ = std::isfinite(p[7]) ? p[7] : kFarAway;
                    break;
                case Source::Oi:
                    for (size_t k = 0; k < n; ++k) *q++ = p[4 + std::min(k, size_t(2))];
                    break;
                default: {
                    const size_t at = 8 + floatOf(plan, v, firstFloat);
                    const float* e = at + n <= stride ? p + at : zeros;
                    for (size_t k = 0; k < n; ++k) {
                        const float x1 = s.ownExposure && v.color ? expose(e[k], s.gain, s.gamma) : e[k];
                        *q++ = s.srgb && v.shown() ? srgbEncode(x1) : x1;
                    }
                    break;
                }
                }
            }
        }
    }
    return out;
}

bool writeOutputs(const OutputPlan& plan, const PictureFacts& facts, const std::function<const Image&(const OutputSpec&)>& pixels,
                  const Imager& imager, bool allowWrite, Diagnostics& diags) {
    bool all = true;
    const int w = facts.window.width(), h = facts.window.height();
    for (const OutputSpec& s : plan.pictures) {
        display::DriverSetup setup;
        setup.name = s.name;
        setup.type = s.type;
        setup.width = w;
        setup.height = h;
        setup.originX = facts.window.x0;
        setup.originY = facts.window.y0;
        setup.fullWidth = facts.width;
        setup.fullHeight = facts.height;
        setup.pixelAspect = facts.pixelAspect;
        setup.channels = s.channels();
        setup.params = s.params;
        setup.rgba = s.rgba;
        setup.z = s.z;
        setup.quantizeAsked = s.quantizeAsked;
        setup.metadata = facts.metadata;
        if (s.srgb) setup.metadata["colorspace"] = "sRGB";
        setup.worldToCamera = facts.worldToCamera;
        setup.worldToNDC = facts.worldToNDC;
        setup.policy.allowWrite = allowWrite || s.userFile;
        setup.place = s.place;
        if (s.deep) setup.deep = facts.deep;
        setup.mattes = s.mattes;
        const std::optional<display::Image> out = finishedPicture(plan, s, facts, pixels(s), imager);
        if (!out) return all;
        all &= display::writeDisplay(setup, *out, diags);
    }
    return all;
}

} // namespace alpenglow::render

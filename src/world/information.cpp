#include "world/information.h"
#include "base/knownoptions.h"
#include "base/version.h"
#include "scene/scene.h"
#include "world/objectbox.h"
#include <algorithm>

namespace alpenglow::world {

namespace {

Information number(float f) { return {{f}, {}, false}; }
Information words(const std::string& s) { return {{}, {s}, true}; }

std::optional<Information> given(const scene::Param* p) {
    if (!p) return std::nullopt;
    if (!p->strings.empty()) return Information{{}, p->strings, true};
    return Information{p->numbers, {}, false};
}

Information matrixOf(const Matrix& m) {
    Information i;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) i.numbers.push_back(float(m.m[r][c]));
    return i;
}

/// Values of attributes and options that no request has set, from the table.
std::optional<Information> unset(std::span<const known::OptionDescription> table, const std::string& name, bool path) {
    const known::OptionDescription* entry = known::findKnown(table, name);
    if (!entry || entry->answer.empty()) return std::nullopt;
    known::PlainValue v = known::plainValue(path && !entry->answerUnderPath.empty() ? entry->answerUnderPath : entry->answer);
    return Information{std::move(v.numbers), v.texts, !v.texts.empty()};
}

/// Displacement bound by shaders: sizes add up; the displacement shader defines the space.
std::optional<Information> shaderBound(const SurfaceBinding& b, bool space) {
    const std::string name = space ? rsl::kBoundSpace : rsl::kBoundSize;
    float sum = 0;
    bool found = false;
    for (const InstanceRef& i : {b.displacement, b.surface}) {
        if (!i || (i == b.surface && found && b.surface == b.displacement)) continue;
        if (space) {
            if (const auto t = i->parameters.strings.find(name); t != i->parameters.strings.end()) return words(t->second);
        } else if (const auto n = i->parameters.numbers.find(name); n != i->parameters.numbers.end() && !n->second.empty()) {
            sum += n->second[0];
            found = true;
        }
    }
    if (!found) return std::nullopt;
    return number(sum);
}

std::optional<Information> coordinateSystem(const WorldImpl& w, const std::string& name) {
    const auto i = w.frame().coordinateSystems.find(name);
    if (i == w.frame().coordinateSystems.end()) return std::nullopt;
    return matrixOf(scene::at(i->second, w.shutter().open));
}

} // namespace

std::optional<Information> attributeOf(const WorldImpl& w, const scene::Attributes& a, const std::string& key,
                                       const shading::ShadePoint* p, const SurfaceBinding* b) {
    static const std::string kCoordinate = "Ri:CoordinateSystem:", kOfLight = "attribute:light:";
    const std::string name = key.rfind(kOfLight, 0) == 0 ? key.substr(std::string("attribute:").size()) : key;
    if (name == "Ri:ShadingRate" || name == "ShadingRate") return number(a.shadingRate);
    if (name == "Ri:Sides" || name == "Sides") return number(float(a.sides));
    if (name == "Ri:Matte" || name == "Matte") return number(float(a.matte));
    if (name == "Ri:Color" || name == "Color") return Information{{a.color.x, a.color.y, a.color.z}, {}, false};
    if (name == "Ri:Opacity" || name == "Opacity") return Information{{a.opacity.x, a.opacity.y, a.opacity.z}, {}, false};
    if (name == "Ri:Orientation") return words(a.inside ? "inside" : "outside");
    if (name == "Ri:TextureCoordinates") return Information{{a.textureCoordinates, a.textureCoordinates + 8}, {}, false};
    if (name == "Ri:DetailRange") return Information{{a.detailRange, a.detailRange + 4}, {}, false};
    if (name.rfind(kCoordinate, 0) == 0) return coordinateSystem(w, name.substr(kCoordinate.size()));
    if (p && p->shape) {
        if (name == "Ri:Transformation") return matrixOf(p->shape->toCameraAt(p->shutter) * w.cameraToWorld());
        const bool back = dot(p->surface.n, p->I) > 0;
        if (name == "geometry:backfacing") return number(back);
        if (name == "geometry:frontfacing") return number(!back);
        if (name == "geometry:geometricnormal") return Information{{p->surface.n.x, p->surface.n.y, p->surface.n.z}, {}, false};
        if (name == kObjectBox) {
            const auto box = objectBox(*p->shape->source().primitive);
            if (!box) return std::nullopt;
            return Information{{box->begin(), box->end()}, {}, false};
        }
        if (name == "diffusedepth") return number(p->ray ? float(p->ray->diffuseBounces) : 0.f);
    }
    if (b && name == "shaderdisplacementbound:sphere") return shaderBound(*b, false);
    if (b && name == "shaderdisplacementbound:coordinatesystem") return shaderBound(*b, true);
    if (const scene::Param* set = a.value(name)) return given(set);
    if (name == "light:units") { // result of an area light that does not set it
        const bool emits = a.areaLight >= 0 && size_t(a.areaLight) < w.lights().size();
        return words((emits ? w.lights()[size_t(a.areaLight)].mean : w.settings().hider != Hider::Path) ? "samples" : "radiance");
    }
    return unset(known::knownAttributes(), name, w.settings().hider == Hider::Path);
}

bool ofPoint(const std::string& name) {
    for (const char* n : {"Ri:Transformation", "geometry:backfacing", "geometry:frontfacing", "geometry:geometricnormal",
                          kObjectBox, "diffusedepth"})
        if (name == n) return true;
    return false;
}

std::optional<Information> optionOf(const WorldImpl& w, const std::string& name) {
    const scene::Options& o = w.frame().options;
    std::vector<float> v;
    const float aspect = o.frameAspect.value_or(
        o.xres > 0 && o.yres > 0 && o.pixelAspect != 0 ? float(o.xres) * std::fabs(o.pixelAspect) / float(o.yres) : 1.f);
    if (name == "Ri:Frame" || name == "Frame") v = {float(o.frameNumber)};
    else if (name == "Ri:Format" || name == "Format") v = {float(o.xres), float(o.yres), o.pixelAspect};
    else if (name == "Ri:PixelSamples" || name == "PixelSamples") v = {o.pixelSamplesX, o.pixelSamplesY};
    else if (name == "Ri:Shutter" || name == "Shutter") v = {o.shutterOpen, o.shutterClose};
    else if (name == "Ri:Clipping" || name == "Clipping") v = {o.clipNear, o.clipFar};
    else if (name == "Ri:CropWindow" || name == "CropWindow") v.assign(o.crop, o.crop + 4);
    else if (name == "Ri:FrameAspectRatio" || name == "FrameAspectRatio") v = {aspect};
    else if ((name == "Ri:PixelVariance" || name == "PixelVariance") && o.pixelVariance >= 0) v = {o.pixelVariance};
    else if (name == "Ri:ScreenWindow" || name == "ScreenWindow")
        v = o.screenWindow.value_or(aspect >= 1 ? std::vector<float>{-aspect, aspect, -1, 1}
                                                : std::vector<float>{-1, 1, -1 / aspect, 1 / aspect});
    else if (name == "Ri:DepthOfField" || name == "DepthOfField") v = {o.fstop, o.focalLength, o.focalDistance};
    else if (name == "Ri:Hider" || name == "Hider")
        return words(w.settings().hider == Hider::Path       ? "path"
                     : w.settings().hider == Hider::Raytrace ? "raytrace"
                                                             : "hidden"); // the active hider
    else if (name == "Ri:Display" || name == "Display") return words(o.displays.empty() ? "ri.pic" : o.displays[0].name);
    else if (name == "trace:maxdepth") v = {float(w.maxDepth())};
    else if (const auto i = o.values.find(name); i != o.values.end()) return given(&i->second);
    else return unset(known::knownOptions(), name, w.settings().hider == Hider::Path);
    return Information{v, {}, false};
}

std::optional<Information> rendererInfoOf(const std::string& name) {
    if (name == "renderer") return words("Alpenglow");
    if (name == "versionstring") return words(versionText());
    if (name == "version") {
        const auto& n = versionNumbers();
        return Information{{float(n[0]), float(n[1]), float(n[2]), 0}, {}, false};
    }
    return std::nullopt;
}

std::optional<Information> rayInfoOf(const std::string& name, const shading::PathRay* r, const shading::ShadePoint& p) {
    if (name == "type") return words(r ? shading::toString(r->type()) : "light");
    if (name == "label") return words(r ? rsl::internedString(r->kind->label) : "");
    if (name == "depth") return number(r ? float(r->bounces) : 0.f);
    if (name == "speculardepth") return number(r ? float(r->specularBounces) : 0.f);
    if (name == "diffusedepth") return number(r ? float(r->diffuseBounces) : 0.f);
    if (name == "origin" && r) return Information{{r->begin().x, r->begin().y, r->begin().z}, {}, false};
    if (name == "direction" && r) return Information{{r->dir.x, r->dir.y, r->dir.z}, {}, false};
    if (name == "weight") return number(r ? r->importance : 1.f);
    if (name == "length") return number(length(p.I));
    return std::nullopt;
}

Matrix spaceAt(const WorldImpl& w, const std::string& from, const std::string& to, const shading::ShadePoint& p,
               const SurfaceBinding* b) {
    const auto own = [&](const std::string& space, Matrix& toCurrent) {
        if (space == "object" && p.shape) return toCurrent = p.shape->toCameraAt(p.shutter), true;
        if (space == "shader" && b && b->surface) return toCurrent = b->surface->toCurrentAt(p.shutter), true;
        return false;
    };
    Matrix in, out;
    if (from != "current" && !own(from, in)) w.matrix(from, "current", in);
    if (to != "current") {
        if (own(to, out)) out = inverse(out);
        else w.matrix("current", to, out);
    }
    return in * out;
}

} // namespace alpenglow::world

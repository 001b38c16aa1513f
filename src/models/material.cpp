// glTF's materials as parameters of shaders/standard.sl, whose *_channel defaults are glTF's.
#include "models/rib.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace alpenglow::models {

namespace {

/// The parameters of one Surface request.
class Parameters {
public:
    Parameters(const Material& m, const MapMaker& maps, const std::function<void(std::string)>& note)
        : m_(m), maps_(maps), note_(note) {}
    void number(const char* name, double v, double byDefault) {
        if (v != byDefault) text_ += fmt::format(" \"float {}\" [{:.9g}]", name, v);
    }
    void color(const char* name, const double* c) {
        text_ += fmt::format(" \"color {}\" [{:.9g} {:.9g} {:.9g}]", name, c[0], c[1], c[2]);
    }
    /// The map that multiplies a parameter; its channels, 0 where there is none.
    int map(const char* name, const Texture& t, bool colour) {
        if (!t.used()) return 0;
        const MapFile f = maps_({&t, colour});
        if (f.name.empty()) return 0;
        text_ += fmt::format(" \"string {}_map\" {}", name, quoted(f.name));
        place(t);
        return f.channels;
    }
    /// A map of which one channel counts, which pictures of one or two channels do not have.
    void channel(const char* name, const Texture& t, int wanted) {
        const int n = map(name, t, false);
        if (n > 0 && n <= wanted) text_ += fmt::format(" \"float {}_channel\" [{}]", name, wanted == 3 ? -1 : 0);
    }
    std::string text() {
        if (placed_) {
            const Texture& t = *placed_;
            if (t.scale[0] != 1 || t.scale[1] != 1)
                text_ += fmt::format(" \"float[2] map_scale\" [{:.9g} {:.9g}]", t.scale[0], t.scale[1]);
            if (t.offset[0] != 0 || t.offset[1] != 0)
                text_ += fmt::format(" \"float[2] map_offset\" [{:.9g} {:.9g}]", t.offset[0], t.offset[1]);
            number("map_rotation", t.rotation * 180 / kPi, 0);
        }
        return text_;
    }
    void note(std::string text) { note_(fmt::format("material \"{}\": {}", m_.name, text)); }

private:
    /// All maps of a standard lie in one place: that of the first.
    void place(const Texture& t) {
        if (!placed_) {
            placed_ = &t;
            return;
        }
        const Texture& a = *placed_;
        if (t.scale[0] != a.scale[0] || t.scale[1] != a.scale[1] || t.offset[0] != a.offset[0] || t.offset[1] != a.offset[1] ||
            t.rotation != a.rotation)
            note("its textures are placed in different ways; all are placed as the first");
        if (t.set != a.set) note("its textures use different sets of coordinates; all use that of the first");
    }
    const Material& m_;
    const MapMaker& maps_;
    const std::function<void(std::string)>& note_;
    std::string text_;
    const Texture* placed_ = nullptr;
};

const Material& materialOf(const Model& model, int i) {
    static const Material usual;
    return i == kNone ? usual : model.materials[size_t(i)];
}

/// A surface that shines as its colour says and answers to no light.
void unlit(const Material& m, Parameters& p) {
    p.number("base", 0, 1);
    p.number("specular", 0, 1);
    p.number("emission", 1, 0);
    p.color("emission_color", m.baseColor);
    p.map("emission", m.baseColorMap, true);
}

void glass(const Material& m, Parameters& p) {
    p.number("transmission", m.transmission, 0);
    p.channel("transmission", m.transmissionMap, 0);
    double tint[3];
    for (int k = 0; k < 3; ++k) tint[k] = m.baseColor[k];
    if (m.thickness > 0 && m.attenuationDistance > 0) {
        p.number("transmission_depth", m.attenuationDistance, 0);
        for (int k = 0; k < 3; ++k) tint[k] = m.attenuationColor[k];
        if (m.baseColor[0] != 1 || m.baseColor[1] != 1 || m.baseColor[2] != 1)
            p.note("what comes through has the colour of the way inside alone, not that of the base as well");
    }
    p.color("transmission_color", tint);
    if (m.baseColorMap.used()) p.note("its texture does not colour what comes through");
    if (!(m.thickness > 0)) p.number("thin_walled", 1, 0);
}

void alpha(const Material& m, int baseChannels, Parameters& p) {
    if (m.alphaMode == AlphaMode::Opaque) return;
    const double opacity[3] = {m.baseColor[3], m.baseColor[3], m.baseColor[3]};
    p.color("opacity", opacity);
    if (baseChannels == 4 || baseChannels == 2) p.map("opacity", m.baseColorMap, true);
    if (baseChannels == 2) p.number("opacity_channel", 1, 3);
    if (m.alphaMode == AlphaMode::Mask) p.number("alpha_cutoff", std::max(m.alphaCutoff, 1e-6), 0);
}

bool any(const double* c) { return c[0] > 0 || c[1] > 0 || c[2] > 0; }

void layers(const Material& m, Parameters& p) {
    if (m.coat > 0) {
        p.number("coat", m.coat, 0);
        p.number("coat_roughness", m.coatRoughness, -1);
        p.channel("coat", m.coatMap, 0);
        p.channel("coat_roughness", m.coatRoughnessMap, 1);
    }
    if (any(m.sheenColor)) {
        p.number("sheen", 1, 0);
        p.color("sheen_color", m.sheenColor);
        p.number("sheen_roughness", m.sheenRoughness, -1);
        p.map("sheen_color", m.sheenColorMap, true);
        p.channel("sheen_roughness", m.sheenRoughnessMap, 3);
    }
    if (any(m.emission)) {
        const double strength = std::max({m.emission[0], m.emission[1], m.emission[2]});
        const double color[3] = {m.emission[0] / strength, m.emission[1] / strength, m.emission[2] / strength};
        p.number("emission", strength, 0);
        p.color("emission_color", color);
        p.map("emission", m.emissionMap, true);
    }
}

} // namespace

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return out + "\"";
}

int coordinateSet(const Material& m) {
    for (const Texture* t : {&m.baseColorMap, &m.metalRoughMap, &m.normalMap, &m.emissionMap, &m.transmissionMap, &m.coatMap,
                             &m.coatRoughnessMap, &m.specularMap, &m.specularColorMap, &m.sheenColorMap, &m.sheenRoughnessMap})
        if (t->used()) return t->set;
    return 0;
}

std::string materialText(const Model& model, int material, const MapMaker& maps, const std::function<void(std::string)>& note) {
    const Material& m = materialOf(model, material);
    Parameters p(m, maps, note);
    int baseChannels = 0;
    if (m.unlit) {
        unlit(m, p);
        if (m.baseColorMap.used()) baseChannels = maps({&m.baseColorMap, true}).channels;
    } else {
        p.color("base_color", m.baseColor);
        baseChannels = p.map("base_color", m.baseColorMap, true);
        p.number("metalness", m.metalness, 0);
        p.number("specular_roughness", m.roughness, .2);
        p.channel("metalness", m.metalRoughMap, 2);
        p.channel("specular_roughness", m.metalRoughMap, 1);
        p.number("specular", m.specular, 1);
        p.channel("specular", m.specularMap, 3);
        p.number("specular_IOR", m.ior, 1.5);
        if (m.specularColor[0] != 1 || m.specularColor[1] != 1 || m.specularColor[2] != 1)
            p.color("specular_color", m.specularColor);
        p.map("specular_color", m.specularColorMap, true);
        if (m.normalMap.used()) {
            const MapFile f = maps({&m.normalMap, false});
            if (!f.name.empty()) p.map("normal", m.normalMap, false);
            p.number("normal_scale", m.normalScale, 1);
        }
        if (m.transmission > 0) glass(m, p);
        layers(m, p);
    }
    alpha(m, baseChannels, p);
    return "Surface \"standard\"" + p.text() + "\n";
}

} // namespace alpenglow::models

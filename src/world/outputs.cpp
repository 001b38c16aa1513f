// Shader outputs that displays request: which exist, and their number of components.
#include "world/outputs.h"
#include "world/cloudstore.h"
#include "world/mutableworld.h"

namespace alpenglow::world {

namespace {

/// Width of a channel made by outputchannel(); 0 if no call makes it.
int channelWidth(const ShaderInstance& shader, const rsl::OutputName& name) {
    const std::string& base = name.name;
    const bool element = name.element >= 0;
    int most = 0, exactly = 0;
    const auto look = [&](const rsl::Program& program) {
        const auto width = [&](const shadeops::Type& type) {
            return shadeops::componentCount(type.base) * (element ? 1 : std::max(1, type.array));
        };
        for (const auto& [channel, type] : program.channels)
            if (channel[0] == rsl::kAnyChannel) most = std::max(most, width(type));
        if (const auto exact = program.channels.find(base); exact != program.channels.end())
            exactly = std::max(exactly, width(exact->second));
    };
    for (const rsl::CoShader& co : shader.coShaders) look(*co.program);
    look(shader.program->program());
    return exactly > 0 ? exactly : most;
}

/// Components of a shader's output; 0 if it has none of that name.
int widthIn(const ShaderInstance& shader, const rsl::OutputName& name) {
    const std::string& base = name.name;
    const bool element = name.element >= 0;
    for (const rsl::ParameterInfo& p : shader.program->parameters()) {
        if (p.name != base || !p.output || p.type.base == shadeops::Base::String) continue;
        int length = std::max(1, p.type.array);
        const auto given = shader.parameters.strings.find(rsl::lengthParameter(p.name));
        if (p.open && given != shader.parameters.strings.end()) length = std::max(1, std::atoi(given->second.c_str()));
        return shadeops::componentCount(p.type.base) * (element || !p.type.array ? 1 : length);
    }
    return channelWidth(shader, name);
}

} // namespace

bool gives(const ShaderInstance& shader, const rsl::OutputName& output) { return widthIn(shader, output) > 0; }

bool givesChannel(const ShaderInstance& shader, const rsl::OutputName& output) { return channelWidth(shader, output) > 0; }

bool givesPerhaps(const ShaderInstance& shader, const rsl::OutputName& output) {
    const std::string& base = output.name;
    for (const rsl::ParameterInfo& p : shader.program->parameters())
        if (p.name == base && p.output) return false;
    const auto says = [&](const rsl::Program& program) { return program.channels.count(base) > 0; };
    for (const rsl::CoShader& co : shader.coShaders)
        if (says(*co.program)) return false;
    return !says(shader.program->program()) && channelWidth(shader, output) > 0;
}

void addOutput(const ShaderInstance& shader, const rsl::OutputName& name, std::vector<std::string>& outputs) {
    const std::string& base = name.name;
    const auto declares = [&](const rsl::ParameterInfo& p) { return p.output && p.name == base; };
    const auto& parameters = shader.program->parameters();
    const rsl::ShaderKind kind = shader.program->kind();
    const bool oneOfMany =
        kind == rsl::ShaderKind::Light || kind == rsl::ShaderKind::Volume; // values by others remain where it writes none
    const bool channel = std::none_of(parameters.begin(), parameters.end(), declares) && channelWidth(shader, name) > 0;
    if (givesPerhaps(shader, name) || (oneOfMany && channel)) outputs.push_back(rsl::OutputName::given(base).text());
    outputs.push_back(name.text());
}

bool givenAt(const shading::Batch& b, const rsl::OutputName& name, int point) {
    const int given = b.output(rsl::OutputName::given(name.name));
    return given < 0 || b.value(given, 0, point) != 0;
}

std::vector<int> outputsNamed(const shading::Batch& b, const rsl::OutputName& name) {
    if (const int whole = b.output(name); whole >= 0) return {whole};
    std::vector<int> elements;
    if (name.element >= 0) return elements;
    rsl::OutputName element = name;
    for (int o; element.element = int(elements.size()), (o = b.output(element)) >= 0;) elements.push_back(o);
    return elements;
}

namespace {
const std::set<std::string> kNumbers = {"z", "u", "v", "s", "t", "alpha", "du", "dv", "time"};
const std::set<std::string> kTriples = {"P", "N", "Cs", "Os", "Ng", "I", "dPdu", "dPdv", "Ci", "Oi"};
} // namespace

std::set<const ShaderInstance*> WorldImpl::givers() const {
    std::set<const ShaderInstance*> shaders;
    for (const SurfaceBinding& b : bindings_)
        for (const InstanceRef& i : {b.surface, b.atmosphere.shader, b.interior, b.exterior})
            if (i) shaders.insert(i.get());
    for (const BoundLight& l : lights_)
        if (l.instance) shaders.insert(l.instance.get());
    return shaders;
}

World::NamedMedium WorldImpl::medium(size_t index) const {
    if (index >= media_.size()) return {};
    const Medium& m = media_[index];
    return {m.shader->name, m.shape ? m.shape->place() : m.shader->place};
}

std::vector<std::pair<std::string, SourcePlace>> WorldImpl::cloudsFoundEmpty() const {
    return clouds_ ? clouds_->foundNothing() : std::vector<std::pair<std::string, SourcePlace>>();
}

std::vector<std::string> WorldImpl::knownOutputs() const {
    std::set<std::string> names(kNumbers);
    names.insert(kTriples.begin(), kTriples.end());
    const auto channels = [&](const rsl::Program& program) {
        for (const auto& [channel, type] : program.channels)
            if (channel[0] != rsl::kAnyChannel) names.insert(channel);
    };
    for (const ShaderInstance* i : givers()) {
        for (const rsl::ParameterInfo& p : i->program->parameters())
            if (p.output && p.type.base != shadeops::Base::String) names.insert(p.name);
        channels(i->program->program());
        for (const rsl::CoShader& c : i->coShaders) channels(*c.program);
    }
    return {names.begin(), names.end()};
}

void MutableWorld::measureOutputs() {
    outputWidths_.clear();
    const std::set<const ShaderInstance*> shaders = givers();
    for (size_t k = 0; k < wanted_.size(); ++k) {
        const rsl::OutputName& name = wanted_[k];
        const std::string& text = settings_.outputs[k];
        int width = kNumbers.count(text) ? 1 : kTriples.count(text) ? 3 : 0;
        if (width == 0)
            for (const bool perhaps : {false, true}) { // possible writers count only if there is no certain one
                int found = 0;
                for (const ShaderInstance* i : shaders)
                    if (givesPerhaps(*i, name) == perhaps) found = std::max(found, widthIn(*i, name));
                if (width == 0) width = found;
            }
        if (width == 0 && !shapes_.empty()) missingOutputs_.push_back(text);
        if (width == 0 && k < settings_.outputWidths.size())
            width = settings_.outputWidths[k]; // no shader writes it: zeros, with the display's width
        outputWidths_.push_back(width > 0 ? width : 3);
    }
    for (LightOutputPlace& p : lightOutputs_) {
        if (p.component + p.size > outputWidths_[size_t(p.aov)]) continue;
        p.first = p.component;
        for (int k = 0; k < p.aov; ++k) p.first += outputWidths_[size_t(k)];
    }
    for (BoundLight& l : lights_)
        for (BoundLight::Value& v : l.values) {
            if (v.aov < 0) continue;
            int first = 0;
            for (int k = 0; k < v.aov; ++k) first += outputWidths_[size_t(k)];
            if (v.name.element >= 0 && wanted_[size_t(v.aov)].element < 0)
                first += v.components * v.name.element; // "list[2]" of "list"
            v.aov = first;
        }
}

} // namespace alpenglow::world

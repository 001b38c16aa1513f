// Requests of PRMan 21 and later (RIS): networks of patterns, what such a scene is drawn with. Its lights: rislights.cpp.
// docs/ris.md has what they mean here.
#include "ri/ris.h"
#include "ri/interpreter.h"
#include "ri/motion.h"
#include "ri/oslnetwork.h"
#include "scene/network.h"
#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace alpenglow::ri {
namespace {

/// "tex:resultRGB", with the handle up to the last colon: those of Maya have some of their own.
scene::Connection connection(const std::string& parameter, int element, const std::string& text, const SourcePlace& place) {
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos) return {parameter, element, text, {}, place};
    return {parameter, element, text.substr(0, colon), text.substr(colon + 1), place};
}

/// Follows the connections of a request from pattern to pattern, and keeps what they mean now.
class Network {
public:
    Network(Interpreter& in, scene::Keeper keeper, std::map<std::string, scene::ShaderRef> patterns)
        : in_(in), keeper_(keeper), patterns_(std::move(patterns)) {}

    /// The call with its connections led to what is kept.
    scene::ShaderRef keep(const scene::ShaderCall& call, const std::string& handle) {
        way_.push_back(handle);
        auto copy = std::make_shared<scene::ShaderCall>(call);
        copy->connections.clear();
        for (scene::Connection c : call.connections) {
            intoLayer(c);
            if (!follow(c, call)) continue;
            c.handle = scene::keptHandle(keeper_, c.handle);
            copy->connections.push_back(std::move(c));
        }
        way_.pop_back();
        return copy;
    }
    std::map<std::string, scene::ShaderRef> kept;

private:
    /// "C.Cout" of a network of OSL is the output Cout of its layer C.
    void intoLayer(scene::Connection& c) const {
        const size_t dot = c.output.find('.');
        if (dot == std::string::npos) return;
        std::string layer = layerHandle(c.handle, std::string_view(c.output).substr(0, dot));
        if (!patterns_.count(layer)) return;
        c.handle = std::move(layer);
        c.output.erase(0, dot + 1);
    }
    bool follow(const scene::Connection& c, const scene::ShaderCall& of) {
        const std::string what = fmt::format("\"{}\" of {} keeps its own value", c.parameter, of.name);
        if (std::find(way_.begin(), way_.end(), c.handle) != way_.end()) {
            std::string circle;
            for (auto i = std::find(way_.begin(), way_.end(), c.handle); i != way_.end(); ++i) circle += shownHandle(*i) + " > ";
            in_.reporter.error(Rie::BadHandle, c.place,
                               fmt::format("connections run in a circle: {}{}; {}", circle, shownHandle(c.handle), what));
            return false;
        }
        const std::string key = scene::keptHandle(keeper_, c.handle);
        if (kept.count(key)) return true;
        const auto found = patterns_.find(c.handle);
        if (found == patterns_.end()) {
            std::vector<std::string> known;
            for (const auto& [handle, call] : patterns_)
                if (!scene::isKept(handle)) known.push_back(shownHandle(handle));
            const std::string near = nearestName(c.handle, known);
            in_.reporter.once("ri:pattern:" + of.name + c.parameter + c.handle, Severity::Error, Rie::BadHandle, c.place,
                              fmt::format("there is no Pattern \"{}\" here: {}", c.handle, what),
                              near.empty() ? "" : "did you mean \"" + near + "\"?");
            return false;
        }
        if (way_.size() >= kNetworkDepth || kept.size() >= kNetworkPatterns) {
            in_.reporter.once("ri:network", Severity::Error, Rie::Limit, c.place,
                              fmt::format("a network has more than {} patterns, or more than {} behind each other: {}",
                                          kNetworkPatterns, kNetworkDepth, what));
            return false;
        }
        scene::ShaderRef pattern = keep(*found->second, c.handle);
        kept[key] = std::move(pattern);
        return true;
    }

    Interpreter& in_;
    scene::Keeper keeper_;
    std::map<std::string, scene::ShaderRef> patterns_;
    std::vector<std::string> way_; ///< handles from the request to here
};

} // namespace

std::string connectedName(const std::string& token) {
    std::istringstream in(token);
    std::string word, last;
    if (!(in >> word) || word != "reference") return {};
    while (in >> word)
        if (word.front() != '[') last = word;
    return last.substr(0, last.find('['));
}

std::shared_ptr<scene::ShaderCall> Interpreter::networkCall(const Call& call) {
    ris_ = true;
    Call plain = call;
    plain.params.clear();
    std::vector<scene::Connection> connections;
    for (const RawParam& raw : call.params) {
        const std::string name = connectedName(raw.token);
        if (name.empty()) {
            plain.params.push_back(raw);
            continue;
        }
        const std::vector<std::string>& to = raw.value.strings;
        if (raw.value.kind != Value::Kind::Strings) {
            reporter.error(
                Rie::Consistency, call.at(raw),
                fmt::format("{}: \"{}\" is a connection, which is a string \"handle:output\"", call.request->name, name));
            continue;
        }
        for (size_t i = 0; i < to.size(); ++i)
            if (!to[i].empty()) connections.push_back(connection(name, to.size() > 1 ? int(i) : -1, to[i], call.at(raw)));
    }
    auto s = std::make_shared<scene::ShaderCall>(*shader(plain));
    s->connections = std::move(connections);
    return s;
}

void Interpreter::pattern(const Call& call) {
    std::shared_ptr<scene::ShaderCall> p = networkCall(call);
    auto& known = attributes().coshaders; // layers of a network that the handle was
    for (auto c = known.lower_bound(layersOf(call.text(1))); c != known.end() && c->first.starts_with(layersOf(call.text(1)));)
        c = known.erase(c);
    if (const scene::Param* net = scene::find(p->params, "network"); net && p->name == "PxrOSL")
        return oslPatterns(call, *p, *net);
    if (p->name == "PxrOSL") { // its "shader" is the pattern
        const auto named = std::find_if(p->params.begin(), p->params.end(), [](const auto& v) { return v.name == "shader"; });
        if (named == p->params.end() || named->strings.empty()) {
            reporter.error(Rie::MissingData, call.place, "Pattern \"PxrOSL\" needs \"string shader\" or \"string network\"");
            return;
        }
        p->name = named->strings[0];
        p->params.erase(named);
    }
    const bool number = scene::find(p->params, "inputF") || std::any_of(p->connections.begin(), p->connections.end(),
                                                                        [](const auto& c) { return c.parameter == "inputF"; });
    if (p->name == "PxrTee" && number) p->name = "PxrTeeFloat"; // an output has one type
    known[call.text(1)] = std::move(p);
}

scene::ShaderRef Interpreter::network(const Call& call, scene::Keeper keeper) {
    const std::shared_ptr<scene::ShaderCall> root = networkCall(call);
    scene::Attributes& a = attributes();
    const std::string mark = scene::keptHandle(keeper, "");
    std::erase_if(a.coshaders, [&](const auto& c) { return c.first.starts_with(mark); });
    if (keeper != scene::Keeper::Light && !call.text(1).empty()) a.coshaders[call.text(1)] = root;
    Network n(*this, keeper, a.coshaders);
    root->handle = call.text(1);
    scene::ShaderRef kept = n.keep(*root, call.text(1));
    a.coshaders.insert(n.kept.begin(), n.kept.end());
    return kept;
}

/// A scene of RIS without lights and without an integrator that follows light is lit along the axis of the camera: white paint
/// that faces it has radiance 1.
void Interpreter::addHeadlight(scene::Frame& frame) {
    if (!ris_ || !headlight_ || !frame.lights.empty() || (frame.primitives.empty() && frame.instances.empty())) return;
    auto call = std::make_shared<scene::ShaderCall>();
    call->name = "PxrDistantLight";
    const auto give = [&](const char* name, float value) {
        scene::Param p;
        p.name = name;
        p.numbers = {value};
        call->params.push_back(std::move(p));
    };
    give("intensity", 3.14159265f);
    give("areaNormalize", 1);
    call->toWorld = inverse(frame.options.worldToCamera);
    call->place = frame.primitives.empty() ? frame.instances[0].place : frame.primitives[0]->place;
    scene::Light l;
    l.shader = std::move(call);
    l.attributes = std::make_shared<scene::Attributes>();
    globalLights_.insert(0);
    frame.lights.push_back(std::move(l));
}

/// What a scene of RIS is drawn with when it names no hider that could: by path, with as many samples as its raytrace has.
void Interpreter::risOptions(scene::Options& o) const {
    if (!ris_) return;
    const bool chosen = o.hiderPlace.line > 0;
    if (chosen && o.hider != "raytrace") return;
    o.hider = "path";
    const scene::Param* most = scene::find(o.hiderParams, "maxsamples");
    if (!chosen || !most || most->numbers.empty() || o.pixelSamplesSet || !(most->numbers[0] >= 1)) return;
    o.pixelSamplesX = most->numbers[0];
    o.pixelSamplesY = 1;
    o.pixelSamplesSet = true;
}

} // namespace alpenglow::ri

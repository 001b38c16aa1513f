// Names of Option and Attribute, and parameters of Hider and Display, that are in no table (base/knownoptions.h).
#include "base/knownoptions.h"
#include "ri/interpreter.h"
#include <fmt/format.h>
#include <iterator>
#include <sstream>

namespace alpenglow::ri {
namespace {

std::set<std::string> wordsOf(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// Classes of PRMan, 3Delight, Aqsis, BMRT, Pixie, Entropy, Air, RenderDotC and their exporters, whose names do nothing here and
/// change no picture by much: none of them is warned about.
const std::set<std::string>& otherClasses(bool option) {
    static const std::set<std::string> options =
        wordsOf("3delight Hider RI Render Ri air aqsis bake bmrt bucket cache caustic checkpoint curve delight dice display "
                "dspy dspyplugin entropy error exrheader exrprefix file frame fur geometry hair header history houdini indirect "
                "irradiance license licenses licenseserver lighting lightpath limits lock lpe maya message messages netcache "
                "occlusion osl photon pixie plugin prman procedural quicknoise radiosity rdc render rerender ri rib ribparse "
                "rslplugin runtime shader shadow shutter statistics stereo stitch subsurface texture threads time version vm");
    static const std::set<std::string> attributes =
        wordsOf("3delight RI Ri air aqsis area areashadow autoshadows bake blobby bmrt camera caustic caustics cull curve "
                "delight derivatives dice divisions entropy fur hair houdini identifier indirect irradiance lightfilter "
                "lighting lightmap lpe maya mesh occlusion photon pixie polygon procedural radiosity reflection ri rib shader "
                "shadow shutter sides spline sss statistics stereo stitch stochastic subdivision subdivisionmesh subsurface "
                "texture time toon trimcurve volume");
    return option ? options : attributes;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates) {
    const std::string near = nearestName(word, candidates);
    return near.empty() || near == word ? "" : "did you mean \"" + near + "\"?";
}

} // namespace

bool Interpreter::sayUnknown(bool option, const std::string& category, const scene::Param& p) {
    if (category == "user") return true;
    const auto table = option ? known::knownOptions() : known::knownAttributes();
    const char* what = option ? "Option" : "Attribute";
    const std::string key = category + ":" + p.name;
    const known::OptionDescription* entry = known::findKnown(table, key);
    if (entry && entry->settable()) return true;
    const std::string head = fmt::format("{} \"{}\" \"{}\"", what, category, p.name);
    if (entry || otherClasses(option).count(category)) {
        reporter.once("ri:" + head, Severity::Info, Rie::BadToken, p.place, head + " does nothing here");
        return false;
    }
    std::string hint;
    const std::vector<std::string> names = known::knownNames(table, category);
    if (known::findKnown(option ? known::knownAttributes() : known::knownOptions(), key))
        hint = option ? "it is an Attribute" : "it is an Option";
    else if (!names.empty()) hint = didYouMean(p.name, names);
    else {
        std::vector<std::string> classes = known::knownNames(table, "");
        classes.emplace_back("user");
        hint = didYouMean(category, classes);
    }
    reporter.once("ri:" + head, Severity::Warning, Rie::BadToken, p.place,
                  head + " is not known: it does nothing, unless a shader asks for it", hint);
    return false;
}

/// What says elsewhere what is taken for a parameter of Hider; "": nothing known.
static std::string saidElsewhere(const std::string& name) {
    for (const char* samples : {"samples", "spp", "pixelsamples", "samplesperpixel"})
        if (name == samples) return "PixelSamples x y gives each pixel x times y samples, and so does --spp";
    for (const char* depth : {"maxdepth", "depth", "bounces", "maxpathlength"})
        if (name == depth) return "Option \"trace\" \"int maxdepth\" says how long paths are, and so does --max-depth";
    return "";
}

bool Interpreter::sayUnknownParameter(bool hider, const scene::Param& p) {
    const auto table = hider ? known::knownHiderParameters() : known::knownDisplayParameters();
    const known::OptionDescription* entry = known::findKnown(table, p.name);
    if (entry && entry->settable()) return true;
    const std::string head = fmt::format("{} parameter \"{}\"", hider ? "Hider" : "Display", p.name);
    if (entry) {
        reporter.once("ri:" + head, Severity::Info, Rie::BadToken, p.place, head + " does nothing here");
        return false;
    }
    std::vector<std::string> names;
    for (const known::OptionDescription& d : table)
        if (d.settable()) names.emplace_back(d.name);
    const std::string elsewhere = hider ? saidElsewhere(p.name) : "";
    reporter.once("ri:" + head, Severity::Warning, Rie::BadToken, p.place, head + " is not known: it does nothing",
                  elsewhere.empty() ? didYouMean(p.name, names) : elsewhere);
    return false;
}

} // namespace alpenglow::ri

#include "rsl/plugins.h"
#include "alpenglow/rslplugin.h"
#include "base/file.h"
#include "base/limits.h"
#include "rsl/kernel.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <cctype>
#include <dlfcn.h>
#include <filesystem>
#include <set>

namespace fs = std::filesystem;

namespace alpenglow::rsl {
namespace {

const char* textOf(int32_t id) { return internedString(id).c_str(); }
int32_t stringOf(const char* text) { return internString(text ? text : ""); }
constexpr AlpenglowRslHost kHost = {ALPENGLOW_RSL_PLUGIN_ABI, &textOf, &stringOf};

int rowsOf(Type t) { return componentCount(t.base) * std::max(1, t.array); }

/// The name before the bracket; "" when the text is no signature that a plug-in can have, with the reason.
std::string nameOf(const std::string& text, const Signature& s, std::string& why) {
    const size_t open = text.find('(');
    if (open == std::string::npos || text.find_last_not_of(" \t;") == std::string::npos ||
        text[text.find_last_not_of(" \t;")] != ')') {
        why = "it has no list of parameters";
        return {};
    }
    size_t end = open;
    while (end > 0 && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
    size_t begin = end;
    while (begin > 0 && (std::isalnum(static_cast<unsigned char>(text[begin - 1])) || text[begin - 1] == '_')) --begin;
    if (begin == end || begin == 0) {
        why = "it has no result and name";
        return {};
    }
    if (s.result.base == Base::Void && text.compare(0, 4, "void") != 0) why = "its result is of no type that shaders have";
    if (s.result.array) why = "a result cannot be an array";
    if (s.repeats || s.pairs) why = "the number of its arguments must be fixed";
    for (const Parameter& p : s.parameters) {
        if (p.type.base == Base::Void) why = "parameter '" + p.name + "' is of no type that shaders have";
        if (p.type.array < 0) why = "the array '" + p.name + "' has no length";
        if (p.type.array > limits::kShaderArray) why = "the array '" + p.name + "' is too long";
    }
    return why.empty() ? text.substr(begin, end - begin) : "";
}

/// What is wrong between a signature and the rows that its function works on.
std::string unfit(const Signature& s, const AlpenglowRslEntry& e) {
    int in = 0, out = rowsOf(s.result);
    for (const Parameter& p : s.parameters) {
        in += rowsOf(p.type);
        if (p.output) out += rowsOf(p.type);
    }
    if ((e.rowsIn >= 0 && e.rowsIn != in) || (e.rowsOut >= 0 && e.rowsOut != out))
        return "it says " + std::to_string(in) + " numbers in and " + std::to_string(out) + " out, its function has " +
               std::to_string(e.rowsIn) + " and " + std::to_string(e.rowsOut);
    return {};
}

/// The entries as descriptors.
std::shared_ptr<Plugin> describe(const AlpenglowRslPlugin& from, const std::string& name, const std::string& path,
                                 std::map<std::string, void*>& addresses, std::string& why) {
    auto plugin = std::make_shared<Plugin>();
    plugin->name = name;
    plugin->path = path;
    std::set<std::string> seen;
    for (uint32_t k = 0; k < from.count; ++k) {
        const AlpenglowRslEntry& e = from.entries[k];
        const std::string text = e.signature ? e.signature : "";
        Signature s = parseSignature(text, kPluginSymbol + path + ":" + text);
        const std::string function = nameOf(text, s, why);
        if (why.empty() && !e.call) why = "it has no function";
        if (why.empty() && !seen.insert(text).second) why = "it stands there twice";
        if (why.empty()) why = unfit(s, e);
        if (!why.empty()) {
            why = "of the signature \"" + text + "\" in " + path + ", " + why;
            return nullptr;
        }
        addresses[s.symbol] = reinterpret_cast<void*>(e.call);
        auto op = std::find_if(plugin->functions.begin(), plugin->functions.end(),
                               [&](const Shadeop& o) { return o.name == function; });
        if (op == plugin->functions.end()) {
            Shadeop fresh;
            fresh.name = function;
            fresh.lowering = Lowering::Service;
            fresh.derivative = DerivativeRule::ZeroWarn;
            fresh.section = kPluginSection;
            fresh.source = path;
            op = plugin->functions.insert(plugin->functions.end(), std::move(fresh));
        }
        if (e.doc && op->doc.empty()) op->doc = e.doc;
        op->signatures.push_back(std::move(s));
    }
    std::sort(plugin->functions.begin(), plugin->functions.end(),
              [](const Shadeop& a, const Shadeop& b) { return a.name < b.name; });
    return plugin;
}

} // namespace

std::shared_ptr<const Plugin> PluginLibrary::load(const std::string& name, const std::vector<std::string>& folders, Raised& why,
                                                  std::string& hint) {
    std::optional<FoundFile> found;
    const bool file = name.ends_with(".so");
    if (file) found = findFile(name, folders);
    for (const std::string& n : {name + ".so", "lib" + name + ".so"})
        if (!found && !file && (n[0] == 'l' || !name.empty())) found = findFile(n, folders);
    if (!found) {
        why = msg::kPluginMissing(name);
        hint = "it is looked for as " + (file ? name : name + ".so") +
               " in the folder of the shader and in the folders of the rslplugin search path";
        return nullptr;
    }
    std::error_code none;
    std::string path = fs::canonical(found->path, none).string();
    if (path.empty()) path = found->path;
    std::lock_guard lock(mutex_);
    if (const auto it = byPath_.find(path); it != byPath_.end()) return it->second;
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        const char* reason = dlerror();
        why = msg::kPluginLoad(name, reason ? std::string(reason) : path);
        return nullptr;
    }
    const auto entry = reinterpret_cast<AlpenglowRslEntryPoint>(dlsym(library, ALPENGLOW_RSL_PLUGIN_SYMBOL));
    const AlpenglowRslPlugin* plugin = entry ? entry(&kHost) : nullptr;
    if (!plugin || plugin->abi != ALPENGLOW_RSL_PLUGIN_ABI) {
        why = msg::kPluginUnusable(name, "\"" + path + "\" is " +
                                             (!plugin ? "no RSL plug-in"
                                                      : "an RSL plug-in of version " + std::to_string(plugin->abi) + ", not " +
                                                            std::to_string(ALPENGLOW_RSL_PLUGIN_ABI)));
        hint = plugin ? "compile it with the rslplugin.h of this renderer"
                      : "plug-ins of other renderers are of other kinds: see docs/plugins.md";
        dlclose(library);
        return nullptr;
    }
    std::map<std::string, void*> addresses;
    std::string wrong;
    const auto described = describe(*plugin, name, path, addresses, wrong);
    if (!described) {
        why = msg::kPluginUnusable(name, wrong);
        return nullptr;
    }
    addresses_.insert(addresses.begin(), addresses.end());
    byPath_[path] = described;
    return described;
}

void* PluginLibrary::address(const std::string& symbol) const {
    std::lock_guard lock(mutex_);
    const auto it = addresses_.find(symbol);
    return it == addresses_.end() ? nullptr : it->second;
}

} // namespace alpenglow::rsl

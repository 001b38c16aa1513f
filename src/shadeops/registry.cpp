// All sections in one sorted list, and the parser of signatures.
#include "shadeops/describe.h"
#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace alpenglow::shadeops {
namespace {

/// Words, '[', ']', ';', ',', '(', ')' and "..." of a signature.
std::vector<std::string> words(std::string_view text) {
    std::vector<std::string> list;
    for (size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++i;
        } else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
            size_t end = i;
            while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
            list.emplace_back(text.substr(i, end - i));
            i = end;
        } else if (text.substr(i, 3) == "...") {
            list.emplace_back("...");
            i += 3;
        } else {
            list.emplace_back(1, c);
            ++i;
        }
    }
    return list;
}

bool baseOf(const std::string& word, Base& base) {
    static constexpr struct {
        const char* name;
        Base base;
    } kNames[] = {{"void", Base::Void},     {"any", Base::Void},     {"shader", Base::Shader}, {"float", Base::Float},
                  {"color", Base::Color},   {"point", Base::Point},  {"vector", Base::Vector}, {"normal", Base::Normal},
                  {"matrix", Base::Matrix}, {"string", Base::String}};
    for (const auto& n : kNames)
        if (word == n.name) {
            base = n.base;
            return true;
        }
    return false;
}

/// Reads "[]" or "[4]" at position i, if there.
void readArray(const std::vector<std::string>& list, size_t& i, Type& type) {
    if (i + 1 < list.size() && list[i] == "[") {
        if (list[i + 1] == "]") {
            type.array = -1;
            i += 2;
        } else if (i + 2 < list.size() && list[i + 2] == "]") {
            type.array = std::atoi(list[i + 1].c_str());
            i += 3;
        }
    }
}

std::vector<Shadeop> buildAll() {
    std::vector<Shadeop> all;
    for (auto section :
         {mathematicsShadeops, noiseShadeops, geometryShadeops, matrixShadeops, colourShadeops, splineShadeops,
          derivativeShadeops, lightingShadeops, bsdfShadeops, messageShadeops, stringShadeops, arrayShadeops, textureShadeops,
          raytracingShadeops, rayTestShadeops, facetShadeops, compatibilityShadeops, radianceSampleShadeops})
        for (Shadeop& op : section()) {
            // One name, one object: rotate() of points and rotate() of matrices stand in two sections.
            auto same = std::find_if(all.begin(), all.end(), [&](const Shadeop& o) { return o.name == op.name; });
            if (same == all.end()) {
                all.push_back(std::move(op));
                continue;
            }
            same->signatures = std::move(same->signatures) + op.signatures;
            same->examples.insert(same->examples.end(), op.examples.begin(), op.examples.end());
            same->doc += " " + op.doc;
        }
    std::sort(all.begin(), all.end(), [](const Shadeop& a, const Shadeop& b) { return a.name < b.name; });
    return all;
}

} // namespace

Signature parseSignature(std::string_view text, std::string symbol) {
    Signature s;
    s.text = text;
    s.symbol = std::move(symbol);
    const std::vector<std::string> list = words(text);
    size_t i = 0;
    if (i < list.size() && list[i] == "uniform") ++i;
    if (i < list.size() && baseOf(list[i], s.result.base)) ++i;
    readArray(list, i, s.result);
    while (i < list.size() && list[i] != "(") ++i;
    ++i;
    Parameter p; // type and storage carry over to the next name: "float a, b"
    const auto isStorage = [](const std::string& w) { return w == "output" || w == "uniform" || w == "varying"; };
    for (; i < list.size() && list[i] != ")";) {
        const bool opened = i > 0 && isStorage(list[i - 1]);
        if (list[i] == ";" || list[i] == ",") {
            ++i;
        } else if (list[i] == "...") {
            s.repeats = true;
            ++i;
        } else if (list[i] == "pairs") {
            s.pairs = true;
            ++i;
        } else if (isStorage(list[i])) {
            if (!opened) p = Parameter{};
            p.output |= list[i] == "output";
            p.uniform |= list[i] == "uniform";
            ++i;
        } else if (Base base; baseOf(list[i], base)) {
            if (!opened) p = Parameter{};
            p.type = Type{base, 0};
            ++i;
            readArray(list, i, p.type);
        } else {
            Parameter named = p;
            named.name = list[i++];
            readArray(list, i, named.type);
            s.parameters.push_back(named);
        }
    }
    return s;
}

std::vector<Signature> sigs(std::initializer_list<SignatureText> texts) {
    std::vector<Signature> list;
    for (const SignatureText& t : texts) list.push_back(parseSignature(t.text, t.symbol));
    return list;
}

std::vector<Signature> each(const std::string& types, const std::string& pattern, const std::string& symbol) {
    std::vector<Signature> list;
    for (const std::string& type : words(types)) {
        std::string text;
        for (const char c : pattern) text += c == '$' ? type : std::string(1, c);
        list.push_back(parseSignature(text, symbol.empty() ? "" : symbol + (type == "float" ? "_f" : "_t")));
    }
    return list;
}

std::vector<Signature> operator+(std::vector<Signature> a, const std::vector<Signature>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::vector<OptionalParameter> operator+(std::vector<OptionalParameter> a, const std::vector<OptionalParameter>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::span<const Shadeop> allShadeops() {
    static const std::vector<Shadeop> all = buildAll();
    return all;
}

const Shadeop* findShadeop(std::string_view name) {
    const std::span<const Shadeop> all = allShadeops();
    auto it = std::lower_bound(all.begin(), all.end(), name, [](const Shadeop& op, std::string_view n) { return op.name < n; });
    return it != all.end() && it->name == name ? &*it : nullptr;
}

} // namespace alpenglow::shadeops

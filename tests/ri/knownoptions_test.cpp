// The tables of options, attributes and parameters: every sample is read without a message, and the tables and the code that
// looks names up agree, by the text of the sources.
#include "base/knownoptions.h"
#include "collect.h"
#include "ri/declare.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <regex>

namespace knownoptions_test {

using namespace alpenglow;
using namespace alpenglow::ri;
using known::Effect;
using known::OptionDescription;

namespace {

std::string request(const char* kind, const OptionDescription& d) {
    const size_t colon = d.name.find(':');
    const std::string type(d.type), category(d.name.substr(0, colon)), name(d.name.substr(colon + 1));
    return std::string(kind) + " \"" + category + "\" \"" + (type.empty() ? "" : type + " ") + name + "\" " +
           std::string(d.sample) + "\n";
}

/// All of src but the tables themselves.
std::string sources() {
    std::string all;
    for (const auto& e : std::filesystem::recursive_directory_iterator(ALPENGLOW_SOURCE_DIR "/src")) {
        const std::string file = e.path().filename().string();
        if ((e.path().extension() != ".cpp" && e.path().extension() != ".h") || file.starts_with("known")) continue;
        std::ifstream in(e.path());
        all += std::string(std::istreambuf_iterator<char>(in), {}) + "\n";
    }
    return all;
}

} // namespace

TEST(KnownOptions, EverySampleIsReadWithoutAMessage) {
    for (const OptionDescription& d : known::knownOptions()) {
        if (!d.settable()) continue;
        ASSERT_FALSE(d.sample.empty()) << d.name;
        auto c = read(request("Option", d) + "WorldBegin\nWorldEnd\n");
        EXPECT_EQ(c->messages(), "") << d.name;
        EXPECT_TRUE(c->frame().options.values.count(std::string(d.name))) << d.name;
    }
    for (const OptionDescription& d : known::knownAttributes()) {
        if (!d.settable()) continue;
        ASSERT_FALSE(d.sample.empty()) << d.name;
        auto c = inWorld(request("Attribute", d) + "Sphere 1 -1 1 360");
        EXPECT_EQ(c->messages(), "") << d.name;
        EXPECT_NE(c->primitive().attributes->value(std::string(d.name)), nullptr) << d.name;
    }
    for (const OptionDescription& d : known::knownHiderParameters())
        if (d.settable())
            EXPECT_EQ(read("Hider \"hidden\" \"" + std::string(d.name) + "\" " + std::string(d.sample) + "\n")->messages(), "")
                << d.name;
    for (const OptionDescription& d : known::knownDisplayParameters())
        if (d.settable())
            EXPECT_EQ(read("Display \"a.tif\" \"tiff\" \"rgba\" \"" + std::string(d.name) + "\" " + std::string(d.sample) + "\n")
                          ->messages(),
                      "")
                << d.name;
}

// What has no effect is no failure, whatever its value is: the program's status stays 0.
TEST(KnownOptions, BadValuesOfWhatHasNoEffectAreWarnings) {
    for (const char* idle :
         {"Option \"limits\" \"int bucketsize\" [16 16]\n", "Option \"limits\" \"gridsize\" [\"a\"]\n",
          "Attribute \"trimcurve\" \"int nosuchname\" [1.5]\n", "Option \"nosuchclass\" \"int[2] x\" [1 2 3]\n",
          "Hider \"hidden\" \"int nosuchname\" [1 2]\n", "GeometricApproximation \"tesselation\" 32\n"}) {
        auto c = read(std::string(idle) + "WorldBegin\nWorldEnd\n");
        EXPECT_EQ(c->diagnostics.errors(), 0) << c->messages();
        EXPECT_GE(c->diagnostics.warnings(), 1) << idle;
    }
    auto c = read("GeometricApproximation \"tesselation\" 32\n");
    EXPECT_EQ(c->only().hint, "did you mean tessellation?");
    for (const char* used : {"Option \"limits\" \"int texturememory\" [16 16]\n", "Attribute \"dice\" \"int roundcurve\" [.5]\n",
                             "Option \"user\" \"int mine\" [1 2]\n"})
        EXPECT_EQ(read(used)->diagnostics.errors(), 1) << used;
}

TEST(KnownOptions, WhatTheCodeLooksUpIsInATable) {
    const std::string text = sources();
    const std::regex lookup(
        R"re((?:\.value|->value|values\.find|attributeNumber|attributeText|numberOf)\([^"\n]*"([a-z_]+:[a-z_]+)")re");
    const std::regex list(R"re(for \(const char\* \w+ : \{([^}]*)\})re"), name(R"re("([a-z_]+:[a-z_]+)")re");
    std::vector<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), lookup), end; i != end; ++i) found.push_back((*i)[1]);
    for (std::sregex_iterator i(text.begin(), text.end(), list), end; i != end; ++i) {
        const std::string items = (*i)[1];
        for (std::sregex_iterator k(items.begin(), items.end(), name); k != end; ++k) found.push_back((*k)[1]);
    }
    EXPECT_GT(found.size(), 20u);
    for (const std::string& n : found)
        EXPECT_TRUE(findKnown(known::knownOptions(), n) || findKnown(known::knownAttributes(), n))
            << n << " is read, but in no table";
}

TEST(KnownOptions, WhatIsCalledUsedIsRead) {
    const std::string text = sources();
    auto named = [&](std::string_view n) { return text.find("\"" + std::string(n) + "\"") != std::string::npos; };
    for (auto table : {known::knownOptions(), known::knownAttributes()})
        for (const OptionDescription& d : table) {
            if (d.effect != Effect::Used) continue;
            const bool composed = d.name.starts_with("searchpath:") || d.name.starts_with("visibility:"); // category, then name
            EXPECT_TRUE(named(d.name) || (composed && named(d.name.substr(d.name.find(':') + 1))))
                << d.name << " is read nowhere";
        }
    for (auto table : {known::knownHiderParameters(), known::knownDisplayParameters()})
        for (const OptionDescription& d : table)
            if (d.effect == Effect::Used) EXPECT_TRUE(named(d.name)) << d.name << " is read nowhere";
}

// A name that does nothing says whose it is and why; nothing is left without an answer or a reason.
TEST(KnownOptions, EveryNameSaysWhatItDoes) {
    for (auto table :
         {known::knownOptions(), known::knownAttributes(), known::knownHiderParameters(), known::knownDisplayParameters()})
        for (const OptionDescription& d : table) {
            EXPECT_GE(d.doc.size(), 10u) << d.name;
            if (d.effect == Effect::Ignored) EXPECT_NE(d.doc.find("; "), d.doc.npos) << d.name << ": " << d.doc;
            if (d.effect == Effect::Computed) EXPECT_FALSE(d.type.empty()) << d.name;
            if (d.effect == Effect::ForShaders) EXPECT_FALSE(d.answer.empty()) << d.name;
        }
}

// Each name with an effect stands in a test of that effect: in a file that names its category, too. These only read all names.
TEST(KnownOptions, EveryEffectHasATest) {
    std::vector<std::string> files;
    for (const auto& e : std::filesystem::recursive_directory_iterator(ALPENGLOW_SOURCE_DIR "/tests")) {
        const std::string name = e.path().filename().string();
        if (!e.is_regular_file() || name == "knownoptions_test.cpp" || name == "attributes_test.cpp") continue;
        const std::string kind = e.path().extension().string();
        if (kind != ".cpp" && kind != ".h" && kind != ".rsl" && kind != ".py") continue;
        std::ifstream in(e.path());
        files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    const auto word = [](const std::string& text, const std::string& name) {
        for (size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
            const auto letter = [&](size_t i) { return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])); };
            if ((at == 0 || !letter(at - 1)) && !letter(at + name.size())) return true;
        }
        return false;
    };
    for (auto table :
         {known::knownOptions(), known::knownAttributes(), known::knownHiderParameters(), known::knownDisplayParameters()})
        for (const OptionDescription& d : table) {
            if (d.effect != Effect::Used) continue;
            const size_t colon = d.name.find(':');
            const std::string category(colon == d.name.npos ? d.name : d.name.substr(0, colon)),
                name(colon == d.name.npos ? d.name : d.name.substr(colon + 1));
            EXPECT_TRUE(std::any_of(files.begin(), files.end(),
                                    [&](const std::string& text) { return word(text, name) && word(text, category); }))
                << d.name << " is in no test";
        }
}

// What attribute() and option() give of what is not set has the type of the name.
TEST(KnownOptions, AnswersHaveTheirType) {
    for (auto table : {known::knownOptions(), known::knownAttributes()})
        for (const OptionDescription& d : table)
            for (std::string_view text : {d.answer, d.answerUnderPath}) {
                if (text.empty()) continue;
                const known::PlainValue v = known::plainValue(text);
                const auto declared = parseDeclaration(d.type.empty() ? "float" : d.type);
                ASSERT_TRUE(declared) << d.name;
                const bool texts = declared->type == scene::Type::String;
                EXPECT_EQ(texts ? v.texts.size() : v.numbers.size(),
                          size_t(std::max(1, declared->arrayLength)) * size_t(scene::componentCount(declared->type)))
                    << d.name;
                if (!texts) EXPECT_TRUE(v.texts.empty()) << d.name;
            }
}

TEST(KnownOptions, PlainValues) {
    EXPECT_EQ(known::plainValue("[0 -1.5 2e3]").numbers, (std::vector<float>{0, -1.5f, 2000}));
    EXPECT_EQ(known::plainValue("\"a b\"").texts, std::vector<std::string>{"a b"});
    EXPECT_EQ(known::plainValue("\"\"").texts, std::vector<std::string>{""});
    EXPECT_TRUE(known::plainValue("").numbers.empty());
}

// What others say by Hider is said elsewhere here.
TEST(KnownOptions, HidersSayWhereSamplesAreSaid) {
    const auto samples = read("Hider \"path\" \"int samples\" 64\n")->only();
    EXPECT_EQ(samples.severity, Severity::Warning);
    EXPECT_NE(samples.hint.find("PixelSamples"), std::string::npos) << samples.hint;
    EXPECT_NE(read("Hider \"path\" \"int maxdepth\" 4\n")->only().hint.find("maxdepth"), std::string::npos);
}

TEST(KnownOptions, NamesForHints) {
    EXPECT_EQ(known::findKnown(known::knownOptions(), "trace:maxdepth")->type, "int");
    EXPECT_EQ(known::findKnown(known::knownOptions(), "trace:maxdpth"), nullptr);
    const auto categories = known::knownNames(known::knownAttributes(), "");
    EXPECT_NE(std::find(categories.begin(), categories.end(), "visibility"), categories.end());
    EXPECT_EQ(std::count(categories.begin(), categories.end(), "visibility"), 1);
    EXPECT_EQ(nearestName("maxdpth", known::knownNames(known::knownOptions(), "trace")), "maxdepth");
}

TEST(KnownOptions, AFurtherCallOfTheSameHiderKeepsItsParameters) {
    // Blender's exporters give "depthfilter" and "jitter" by two calls.
    const auto hider = [](const std::string& calls) {
        const auto c = read(calls + "\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
        return c->frame().options.hiderParams;
    };
    const auto both = hider("Hider \"hidden\" \"string depthfilter\" \"midpoint\"\nHider \"hidden\" \"int jitter\" 0");
    ASSERT_TRUE(scene::find(both, "depthfilter") && scene::find(both, "jitter"));
    EXPECT_EQ(scene::find(both, "depthfilter")->strings[0], "midpoint");
    EXPECT_EQ(scene::find(both, "jitter")->numbers[0], 0);
    const auto later =
        hider("Hider \"hidden\" \"string depthfilter\" \"midpoint\"\nHider \"hidden\" \"string depthfilter\" \"max\"");
    ASSERT_EQ(later.size(), 1u);
    EXPECT_EQ(later[0].strings[0], "max");
    EXPECT_FALSE(scene::find(hider("Hider \"hidden\" \"int jitter\" 0\nHider \"path\" \"int guide\" 0"), "jitter"));
}

} // namespace knownoptions_test

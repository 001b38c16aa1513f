// The tables of options, attributes and parameters: every sample is read without a message, and the tables and the code that
// looks names up agree, by the text of the sources.
#include "collect.h"
#include "scene/knownoptions.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <regex>

namespace knownoptions_test {

using namespace alpenglow;
using namespace alpenglow::ri;
using scene::Effect;
using scene::OptionDescription;

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
    for (const OptionDescription& d : scene::knownOptions()) {
        if (d.effect == Effect::Ignored || d.name == "ribparse:varsubst") continue; // that one is reported
        ASSERT_FALSE(d.sample.empty()) << d.name;
        auto c = read(request("Option", d) + "WorldBegin\nWorldEnd\n");
        EXPECT_EQ(c->messages(), "") << d.name;
        EXPECT_TRUE(c->frame().options.values.count(std::string(d.name))) << d.name;
    }
    for (const OptionDescription& d : scene::knownAttributes()) {
        if (d.effect == Effect::Ignored) continue;
        ASSERT_FALSE(d.sample.empty()) << d.name;
        auto c = world(request("Attribute", d) + "Sphere 1 -1 1 360");
        EXPECT_EQ(c->messages(), "") << d.name;
        EXPECT_NE(c->primitive().attributes->value(std::string(d.name)), nullptr) << d.name;
    }
    for (const OptionDescription& d : scene::knownHiderParameters())
        if (d.effect != Effect::Ignored)
            EXPECT_EQ(read("Hider \"hidden\" \"" + std::string(d.name) + "\" " + std::string(d.sample) + "\n")->messages(), "")
                << d.name;
    for (const OptionDescription& d : scene::knownDisplayParameters())
        if (d.effect != Effect::Ignored)
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
        EXPECT_TRUE(findKnown(scene::knownOptions(), n) || findKnown(scene::knownAttributes(), n))
            << n << " is read, but in no table";
}

TEST(KnownOptions, WhatIsCalledUsedIsRead) {
    const std::string text = sources();
    auto named = [&](std::string_view n) { return text.find("\"" + std::string(n) + "\"") != std::string::npos; };
    for (auto table : {scene::knownOptions(), scene::knownAttributes()})
        for (const OptionDescription& d : table) {
            if (d.effect != Effect::Used) continue;
            const bool composed = d.name.starts_with("searchpath:") || d.name.starts_with("visibility:"); // category, then name
            EXPECT_TRUE(named(d.name) || (composed && named(d.name.substr(d.name.find(':') + 1))))
                << d.name << " is read nowhere";
        }
    for (auto table : {scene::knownHiderParameters(), scene::knownDisplayParameters()})
        for (const OptionDescription& d : table)
            if (d.effect == Effect::Used) EXPECT_TRUE(named(d.name)) << d.name << " is read nowhere";
}

TEST(KnownOptions, NamesForHints) {
    EXPECT_EQ(scene::findKnown(scene::knownOptions(), "trace:maxdepth")->type, "int");
    EXPECT_EQ(scene::findKnown(scene::knownOptions(), "trace:maxdpth"), nullptr);
    const auto categories = scene::knownNames(scene::knownAttributes(), "");
    EXPECT_NE(std::find(categories.begin(), categories.end(), "visibility"), categories.end());
    EXPECT_EQ(std::count(categories.begin(), categories.end(), "visibility"), 1);
    EXPECT_EQ(nearestName("maxdpth", scene::knownNames(scene::knownOptions(), "trace")), "maxdepth");
}

} // namespace knownoptions_test

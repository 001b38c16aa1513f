// Mattes of whole renders: coverages of edges at known places, ids of known names, and what the header says (Cryptomatte
// specification 1.2).
#include "base/limits.h"
#include "command_folder.h"
#include "display/imageio.h"
#include "display/matte.h"
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace cryptomatte_test {

using namespace alpenglow;

namespace {

class Cryptomatte : public cli::testing::CommandFolder {
protected:
    /// Renders `scene` and reads the picture.
    display::Image picture(const std::string& scene, const std::string& file = "m.exr", const std::string& options = "") {
        write("s.rib", scene);
        run("render " + options + " s.rib", "2>messages");
        Diagnostics d;
        auto m = display::readImage((dir / file).string(), d);
        EXPECT_TRUE(m) << said();
        return m ? *m : display::Image();
    }
    std::string said() const {
        std::ifstream in(dir / "messages");
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

float valueAt(const display::Image& m, int x, int y, const std::string& channel) {
    const auto at = std::find(m.channels.begin(), m.channels.end(), channel);
    EXPECT_NE(at, m.channels.end()) << channel;
    return at == m.channels.end() ? NAN : m.pixel(x, y)[at - m.channels.begin()];
}

/// The coverage of a pixel by a name, over all ranks of a layer.
double coverage(const display::Image& m, int x, int y, const std::string& layer, const std::string& name) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        for (const char* pair : {"RG", "BA"}) {
            const std::string head = layer + "0" + std::to_string(k) + ".";
            if (std::bit_cast<uint32_t>(valueAt(m, x, y, head + pair[0])) == display::matteId(name))
                sum += double(valueAt(m, x, y, head + pair[1]));
        }
    return sum;
}

/// Four pixels by one over [0, 4] x [0, 1] of the screen, 4 x 4 samples in each, so that vertical edges at quarters of pixels
/// divide the samples exactly.
std::string frame(const std::string& display, const std::string& world, const std::string& filter = "\"box\" 1 1") {
    return "Format 4 1 1\nProjection \"orthographic\"\nScreenWindow 0 4 0 1\nPixelSamples 4 4\nPixelFilter " + filter + "\n" +
           display + "\nWorldBegin\n" + world + "WorldEnd\n";
}

/// A rectangle from x0 to x1, all over the picture's height, at that depth.
std::string slab(const std::string& name, const char* x0, const char* x1, const char* z = "1", const std::string& more = "") {
    const std::string a = x0, b = x1;
    return "AttributeBegin\nAttribute \"identifier\" \"string name\" [\"" + name + "\"]\n" + more + "Polygon \"P\" [" + a +
           " -1 " + z + " " + a + " 2 " + z + " " + b + " 2 " + z + " " + b + " -1 " + z + "]\nAttributeEnd\n";
}

const char* const kDisplay = "Display \"m.exr\" \"cryptomatte\" \"rgba\"";

} // namespace

// The values that the tests of Psyop's own Nuke plug-in have.
TEST(MatteId, IsThatOfTheSpecification) {
    const auto asFloat = [](const char* name) { return double(std::bit_cast<float>(display::matteId(name))); };
    EXPECT_NEAR(asFloat("hello"), 6.0705627102400005616e-17, 1e-23);
    EXPECT_NEAR(asFloat("cube"), -4.08461912519e+15, 1e9);
    EXPECT_NEAR(asFloat("sphere"), 2.79018604383e+15, 1e9);
    EXPECT_NEAR(asFloat("plane"), 3.66557617593e-11, 1e-17);
    EXPECT_NEAR(asFloat("m\u00e4dchen"), 6.2361298211599995797e+25, 1e20);
    // None is zero, denormal, infinite or no number.
    for (int i = 0; i < 5000; ++i) EXPECT_TRUE(std::isnormal(asFloat(std::to_string(i).c_str()))) << i;
}

TEST_F(Cryptomatte, EdgesCoverWhatTheyCover) {
    for (const char* hider : {"hidden", "path"}) {
        const display::Image m = picture(std::string("Hider \"") + hider + "\"\n" +
                                         frame(kDisplay, slab("left", "-1", "1.25") + slab("right", "1.25", "2.75")));
        EXPECT_EQ(coverage(m, 0, 0, "CryptoObject", "left"), 1) << hider;
        EXPECT_EQ(coverage(m, 1, 0, "CryptoObject", "left"), .25) << hider;
        EXPECT_EQ(coverage(m, 1, 0, "CryptoObject", "right"), .75) << hider;
        EXPECT_EQ(coverage(m, 2, 0, "CryptoObject", "right"), .75) << hider;
        EXPECT_EQ(coverage(m, 2, 0, "CryptoObject", "left"), 0) << hider;
        EXPECT_EQ(coverage(m, 3, 0, "CryptoObject", "right"), 0) << hider;
        // The larger coverage comes first.
        EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 1, 0, "CryptoObject00.R")), display::matteId("right")) << hider;
        EXPECT_EQ(valueAt(m, 1, 0, "CryptoObject00.G"), .75f) << hider;
        EXPECT_EQ(valueAt(m, 1, 0, "CryptoObject00.A"), .25f) << hider;
        EXPECT_EQ(valueAt(m, 3, 0, "CryptoObject00.R"), 0) << hider;
    }
}

// What a surface of opacity a hides: a of what is behind it; that has the rest.
TEST_F(Cryptomatte, TransparencyIsShared) {
    const display::Image m =
        picture(frame(kDisplay, slab("pane", "-1", "5", "1", "Opacity [.25 .25 .25]\n") + slab("wall", "-1", "5", "2")));
    EXPECT_NEAR(coverage(m, 1, 0, "CryptoObject", "pane"), .25, 1e-6);
    EXPECT_NEAR(coverage(m, 1, 0, "CryptoObject", "wall"), .75, 1e-6);
}

// A triangle filter of full width 2 about the middle of pixel 1, at x = 1.5, has weights 1 - |x - 1.5|: left of x = 1.25 lie
// 1/2 * 3/4 * 3/4 of 1 in the limit; with 4 columns of samples in a pixel, jittered, half of a cell's slope is the most that it
// errs.
TEST_F(Cryptomatte, WeightsAreThoseOfTheFilter) {
    const display::Image m =
        picture("Hider \"hidden\" \"int jitter\" 0\n" +
                frame(kDisplay, slab("left", "-1", "1.25") + slab("right", "1.25", "5"), "\"triangle\" 2 1"));
    // Samples without jitter lie at .5 + k + (i + .5) / 4: their distances from 1.5 are odd eighths.
    double left = 0, all = 0;
    for (int i = 0; i < 8; ++i) {
        const double x = .5 + (i + .5) / 4, w = 1 - std::fabs(x - 1.5);
        all += w;
        if (x < 1.25) left += w;
    }
    EXPECT_NEAR(coverage(m, 1, 0, "CryptoObject", "left"), left / all, 1e-5);
    EXPECT_NEAR(coverage(m, 1, 0, "CryptoObject", "right"), 1 - left / all, 1e-5);
}

TEST_F(Cryptomatte, HeaderHasNamesAndManifest) {
    const display::Image m = picture(frame(kDisplay, slab("say \\\"a\\\"\\\\", "-1", "1") + slab("b", "1", "2")));
    const auto text = [&](const std::string& key) {
        const auto at = m.metadata.find(key);
        return at == m.metadata.end() ? "none" : at->second;
    };
    std::string head;
    for (const auto& [key, value] : m.metadata)
        if (key.starts_with("cryptomatte/") && key.ends_with("/name")) head = key.substr(0, key.size() - 4);
    ASSERT_EQ(head.size(), std::string("cryptomatte/1234567/").size());
    EXPECT_EQ(text(head + "name"), "CryptoObject");
    EXPECT_EQ(text(head + "hash"), "MurmurHash3_32");
    EXPECT_EQ(text(head + "conversion"), "uint32_to_float32");
    const auto manifest = nlohmann::json::parse(text(head + "manifest"));
    EXPECT_EQ(manifest.size(), 2u);
    for (const char* name : {"say \"a\"\\", "b"}) {
        char hex[9];
        std::snprintf(hex, sizeof hex, "%08x", display::matteId(name));
        EXPECT_EQ(manifest.value(name, ""), hex) << name;
    }
    EXPECT_EQ(coverage(m, 1, 0, "CryptoObject", "b"), 1);
}

// PRMan's form; materials by the handle of their Bxdf, or their shader's name; several layers in a file.
TEST_F(Cryptomatte, SampleFilterWritesAPictureOfItsOwn) {
    const std::string filter = "SampleFilter \"PxrCryptomatte\" \"c\" \"string filename\" [\"c.exr\"] \"string[2] layer\" "
                               "[\"identifier:name\" \"material\"] \"int levels\" 2\nDisplay \"p.exr\" \"openexr\" \"rgba\"";
    const display::Image m =
        picture("Hider \"path\"\n" + frame(filter, slab("a", "-1", "2", "1", "Bxdf \"PxrConstant\" \"glow\"\n") +
                                                       slab("b", "2", "5", "1", "Surface \"constant\"\n")),
                "c.exr");
    EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 0, 0, "CryptoObject00.R")), display::matteId("a"));
    EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 0, 0, "CryptoMaterial00.R")), display::matteId("glow"));
    EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 3, 0, "CryptoMaterial00.R")), display::matteId("constant"));
    EXPECT_EQ(m.channels.size(), 4u + 2 * 4);
    EXPECT_TRUE(std::filesystem::exists(dir / "p.exr"));
    EXPECT_EQ(said().find("warning"), std::string::npos) << said();
}

// The same bits for any number of threads.
TEST_F(Cryptomatte, ThreadsChangeNothing) {
    std::string world;
    for (int i = 0; i < 8; ++i)
        world += slab("s" + std::to_string(i % 3), std::to_string(i * .45).c_str(), std::to_string(i * .45 + .5).c_str(),
                      std::to_string(1 + i % 4).c_str(), "Opacity [.5 .6 .7]\nRotate 20 0 0 1\n");
    std::string scene = frame(kDisplay, world, "\"gaussian\" 2 2");
    scene.replace(0, scene.find('\n'), "Format 64 40 1");
    const display::Image one = picture(scene, "m.exr", "--threads 1"), four = picture(scene, "m.exr", "--threads 4");
    ASSERT_EQ(one.data.size(), four.data.size());
    for (size_t i = 0; i < one.data.size(); ++i)
        ASSERT_EQ(std::bit_cast<uint32_t>(one.data[i]), std::bit_cast<uint32_t>(four.data[i])) << i;
}

TEST_F(Cryptomatte, LayersAndLevelsAreBounded) {
    std::string layers;
    for (size_t i = 0; i <= limits::kMatteLayers; ++i) layers += "\"user:a" + std::to_string(i) + "\" ";
    const display::Image m =
        picture(frame("Display \"m.exr\" \"cryptomatte\" \"rgba\" \"string[" + std::to_string(limits::kMatteLayers + 1) +
                          "] layer\" [" + layers + "] \"int levels\" " + std::to_string(limits::kMatteRanks / 4),
                      slab("a", "-1", "5")));
    EXPECT_NE(said().find("there are more than 8 layers"), std::string::npos) << said();
    EXPECT_EQ(said().find("levels\" must"), std::string::npos) << said();
    EXPECT_EQ(m.channels.size(), 4 + limits::kMatteLayers * 2 * size_t(limits::kMatteRanks / 4));
    EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 1, 0, "Crypto_user_a000.R")),
              display::matteId("default")); // it has no such attribute
    const auto most = [&](int levels) {
        return picture(frame("Display \"m.exr\" \"cryptomatte\" \"rgba\" \"int levels\" " + std::to_string(levels),
                             slab("a", "-1", "5")))
            .channels.size();
    };
    EXPECT_EQ(most(limits::kMatteRanks), 4 + 2 * size_t(limits::kMatteRanks));
    EXPECT_EQ(most(limits::kMatteRanks + 1), 4u + 2 * 6); // those by default
}

TEST_F(Cryptomatte, MoreChannelsThanAPictureHasAreAnError) {
    std::string layers;
    for (size_t i = 0; i < limits::kMatteLayers; ++i) layers += "\"user:a" + std::to_string(i) + "\" ";
    const display::Image m =
        picture(frame("Display \"m.exr\" \"cryptomatte\" \"rgba\" \"string[" + std::to_string(limits::kMatteLayers) +
                          "] layer\" [" + layers + "] \"int levels\" " + std::to_string(limits::kMatteRanks),
                      slab("a", "-1", "5")));
    EXPECT_NE(status, 0);
    EXPECT_NE(
        said().find("4 channels of the picture and 8 layers of 64 levels are more than 1024 channels; 62 levels are written"),
        std::string::npos)
        << said();
    EXPECT_NE(said().find("fewer \"levels\""), std::string::npos) << said();
    EXPECT_EQ(m.channels.size(), 4u + 8 * 2 * 62);
    EXPECT_EQ(std::bit_cast<uint32_t>(valueAt(m, 1, 0, "Crypto_user_a730.R")), 0u);
}

TEST_F(Cryptomatte, BadParametersAreSaid) {
    picture(
        frame("Display \"m.exr\" \"cryptomatte\" \"rgba\" \"string layer\" \"name\" \"int levels\" 1000", slab("a", "-1", "5")));
    EXPECT_NE(said().find("layer \"name\" is neither"), std::string::npos) << said();
    EXPECT_NE(said().find("\"levels\" must be in 1 to 64"), std::string::npos) << said();
    EXPECT_NE(status, 0);
    write("s.rib", frame("SampleFilter \"PxrCryptomatte\" \"c\"", slab("a", "-1", "5")));
    run("render s.rib", "2>messages");
    EXPECT_NE(said().find("PxrCryptomatte has no file"), std::string::npos) << said();
}

} // namespace cryptomatte_test

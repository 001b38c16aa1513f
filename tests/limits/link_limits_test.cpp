// Links that came with a scene lead nowhere that its files may not be read from.
#include "base/file.h"
#include "cli/command_folder.h"

namespace link_limits_test {

namespace fs = std::filesystem;
using namespace alpenglow;

class LinkLimits : public cli::testing::CommandFolder {
protected:
    void SetUp() override {
        CommandFolder::SetUp();
        top_ = dir;
        fs::create_directories(dir / "out");
        fs::create_directories(dir / "a/scene/sub");
        write("out/secret", "rootpassword hashed\n");
        write("out/far.rib", "Sphere 1 -1 1 360\n");
        write("out/part.sl", "surface part() { Ci = .5; }\n");
        dir = dir / "a/scene";
    }
    void TearDown() override {
        dir = top_;
        CommandFolder::TearDown();
    }
    void link(const std::string& to, const std::string& name) const { fs::create_symlink(to, dir / name); }
    std::string render(const std::string& world, const std::string& options = "") {
        write("s.rib", "Format 8 8 1\nProjection \"perspective\"\nWorldBegin\nTranslate 0 0 3\n" + world + "\nWorldEnd\n");
        return run("render -q -o s.png " + options + " s.rib", "2>&1");
    }
    void hides(const std::string& said, const std::string& why) const {
        EXPECT_EQ(status, 1) << said;
        EXPECT_NE(said.find(why), std::string::npos) << said;
        EXPECT_EQ(said.find("rootpassword"), std::string::npos) << said;
        EXPECT_EQ(said.find("hashed"), std::string::npos) << said;
    }
    fs::path top_;
};

TEST_F(LinkLimits, Archives) {
    const std::string secret = (top_ / "out/secret").string();
    link(secret, "env.rib");
    link("../../../out", "sub/out");
    link("../../out/far.rib", "far.rib");
    for (const char* name : {"env.rib", "./env.rib", "ENV.rib", "far.rib", "sub/out/far.rib", "sub/out/secret"})
        hides(render("ReadArchive \"" + std::string(name) + "\""), "outside");
    EXPECT_NE(render("ReadArchive \"env.rib\"").find("leads by a link to \"" + secret + "\""), std::string::npos);
    // A folder that the scene names is for RIB: the name of the link does not make a file RIB.
    const std::string search = "Option \"searchpath\" \"archive\" [\"" + (top_ / "out").string() + "\"]\n";
    hides(render(search + "ReadArchive \"env.rib\""), "outside");
    render(search + "ReadArchive \"far.rib\"");
    EXPECT_EQ(status, 0);
    // Who allows it says so.
    for (const std::string& allowed : {std::string("--allow-read"), "--searchpath " + (top_ / "out").string()}) {
        const std::string said = render("ReadArchive \"far.rib\"", allowed);
        EXPECT_EQ(status, 0) << said;
    }
    // A link between folders that may be read is followed.
    write("sub/near.rib", "Sphere 1 -1 1 360\n");
    link("sub/near.rib", "near.rib");
    link("scene", "../again");
    for (const char* name : {"near.rib", "../again/near.rib"}) {
        const std::string said = render("ReadArchive \"" + std::string(name) + "\"");
        EXPECT_EQ(status, 0) << said;
    }
}

TEST_F(LinkLimits, Maps) {
    write("../../out/p.rib", "Format 4 4 1\nDisplay \"paint.tif\" \"tiff\" \"rgb\"\nWorldBegin\nWorldEnd\n");
    run("render -q --allow-write -o ../../out/paint.tif ../../out/p.rib", "2>&1");
    ASSERT_EQ(status, 0);
    link("../../out/paint.tif", "paint.tif");
    write("t.sl", "surface t(string name = \"\") { Ci = texture(name); }\n");
    const std::string ball = "Surface \"t\" \"name\" \"paint.tif\" Sphere 1 -1 1 360";
    hides(render(ball), "outside");
    const std::string said = render(ball, "--allow-read");
    EXPECT_EQ(status, 0) << said;
    // The depth map of a repelling plane is a map, too.
    const std::string blob = "Blobby 2 [1001 0 1003 0 16 0 2 0 1] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 1 1 1] [\"NAME\"]";
    for (const std::string& name : {std::string("paint.tif"), (top_ / "out/secret").string()}) {
        std::string of = blob;
        of.replace(of.find("NAME"), 4, name);
        hides(render(of), "outside");
    }
}

TEST_F(LinkLimits, ShadersAndWhatTheyInclude) {
    link("../../out/secret", "env.sl");
    link("../../out/secret", "env.h");
    link("../../out/part.sl", "part.sl"); // what is named as RSL is meant to be read
    write("inc.sl", "#include \"env.h\"\nsurface inc() { Ci = 1; }\n");
    hides(render("Surface \"env\" Sphere 1 -1 1 360"), "not named as a shader's source");
    hides(render("Surface \"inc\" Sphere 1 -1 1 360"), "not read");
    const std::string said = render("Surface \"part\" Sphere 1 -1 1 360");
    EXPECT_EQ(status, 0) << said;
    // Not even for what it declares.
    write("../../out/secret", "rootpassword\nsurface hidden() { Ci = 1; }\n");
    hides(render("Surface \"hidden\" Sphere 1 -1 1 360"), "not found");
}

TEST_F(LinkLimits, WhatLiesBelow) {
    link("../../out", "link");
    const std::string here = dir.string(), out = (top_ / "out").string();
    EXPECT_TRUE(liesBelow(here + "/sub/new", {here}));
    EXPECT_FALSE(liesBelow(here + "/link/far.rib", {here}));
    EXPECT_FALSE(liesBelow(here + "/link/new", {here}));
    EXPECT_FALSE(liesBelow(here + "/sub/../../other", {here}));
    EXPECT_TRUE(liesBelow(here + "/link/far.rib", {here, out}));
    EXPECT_TRUE(liesBelow(out + "/far.rib", {here + "/link"}));
    EXPECT_FALSE(liesBelow(out + "side/far.rib", {out}));
}

} // namespace link_limits_test

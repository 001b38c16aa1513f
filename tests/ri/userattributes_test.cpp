// Attribute "user" and Option "user" in the graphics state; tests/services/userattributes_test.cpp has the shaders.
#include "collect.h"

namespace userattributes_test {

using namespace alpenglow;
using namespace alpenglow::ri;

// Attribute "user" goes the way of all attributes: blocks, archives, procedurals, motion, Resource.
TEST(UserAttributes, FollowTheBlocks) {
    auto c =
        read("Option \"user\" \"float[2] x\" [1 2]\nAttribute \"user\" \"float x\" 1 \"color[2] c\" [1 2 3 4 5 6]\n"
             "ArchiveBegin \"a\"\nAttribute \"user\" \"string s\" \"a\"\nIfBegin \"$user:x == 2 && $Option:user:x == 1\"\n"
             "Sphere 1 -1 1 360\nIfEnd\nArchiveEnd\n"
             "WorldBegin\nAttributeBegin\nAttribute \"user\" \"float x\" 2\nReadArchive \"a\"\n"
             "Resource \"r\" \"attributes\" \"string operation\" \"save\"\nAttributeEnd\n"
             "MotionBegin [0 1]\nSphere 2 -2 2 360\nSphere 3 -3 3 360\nMotionEnd\n"
             "AttributeBegin\nResource \"r\" \"attributes\" \"string operation\" \"restore\"\nSphere 4 -4 4 360\nAttributeEnd\n"
             "AttributeBegin\nAttribute \"user\" \"float x\" 5\n"
             "Procedural \"DelayedReadArchive\" [\"b\"] [-1 1 -1 1 -1 1]\nAttributeEnd\nWorldEnd\n");
    EXPECT_EQ(c->diagnostics.errors(), int(c->count())) << c->messages(); // there is no file b
    ASSERT_EQ(c->frame().primitives.size(), 3u);
    const auto of = [&](size_t i, const char* name) { return c->primitive(i).attributes->value(name); };
    EXPECT_EQ(of(0, "user:x")->numbers, std::vector<float>{2});
    EXPECT_EQ(of(0, "user:s")->strings, std::vector<std::string>{"a"});
    EXPECT_EQ(of(0, "user:c")->numbers, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(of(1, "user:x")->numbers, std::vector<float>{1}); // the motion block, behind AttributeEnd
    EXPECT_EQ(of(1, "user:s"), nullptr);
    EXPECT_EQ(of(2, "user:s")->strings, std::vector<std::string>{"a"});
    EXPECT_EQ(c->frame().options.values.at("user:x").numbers, (std::vector<float>{1, 2}));
    // It has no samples of its own.
    auto moving = inWorld("MotionBegin [0 1]\nAttribute \"user\" \"float x\" 1\nTranslate 1 0 0\nTranslate 2 0 0\nMotionEnd\n");
    EXPECT_EQ(moving->only().code, Rie::BadMotion);
}

// Option "ribparse" "varsubst" (PRMan): what RenderMan for Maya and for Blender write.
TEST(VariablesInTexts, StandForWhatConditionsHave) {
    setenv("ALPENGLOW_TEST_FOLDER", "/proj", 1);
    const std::string head = "Option \"ribparse\" \"string varsubst\" [\"$\"]\nOption \"user\" \"string look\" [\"matte\"]\n"
                             "Option \"user\" \"float k\" 2.5\n";
    const auto c = read(head + "FrameBegin 7\nDisplay \"${ALPENGLOW_TEST_FOLDER}/a.${Frame}.$user:k.tif\" \"file\" \"rgb\"\n"
                               "WorldBegin\nAttribute \"user\" \"string map\" \"w.tx\"\nSurface \"$look\" \"string file\" "
                               "\"$map:${map}\"\nSphere 1 -1 1 360\nWorldEnd\nFrameEnd\n");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().options.displays.size(), 1u);
    EXPECT_EQ(c->frame().options.displays[0].name, "/proj/a.7.2.5.tif");
    const auto& surface = c->primitive().attributes->surface;
    EXPECT_EQ(surface->name, "matte");
    ASSERT_EQ(surface->params.size(), 1u);
    EXPECT_EQ(surface->params[0].strings[0], "w.tx:w.tx");
}

// ricpp has it in another category, with the same meaning; the later of both holds.
TEST(VariablesInTexts, HaveASecondName) {
    const std::string user = "Option \"user\" \"string look\" [\"matte\"]\n", world = "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n";
    const auto c = read("Option \"rib\" \"string varsubst\" \"$\"\n" + user + "Surface \"${look}\"\n" + world);
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->primitive().attributes->surface->name, "matte");
    const auto off =
        read("Option \"rib\" \"varsubst\" \"$\"\n" + user + "Option \"ribparse\" \"varsubst\" \"\"\nSurface \"$look\"\n" + world);
    EXPECT_EQ(off->primitive().attributes->surface->name, "$look");
}

TEST(VariablesInTexts, StayWhereNothingIsSet) {
    const auto c = read("Option \"ribparse\" \"string varsubst\" [\"$\"]\nDisplay \"${none}$none.$5 $ ${} ${a.tif\" \"file\" "
                        "\"rgb\"\nWorldBegin\nWorldEnd\n");
    EXPECT_EQ(c->frame().options.displays.at(0).name, "${none}$none.$5 $ ${} ${a.tif");
    EXPECT_NE(c->first().message.find("$none is not set"), std::string::npos);
    EXPECT_EQ(c->diagnostics.errors(), 0);
    // Not asked for, or no more: texts stay as they are, silently. What an archive stores gets them when it is read.
    EXPECT_EQ(read("Display \"$HOME.tif\" \"file\" \"rgb\"\nWorldBegin\nWorldEnd\n")->frame().options.displays.at(0).name,
              "$HOME.tif");
    const auto later = read("Option \"ribparse\" \"string varsubst\" \"@\"\nOption \"user\" \"string s\" \"one\"\n"
                            "ArchiveBegin \"x\"\nSurface \"@{s}\"\nArchiveEnd\nOption \"user\" \"string s\" \"two\"\nWorldBegin\n"
                            "ReadArchive \"x\"\nSphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_EQ(later->messages(), "");
    EXPECT_EQ(later->primitive().attributes->surface->name, "two");
}

// A name without a class is one of the user's or of the environment: RenderMan for Maya asks whether its folders are set.
TEST(VariablesInTexts, ConditionsKnowTheEnvironment) {
    setenv("ALPENGLOW_TEST_FOLDER", "/proj", 1);
    const auto frame = [](const std::string& condition) {
        const auto c = read("Option \"user\" \"float deep\" 3\nWorldBegin\nIfBegin \"" + condition +
                            "\"\nSphere 1 -1 1 360\nIfEnd\nWorldEnd\n");
        EXPECT_EQ(c->messages(), "");
        return c->frame().primitives.size();
    };
    EXPECT_EQ(frame("defined(ALPENGLOW_TEST_FOLDER)"), 1u);
    EXPECT_EQ(frame("!defined(ALPENGLOW_TEST_NO_FOLDER)"), 1u);
    EXPECT_EQ(frame("$ALPENGLOW_TEST_FOLDER == '/proj'"), 1u);
    EXPECT_EQ(frame("$deep > 2"), 1u);
}

} // namespace userattributes_test

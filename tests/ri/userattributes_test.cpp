// Attribute "user" and Option "user" in the graphics state; tests/integrator/userattributes_test.cpp has the shaders.
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

} // namespace userattributes_test

// Divisions by parameters that the scene has set to 0.
#include "integrator/floorscene.h"

namespace zerodivisors_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// x / 0 is 0, and the message names the place in the shader, the parameter and the request that set it. Nothing is said where
// a condition on parameters keeps the division from running, or where the default is what counts and is not 0.
TEST(ZeroDivisors, AreSaidAtTheDivision) {
    writeShader("divides", "surface divides(float k = 1, on = 1; color tint = 1;) { Oi = 1;\n"
                           "    Ci = .25 + (on > 0 ? Cs / k : color(.5)) +\n"
                           "        color(.125) / tint; }\n");
    struct Case {
        const char* given;
        Color want;
        const char* said;
    };
    for (const Case& c : {Case{"", Color(1.375f), ""},
                          {"\"k\" 2", Color(.875f), ""},
                          {"\"k\" 0", Color(.375f), "divides.sl:2:29: warning: a division by 0, which gives 0: \"k\" is 0 at "},
                          {"\"k\" 0 \"on\" 0", Color(.875f), ""},
                          {"\"tint\" [1 0 .5]",
                           {1.375f, 1.25f, 1.5f},
                           "divides.sl:3:21: warning: a division by 0, which gives 0: \"tint\" is 0 at "}})
        for (const Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(inWorld("Surface \"divides\" " + std::string(c.given) + "\n" + kFloor), withShaders(h));
            const Moments m = s.estimate(kView, 4);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(float(m.mean(k)), c.want[k]) << c.given << int(h);
            if (*c.said) EXPECT_NE(s.messages().find(c.said), std::string::npos) << s.messages();
            else EXPECT_EQ(s.messages(), "") << c.given;
        }
}

} // namespace

} // namespace zerodivisors_test

// Kernels that need only the side of the geometric normal.
#include "compile.h"
#include "rsl/front/protocol.h"
#include <algorithm>

namespace normal_side_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

static bool reads(const std::string& body, const std::string& input) {
    const Compiled c = compile("surface s(float Kd = .5; normal n = 0;) { " + body + " }");
    return c.kernel &&
           std::any_of(c.kernel->inputs.begin(), c.kernel->inputs.end(), [&](const auto& i) { return i.name == input; });
}

TEST(NormalSide, SignsNeedNoLength) {
    for (const char* body :
         {"Ci = diffuse(faceforward(normalize(N), I));", "Ci = (I . Ng < 0) ? 1 : Kd;",
          "Ci = (2 * (Ng . I) - Ng . P <= 0) ? Cs : Os;",
          "normal m = faceforward(n, -I); Ci = diffuse(m) + specular(faceforward(N, I), -normalize(I), .1);"}) {
        EXPECT_TRUE(reads(body, kSideNormal)) << body;
        EXPECT_FALSE(reads(body, "Ng")) << body;
    }
}

TEST(NormalSide, LengthsAndSumsWithOthersDo) {
    for (const char* body :
         {"Ci = diffuse(normalize(Ng));", "Ci = length(Ng);", "Ci = (I . Ng < .5) ? 1 : Kd;", "Ci = (I . (Ng + N) < 0) ? 1 : Kd;",
          "Ci = (Ng . Ng - 1 < 0) ? 1 : Kd;", "Ci = (I . Ng) * diffuse(N);", "Ci = (Du(I . Ng) < 0) ? 1 : Kd;",
          "normal m = Ng; if (Kd > .3) m = N; Ci = (I . m < 0) ? 1 : Kd;"}) {
        EXPECT_TRUE(reads(body, "Ng")) << body;
        EXPECT_FALSE(reads(body, kSideNormal)) << body;
    }
}

} // namespace normal_side_test

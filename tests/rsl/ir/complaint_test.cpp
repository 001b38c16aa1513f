// Messages that wait in a kernel until the shader runs.
#include "rsl/ir/complaint.h"
#include <gtest/gtest.h>

namespace alpenglow::rsl::ir::complaint_test {

using Strings = std::vector<std::string>;

TEST(Complaints, HoldTheTextAndTheId) {
    const Site s = complaint(msg::kShadersRoom(3));
    EXPECT_EQ(s.strings, (Strings{"more shaders than the array has room for: getshaders() gives the first 3"}));
    EXPECT_EQ(s.names, (Strings{"id"}));
    EXPECT_EQ(s.pairStrings, (Strings{"array-room"}));
}

TEST(Complaints, LeaveAPlaceForWhatIsKnownOnlyThen) {
    const Site s = complaint(msg::kNoSuchParameterOfType("bsdf", kWhenRun));
    EXPECT_EQ(s.strings, (Strings{"'bsdf' has no parameter of this type with the name \"", "", "\"; it is ignored"}));
    EXPECT_EQ(s.pairStrings, (Strings{"no-such-parameter"}));
}

} // namespace alpenglow::rsl::ir::complaint_test

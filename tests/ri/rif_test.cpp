// Filters in C++ (include/RifPlugin.h): every member is in one of the lists of the files that define the functions of ri.h.
#include "ri/c/rif.h"
#include <gtest/gtest.h>

namespace rif_test {

TEST(Rif, EveryMemberReceivesItsRequest) { EXPECT_TRUE(alpenglow::ri::rifComplete()); }

} // namespace rif_test

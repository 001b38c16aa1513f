// In every test program: neither it nor a program that it starts reads the .alpenglowrc of who runs it.
#include <cstdlib>

namespace alpenglow {

[[maybe_unused]] static const int kNoUserFile = setenv("ALPENGLOW_RC", "off", 1);

} // namespace alpenglow

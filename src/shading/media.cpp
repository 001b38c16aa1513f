// The volumes that a ray is in.
#include "base/limits.h"
#include "shading/point.h"
#include <algorithm>

namespace alpenglow::shading {

void Media::push(int medium) {
    if (count == limits::kMedia) {
        std::copy(in + 1, in + count--, in);
        lost = true;
    }
    in[count++] = int16_t(medium);
}

void Media::leave(int medium) {
    for (int i = count; i-- > 0;)
        if (in[i] == medium) {
            std::copy(in + i + 1, in + count--, in + i);
            return;
        }
}

} // namespace alpenglow::shading

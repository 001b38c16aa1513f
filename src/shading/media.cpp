// The volumes that a ray is in.
#include "base/limits.h"
#include "shading/point.h"
#include <algorithm>

#include "base/exact.h"

namespace alpenglow::shading {

Vec3d FreeFlight::transmittanceAt(float at) const {
    Vec3d l(exact::exp(-double(extinction.x) * at));
    if (extinction.y != extinction.x) l.y = exact::exp(-double(extinction.y) * at);
    if (extinction.z != extinction.x) l.z = exact::exp(-double(extinction.z) * at);
    return l;
}

double FreeFlight::density(const Vec3d& left) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        if (chance[k] > 0) sum += chance[k] * left[k];
    return sum;
}

void Media::push(int medium, float rank) {
    if (count == limits::kMedia) {
        std::copy(priority + 1, priority + count, priority);
        std::copy(in + 1, in + count--, in);
        lost = true;
    }
    int at = count++;
    for (; at > 0 && priority[at - 1] > rank; --at) {
        in[at] = in[at - 1];
        priority[at] = priority[at - 1];
    }
    in[at] = int16_t(medium);
    priority[at] = rank;
}

void Media::leave(int medium) {
    for (int i = count; i-- > 0;)
        if (in[i] == medium) {
            std::copy(priority + i + 1, priority + count, priority + i);
            std::copy(in + i + 1, in + count--, in + i);
            return;
        }
}

} // namespace alpenglow::shading

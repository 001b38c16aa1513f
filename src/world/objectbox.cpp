#include "world/objectbox.h"
#include "scene/primitivekinds.h"

namespace alpenglow::world {
namespace {

void addOf(const scene::Primitive& p, scene::ObjectBox& box) {
    if (const scene::PrimitiveKind* kind = scene::primitiveKind(p.kind); kind && kind->box) kind->box(p.numbers, box);
    if (const scene::Param* points = scene::find(p.params, "P"))
        for (size_t i = 0; i + 2 < points->numbers.size(); i += 3)
            box.add(points->numbers[i], points->numbers[i + 1], points->numbers[i + 2]);
    if (const scene::Param* points = scene::find(p.params, "Pw"))
        for (size_t i = 0; i + 3 < points->numbers.size(); i += 4) {
            const float w = points->numbers[i + 3];
            box.add(points->numbers[i] / w, points->numbers[i + 1] / w, points->numbers[i + 2] / w);
        }
}

} // namespace

std::optional<std::array<float, 6>> objectBox(const scene::Primitive& p) {
    scene::ObjectBox box;
    addOf(p, box);
    for (const auto& key : p.motionKeys) addOf(*key, box);
    if (!box.any) return std::nullopt;
    return box.b;
}

} // namespace alpenglow::world

#include "rsl/passes/localmemory.h"
#include "base/limits.h"
#include "rsl/ir/edit.h"
#include "rsl/messages/messages.h"
#include <algorithm>

namespace alpenglow::rsl::passes {
namespace {

// A value and its derivative parts: 1, 3 or 6 floats a component.
size_t bytesOf(const Inst* array) {
    const size_t parts = array->order == 0 ? 1 : array->order == 1 ? 3 : 6;
    return static_cast<size_t>(std::max(1, array->index)) * static_cast<size_t>(components(array->element)) * parts *
           sizeof(float);
}

} // namespace

size_t localArrayBytes(const Kernel& k) {
    size_t bytes = 0;
    forEach(k.body, [&](const Inst* i) { bytes += i->op == Op::ArrayNew ? bytesOf(i) : 0; });
    return bytes;
}

void checkLocalMemory(const Kernel& k, Diagnostics& diagnostics) {
    const size_t bytes = localArrayBytes(k);
    if (bytes <= limits::kShaderMemory) return;
    const Inst* largest = nullptr;
    forEach(k.body, [&](const Inst* i) {
        if (i->op == Op::ArrayNew && (!largest || bytesOf(i) > bytesOf(largest))) largest = i;
    });
    const Place& at = largest->place;
    const bool known = at.file >= 0 && static_cast<size_t>(at.file) < k.files.size();
    diagnostics.report(diagnostic(msg::kShaderMemory(k.name, bytes, limits::kShaderMemory), Rie::Limit,
                                  {known ? k.files[static_cast<size_t>(at.file)] : "", at.line, at.column}));
}

} // namespace alpenglow::rsl::passes

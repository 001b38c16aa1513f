#include "ri/c/sketch.h"
#include "base/limits.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {

namespace {

constexpr std::pair<std::string_view, std::string_view> kBlocks[] = {
    {"FrameBegin", "FrameEnd"},         {"WorldBegin", "WorldEnd"},
    {"AttributeBegin", "AttributeEnd"}, {"TransformBegin", "TransformEnd"},
    {"SolidBegin", "SolidEnd"},         {"ObjectBegin", "ObjectEnd"},
    {"MotionBegin", "MotionEnd"},       {"ResourceBegin", "ResourceEnd"},
    {"ArchiveBegin", "ArchiveEnd"},     {"IfBegin", "IfEnd"}};

/// Blocks whose end restores the attributes of their beginning.
bool keepsAttributes(std::string_view begin) {
    return begin != "TransformBegin" && begin != "MotionBegin" && begin != "ResourceBegin" && begin != "IfBegin";
}

} // namespace

Sketch::Sketch() : attributes(std::make_shared<scene::Attributes>()) {}
Sketch::Sketch(Declarations d, int samples, scene::AttributesRef a)
    : declarations(std::move(d)), colorSamples(samples), attributes(std::move(a)) {}

void Sketch::basis(const Call& call) {
    auto a = std::make_shared<scene::Attributes>(*attributes);
    a->ubasis.step = call.integer(1);
    a->vbasis.step = call.integer(3);
    attributes = std::move(a);
}

std::string Sketch::end(std::string_view begin) {
    const auto of = std::find_if(blocks_.rbegin(), blocks_.rend(), [&](const Block& b) { return b.begin == begin; });
    if (of == blocks_.rend()) return fmt::format("there is no {} before it", begin);
    std::string why;
    if (of != blocks_.rbegin()) why = fmt::format("it comes before the {} in it is closed", blocks_.back().begin);
    if (keepsAttributes(begin)) attributes = of->attributes;
    if (begin == "FrameBegin" || begin == "WorldBegin") colorSamples = of->colorSamples;
    blocks_.erase(of.base() - 1, blocks_.end());
    return why;
}

std::string Sketch::note(const Call& call) {
    const std::string_view name = call.request->name;
    if (name == "Declare") {
        if (const auto d = parseDeclaration(call.text(1))) declarations.declare(call.text(0), *d);
    } else if (name == "ColorSamples") {
        const size_t n = call.numbers(0).size() / 3;
        if (n > 0) colorSamples = int(n);
    } else if (name == "Basis") {
        basis(call);
    } else if (call.request->kind == Kind::Structure || call.request->kind == Kind::Archive) {
        for (const auto& [begin, last] : kBlocks) {
            if (name == last) return end(begin);
            if (name == begin && blocks_.size() < std::size(kBlocks) * size_t(limits::kStackDepth))
                blocks_.push_back({begin, attributes, colorSamples});
        }
        if ((name == "Else" || name == "ElseIf") && open() != "IfBegin") return "there is no IfBegin before it";
    }
    return {};
}

} // namespace alpenglow::ri

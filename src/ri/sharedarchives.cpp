// A DelayedReadArchive of shapes alone that is read again under the same attributes is an instance of what was read.
#include "ri/interpreter.h"
#include "scene/primitivekinds.h"
#include "scene/scene.h"
#include <algorithm>
#include <iterator>
#include <string_view>

namespace alpenglow::ri {

namespace {

/// Requests that place shapes, and depend on nothing outside of an object.
constexpr std::string_view kPlacingRequests[] = {"Translate",       "Rotate",         "Scale",        "Skew",
                                                 "ConcatTransform", "AttributeBegin", "AttributeEnd", "MotionEnd",
                                                 "TransformEnd",    "TransformBegin", "MotionBegin",  "version"};

/// Requests that replace an attribute whatever its value was.
constexpr std::string_view kSettingRequests[] = {"Color",
                                                 "Opacity",
                                                 "Surface",
                                                 "Displacement",
                                                 "Interior",
                                                 "Exterior",
                                                 "Matte",
                                                 "TrimCurve",
                                                 "Sides",
                                                 "ShadingRate",
                                                 "Basis",
                                                 "Atmosphere",
                                                 "Declare",
                                                 "Attribute",
                                                 "Bound",
                                                 "TextureCoordinates",
                                                 "GeometricRepresentation",
                                                 "ShadingInterpolation"};

template <size_t N> bool among(const std::string_view (&names)[N], const std::string_view& name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

} // namespace

/// Decides, when an archive is read for the second time, whether it holds shapes alone, and whether it sets attributes.
void Interpreter::learn(SharedArchive& of, const std::string& file) {
    of.known = true;
    const auto parsed = shelf_.take(file);
    const auto kept = parsed ? nullptr : parseArchive(file); // too large for the shelf
    const ParsedArchive* archive = parsed ? parsed.get() : kept.get();
    if (!archive) return;
    for (const Call& c : archive->calls) {
        const std::string_view name = c.request->name;
        if (scene::has(name, scene::kSurface) || among(kPlacingRequests, name)) continue;
        if (!among(kSettingRequests, name) || (name == "Attribute" && c.text(0) == "grouping")) return;
        of.settings = true;
    }
    of.shapes = true;
}

bool Interpreter::mayShare(const std::string& name) const {
    if (making_ || settings.comments || settings.executed || !frame_ || !frameWanted() || motion_ || capture_ ||
        !everywhere_.empty())
        return false;
    if (innermost(BlockKind::Object) || innermost(BlockKind::Solid) || innermost(BlockKind::Edit)) return false;
    return state.attributes->areaLight < 0 && state.attributes->solid.empty() && !inlineArchives_.count(name);
}

bool Interpreter::instanceOfArchive(const std::string& name, const Call& call) {
    if (sharedArchives_.empty() || !mayShare(name)) return false;
    const auto found = locateArchive(name, call.place);
    if (!found) return true; // reported by locateArchive(); nothing to read
    const auto known = sharedArchives_.find(found->key);
    if (known == sharedArchives_.end()) return false;
    const SharedArchive& archive = known->second;
    const auto under = archive.under.find(archive.known && !archive.settings ? nullptr : state.attributes.get());
    if (under == archive.under.end() || !under->second.object) return false;
    place(*under->second.object, call.place);
    return true;
}

void Interpreter::readDelayed(const std::string& name, const Call& call) {
    const bool may = mayShare(name);
    const auto found = may ? locateArchive(name, call.place) : std::nullopt;
    if (may && !found) return; // reported by locateArchive()
    SharedArchive* const archive = found ? &sharedArchives_[found->key] : nullptr;
    SharedArchive::Under* under = nullptr;
    if (archive && (!archive->known || archive->shapes)) {
        under = &archive->under[state.attributes.get()];
        under->attributes = snapshot();
        if (++under->reads < 2) under = nullptr;
        else if (!archive->known) learn(*archive, found->file);
        if (archive->known && !archive->shapes) under = nullptr, archive->under.clear();
        if (under && !archive->settings) under = &archive->under[nullptr];
    }
    if (!begin(under ? BlockKind::Object : BlockKind::Attribute, call)) return;
    if (under) under->object = beginObject("DelayedReadArchive " + found->key);
    readArchive(name, call.place);
    end(under ? BlockKind::Object : BlockKind::Attribute, call);
    if (!under) return;
    objects_.erase(under->object->object.handle); // no name of the scene's
    place(*under->object, call.place);
}

} // namespace alpenglow::ri

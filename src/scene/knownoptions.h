// The names of Option, Attribute, Hider and Display parameters that are known here: one table each. The reader takes their types
// from it, warnings their spelling, `alpenglow info` and docs/options.md their text.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::scene {

/// What a name does in this program.
enum class Effect {
    Used,    ///< decides something about the picture or the run
    Asked,   ///< decides nothing by itself: kept for shaders (option(), attribute()) and for RIB's If
    Ignored, ///< a name of other renderers: accepted without a message, and without an effect
};

/// One name of Option "category" "name", of Attribute, or of a parameter of Hider or Display.
struct OptionDescription {
    std::string_view name;     ///< "category:name" for options and attributes, the bare name for parameters
    std::string_view type;     ///< as RIB declares it ("int", "float[2]"); "" = numbers and strings are both taken
    std::string_view standard; ///< what holds when nothing is set, for people; "" = nothing
    std::string_view sample;   ///< a value as RIB writes it; "" for ignored names
    Effect effect = Effect::Ignored;
    std::string_view doc; ///< what it does here, one or two sentences; of ignored names, whose they are
};

/// One hider.
struct HiderDescription {
    std::string_view name, doc;
};

/// Sorted by name. The category "user" takes every name, so it is in neither table.
std::span<const OptionDescription> knownOptions();
std::span<const OptionDescription> knownAttributes();
std::span<const OptionDescription> knownHiderParameters();
/// Those that every display driver reads; what one driver alone reads is in its own descriptor.
std::span<const OptionDescription> knownDisplayParameters();
std::span<const HiderDescription> knownHiders();

/// The entry of that name, or null.
const OptionDescription* findKnown(std::span<const OptionDescription> table, std::string_view name);
/// For hints: the names of a category ("trace" gives "maxdepth", ...), or for "" the categories themselves.
std::vector<std::string> knownNames(std::span<const OptionDescription> table, std::string_view category);

} // namespace alpenglow::scene

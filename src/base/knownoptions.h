// The names of Option, Attribute, Hider and Display parameters that are known here: one table each. The reader takes their types
// from it, attribute(), option() and RIB's If what holds where nothing is set, warnings of scenes and of shaders their spelling,
// `alpenglow info` and docs/options.md their text.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::known {

/// What a name does in this program.
enum class Effect {
    Used,       ///< changes the picture or the run
    ForShaders, ///< no effect by itself: kept for shaders (option(), attribute()) and for RIB's If
    Computed,   ///< read-only: attribute() or option() computes it from the graphics state or the point
    Ignored,    ///< a name of another renderer: accepted with a note, no effect
};

/// One name of Option "category" "name", of Attribute, or of a parameter of Hider or Display.
struct OptionDescription {
    std::string_view name;           ///< "category:name" for options and attributes, the bare name for parameters
    std::string_view type;           ///< as RIB declares it ("int", "float[2]"); "" = numbers and strings are both taken
    std::string_view standard;       ///< what holds when nothing is set, for people; "" = nothing
    std::string_view sample;         ///< a value as RIB writes it; "" for ignored names
    Effect effect = Effect::Ignored; ///< whether the program acts on it
    std::string_view doc; ///< what it does here, one or two sentences; of ignored names, whose they are, and why nothing is done
    /// What attribute(), option() and RIB's If give where nothing is set, as RIB writes it; "": they find nothing.
    std::string_view answer = {};
    std::string_view answerUnderPath = {}; ///< under Hider "path", if that is something else

    /// Whether a request that sets it changes anything.
    bool settable() const { return effect == Effect::Used || effect == Effect::ForShaders; }
};

/// One hider.
struct HiderDescription {
    std::string_view name, doc; ///< the hider's name; text of the manual
};

/// Sorted by name. The category "user" takes every name, so it is in neither table.
std::span<const OptionDescription> knownOptions();
/// Attributes, "category:name".
std::span<const OptionDescription> knownAttributes();
/// Parameters of the request Hider, of all hiders.
std::span<const OptionDescription> knownHiderParameters();
/// Those that every display driver reads; what one driver alone reads is in its own descriptor.
std::span<const OptionDescription> knownDisplayParameters();
/// The hiders by their main names; the docs name the aliases.
std::span<const HiderDescription> knownHiders();

/// The entry of that name, or null.
const OptionDescription* findKnown(std::span<const OptionDescription> table, std::string_view name);
/// A value as RIB writes it: numbers, or texts in quotes. Of `answer`.
struct PlainValue {
    std::vector<float> numbers;
    std::vector<std::string> texts;
};
/// Reads a value as RIB writes it, with or without brackets.
PlainValue plainValue(std::string_view text);
/// For hints: the names of a category ("trace" gives "maxdepth", ...), or for "" the categories themselves.
std::vector<std::string> knownNames(std::span<const OptionDescription> table, std::string_view category);

} // namespace alpenglow::known

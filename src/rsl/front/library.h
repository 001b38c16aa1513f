// The program's own RSL (src/rsl/library), which the parser reads like any other text: functions and structures that shaders of
// other renderers expect, and classes whose members and methods are added to classes of the shader.
#pragma once
#include "rsl/front/parser.h"
#include <set>
#include <span>

namespace alpenglow::rsl::front {

/// One text of src/rsl/library: a file NAME.sl that defines NAME.
struct LibraryText {
    /// What the text defines.
    enum class Kind : uint8_t { Function, Structure, Class };
    Kind kind;
    const char *name, *text;
};
/// All of them, by kind and name (generated from the files).
std::span<const LibraryText> libraryTexts();

/// Macros of a text of the library, with what they stand for.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Adds texts of the library to a parser, each at most once.
class Library {
public:
    /// Both must outlive it.
    Library(SourceSet& s, Parser& p) : sources_(s), parser_(p) {}
    /// Gives the parser the functions and structures that a text calls or names and does not define. What these name comes before
    /// them.
    void readNamed(const std::vector<Token>& text);
    /// The class of a text, and what that names. Empty after too many errors: `shader` is null then.
    ClassDefinition classNamed(const std::string& name, const Defines&);

private:
    Preprocessed preprocessed(const LibraryText&, const Defines&);
    SourceSet& sources_;
    Parser& parser_;
    std::set<std::string> read_; ///< functions and structures that were read, or that the shader defines itself
};

/// Adds to a class what it lacks, by name, of the parameters, members and methods of another, before its own.
void mixIn(ClassDefinition& to, ClassDefinition from);

/// Gives class lights of PRMan that send their light through generateSamples(), generatePhoton() or emit() the light() that does
/// it: library/classes/sampledlight.sl, photonlight.sl, emittinglight.sl.
void addLightMethods(Unit&, Library&);

/// Makes calls of directlighting(this, ...), of its halves and of indirectspecular(this, ...) calls of methods of the library
/// that the class is given: library/classes/directlighting.sl, indirectspecular.sl. Warns of tokens that the shadeop does not
/// know.
void addLightingMethods(Unit&, Library&, SourceSet&);

/// The method of a class, null if there is none.
Function* methodOf(const ClassDefinition&, std::string_view name);

} // namespace alpenglow::rsl::front

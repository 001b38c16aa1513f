// The C preprocessor over tokens: #include, macros, conditionals. Our own because it must be thread safe, bounded, and keep the
// place of every token; no text is written and read again in between.
#pragma once
#include "rsl/front/lexer.h"

namespace alpenglow::rsl::front {

/// One `#pragma annotation`.
struct Annotation {
    std::string key, value; ///< as written, without quotes
    size_t token = 0;       ///< index of the token that follows it
};

/// A text behind the preprocessor.
struct Preprocessed {
    std::vector<Token> tokens;             ///< the last one is Tok::End
    std::vector<Annotation> annotations;   ///< in the order of the text
    std::vector<std::string> dependencies; ///< paths of the files that were included
    bool incomplete = false;               ///< an include was missing: unknown names later on may be its fault
    /// An include that was not found.
    struct Missing {
        Place place;      ///< of the directive
        std::string name; ///< as written
    };
    std::vector<Missing> missing; ///< includes that were not found; whether that is an error depends on what is missed later
    /// The text after macros, one line for each line that gave a token.
    std::string text() const;
};

/// Runs over file `main` of the set. Errors go to the set; the result is usable in any case.
Preprocessed preprocess(SourceSet&, int main, const FrontOptions&);

/// Value of an #if expression whose macros are expanded and `defined` replaced. Errors go to the set and count as 0.
bool conditionValue(const std::vector<Token>&, Place, SourceSet&);

/// The whole file, or nothing when it cannot be read or is larger than limits::kStringBytes.
std::optional<std::string> readSource(const std::string& path);

} // namespace alpenglow::rsl::front

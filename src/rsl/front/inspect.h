// A program as far as it can be understood, for tools that look at shaders while they are written.
#pragma once
#include "rsl/front/ast.h"
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// A structure for who shows shaders; types in words.
struct StructSummary {
    /// A member, with the class and brackets in the type.
    struct Member {
        std::string type, name; ///< as text
        Place place;            ///< of the declaration
    };
    std::string name;
    std::vector<Member> members;
    std::vector<StructType::Method> methods;
};
/// A structure of the program in words.
StructSummary summary(const StructType&, const Program&);
/// All structures of the program, in the order of the text.
std::vector<StructSummary> summaries(const Program&);

/// The program as it was written, where structures are variables and expressions name members of them, if it was kept
/// (FrontOptions::keepWritten); otherwise the program itself, which is the same if it has no structures.
inline const Program& asWritten(const Program& p) { return p.written ? *p.written : p; }

/// As compileText() with keepWritten, but returns the program even after errors: never null. A tree with errors in it has calls
/// without a callee and expressions without a type; it is for reading, not for compiling.
std::unique_ptr<Program> inspectText(const std::string& text, const std::string& name, const FrontOptions&, Diagnostics&);

} // namespace alpenglow::rsl

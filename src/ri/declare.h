// Declarations of parameters: "class type[n] name", Declare, and what is known without either (RISpec 3.2, section 3).
#pragma once
#include "scene/param.h"
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace alpenglow::ri {

/// The type of a parameter.
struct Declaration {
    scene::Class cls = scene::Class::Uniform; ///< storage class
    scene::Type type = scene::Type::Float;
    int arrayLength = 0; ///< 0 = not an array
};

/// "[class] type [[n]]"; empty when it is not one.
std::optional<Declaration> parseDeclaration(std::string_view text);

/// A type that other programs write and RIB does not have, the type that it is read as, and what to write instead.
struct OtherType {
    std::string_view written, meant, hint;
};
/// The type of a declaration "[class] type [[n]]" that RIB does not have, such as "double"; null: it has none of these.
const OtherType* otherTypeIn(std::string_view text);
/// The hint of a text that is no declaration: the class or type that a word of it is near to, or else `form`. named: the last
/// word is the variable's name.
std::string declarationHint(std::string_view text, bool named, std::string_view form);

/// A token of a parameter list, taken apart.
struct Resolved {
    std::string name;                       ///< the token without an inline declaration
    std::optional<Declaration> declaration; ///< empty: not declared
    bool malformed = false;                 ///< an inline declaration that does not parse
    bool inlineForm = false;                ///< the token has a declaration in it
    bool byValue = false;                   ///< known, with the type of its value
    const OtherType* otherType = nullptr;   ///< of an inline declaration: otherTypeIn()
};

/// The declared names of a stream. Not thread safe.
class Declarations {
public:
    /// Declares a name, or replaces its declaration.
    void declare(const std::string& name, const Declaration& d) {
        user_[name] = d;
        seen_.clear();
    }
    /// `category`: class of an Option or Attribute ("searchpath"), or "" elsewhere; its known names are looked up first. The
    /// result holds until the next call of a member.
    const Resolved& resolve(std::string_view token, std::string_view category) const;

private:
    struct Hash : std::hash<std::string_view> {
        using is_transparent = void;
    };
    Resolved found(std::string_view token, std::string_view category) const;
    std::map<std::string, Declaration, std::less<>> user_;
    /// Tokens without a category, as found before: a scene has few, and each of them in every primitive.
    mutable std::unordered_map<std::string, Resolved, Hash, std::equal_to<>> seen_;
    mutable Resolved last_; ///< with a category
};

/// The words of RIB: "facevarying", "hpoint".
const char* toString(scene::Class);
const char* toString(scene::Type);

} // namespace alpenglow::ri

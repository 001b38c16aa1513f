// One text that is open in an editor: its lines, its compiled form, and the word at a place. Positions are bytes
// from the start of the text; the server converts from and to those of the protocol.
#pragma once
#include "base/diagnostics.h"
#include "rsl/front/ast.h"
#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::cli {

/// Whether an RSL name may contain this character.
inline bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Where something is declared. An empty file means nowhere that has a file.
struct Origin {
    std::string file;
    int line = 0, column = 0; ///< from 1; columns in bytes
};

/// A call around a position: the name in front of its '(' and how many separators stand between.
struct CallAround {
    std::string name;
    size_t at = 0;       ///< of the name
    size_t argument = 0; ///< from 0
};

/// One file that an editor has open. Positions are bytes from 0.
class Document {
public:
    /// A shader; a scene when `rib` is set, or by the end of its name (".rib").
    Document(std::string path, std::string text, bool rib = false)
        : path_(std::move(path)), rib_(rib || path_.ends_with(".rib") || path_.ends_with(".RIB")) {
        set(std::move(text));
    }
    /// It is a scene.
    bool rib() const { return rib_; }

    /// As the editor names it.
    const std::string& path() const { return path_; }
    /// As the editor has it.
    const std::string& text() const { return text_; }
    /// Replaces the whole text.
    void set(std::string text);
    /// Replaces the bytes [begin, end).
    void replace(size_t begin, size_t end, const std::string& by);
    /// Compiles the text as far as it can be understood, if it changed since the last time.
    void analyse(const rsl::FrontOptions&);
    /// The text has changed since it was compiled.
    bool stale() const { return stale_; }
    /// Something that it includes is another now.
    void touch() { stale_ = true; }
    /// Whether it includes this file, or names it.
    bool includes(const std::string& path) const;
    /// Of the last compilation, and its checked program; null: it has none.
    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
    const rsl::Program* program() const { return program_.get(); }

    /// Number of lines, at least 1.
    size_t lines() const { return starts_.size(); }
    /// The text of a line (from 0) without its end; "" beyond the last.
    std::string_view line(size_t) const;
    /// Position of a line's byte; clamped to the line and the text.
    size_t offset(size_t line, size_t column) const;
    /// The line of a position, and where a line begins.
    size_t lineOf(size_t position) const;
    size_t startOf(size_t line) const { return line < starts_.size() ? starts_[line] : text_.size(); }

    /// The identifier that touches the position: [begin, end), nothing where there is none.
    std::optional<std::pair<size_t, size_t>> wordAt(size_t position) const;
    /// Inside a comment or a string?
    enum class Where { Code, Comment, String };
    /// Where a position is; the innermost call around it; nothing outside of calls.
    Where where(size_t position) const;
    std::optional<CallAround> callAround(size_t position) const;
    /// End of the definition whose name is here: after the '}' that closes its body.
    size_t endOfDefinition(size_t name) const;
    /// The comment directly above the line (from 0), without its marks.
    static std::string commentAbove(const std::string& text, size_t line);

    /// What is used or declared by the word that begins at this position.
    struct Use {
        /// At most one is set; null: it is none of these.
        const rsl::Symbol* symbol = nullptr;
        const rsl::Function* function = nullptr;
        const rsl::Shader* shader = nullptr;
        const shadeops::Shadeop* shadeop = nullptr;
        const shadeops::Signature* signature = nullptr;
    };
    /// For a word of the text; empty: nothing is known of it.
    Use useAt(size_t word) const;
    /// All of them, by the positions of their words.
    std::map<size_t, Use> uses() const;
    /// A name or keyword of the text outside of comments and strings.
    struct Word {
        size_t begin, end; ///< in bytes: first, and behind the last
        bool directive;    ///< in a line that the preprocessor reads
    };
    /// All of them, in order.
    std::vector<Word> words() const;
    /// The line and column, from 0, of the name in its "#define".
    std::optional<std::pair<size_t, size_t>> macro(const std::string& name) const;
    /// As useAt(), by the name alone: where the text around it cannot be understood, or a statement with an error in it is gone.
    Use named(size_t word) const;
    /// The text in front of "->" or "." before a name: "this", "ray", "ray->start"; nothing where there is neither.
    struct Receiver {
        std::string name;
        bool arrow = false; ///< "->" stands there, else "."
    };
    /// Of the name that begins there.
    std::optional<Receiver> receiver(size_t word) const;
    /// One thing that a receiver has.
    struct Member {
        std::string name, detail, of; ///< `of`: the class or structure
        rsl::Place place;             ///< of its declaration
        bool method = false;          ///< it is called
    };
    /// In the scope of the position.
    std::vector<Member> members(const Receiver&, size_t position) const;
    /// The structure of this name; null when there is none.
    const rsl::StructType* structure(const std::string& name) const;
    /// The structure that the variable, or `chain`, members of it such as "->a->b", is; null if it is none.
    const rsl::StructType* structureOf(const rsl::Symbol&, const std::string& chain) const;
    /// The shader or function of this text in which the position is; both null outside.
    struct Around {
        const rsl::Shader* shader = nullptr;
        const rsl::Function* function = nullptr;
    };
    /// The innermost ones.
    Around around(size_t position) const;
    /// All functions, also nested ones, that the compiler knows by this name; each definition once.
    std::vector<const rsl::Function*> functions(const std::string& name) const;
    /// All functions of the program that stand in files, each definition once.
    std::vector<const rsl::Function*> functions() const;

    /// A place of the program; the file is empty for text that is in no file.
    Origin origin(const rsl::Place&) const;
    /// Whether the place is in this document.
    bool isHere(const rsl::Place&) const;

private:
    /// f(line, column, name, Use) for what this text declares and uses, columns in bytes; both from 1.
    template <class F> void eachUse(F&& f) const;
    std::string path_, text_;
    bool rib_ = false;
    void analyseScene(); // lsprib.cpp
    std::vector<size_t> starts_;
    bool stale_ = true;
    std::shared_ptr<const rsl::Program> program_; ///< as written (rsl::asWritten())
    std::vector<Diagnostic> diagnostics_;
};

/// Absolute, without "." and "..".
std::string normalPath(const std::string&);
/// "float f(float a; output S b[])", with the names; structures as the program declares them.
std::string signatureOf(const rsl::Function&, const rsl::Program&);
/// "output varying color x", "S s[3]".
std::string declarationOf(const rsl::Symbol&, const rsl::Program&);

} // namespace alpenglow::cli

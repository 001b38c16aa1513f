// Random well-typed programs, as RapidCheck sees them: a value with ever smaller versions of itself.
#pragma once
#include <map>
#include <rapidcheck.h>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// A piece of text with holes ('$') for parts; a list has its parts one after the other. '@' stands for the program's number in a
/// batch. The sort says what may stand in its place:
///   F float, I index, U uniform float, C color, P point, V vector, N normal, M matrix, S string, T short string, B condition, s
///   statement, l list of statements, g list of functions, d piece that stays
struct Term {
    char sort = 'd';
    std::string text;
    std::vector<Term> parts;
    bool list = false;
    size_t size() const;
    std::string write(int number) const;
};

/// One way to write a value; holes are '$' and the letter of a sort, and "$F" is in brackets or a call, never a bare sum.
struct Choice {
    int weight;
    const char* text;
};
/// Every way to write a value of a sort, and values that need nothing (programs_grammar.cpp).
const std::map<char, std::vector<Choice>>& grammar();
const std::map<char, std::vector<const char*>>& constants();

/// parts[0]: functions; parts[1]: the statements of the shader's body. What a program leaves behind: outputs() by name and type.
/// Loops have at most eight turns and are at most three deep; array indices may be anything. At size 100 about twice as long as
/// below.
rc::Gen<Term> programs();

/// Everything that is a little smaller: without one statement, with a part in place of the whole, with a constant in place of a
/// part.
std::vector<Term> smaller(const Term&);

/// The outputs of program `number`: "output varying color q0_N = 0;" and so on.
std::vector<std::pair<std::string, std::string>> outputs(int number); ///< name, type

/// Many programs in one shader, each in its own block. As an object: their functions are methods of a class, and change members
/// of it.
std::string shaderOf(const std::vector<Term>& programs, bool object = false);

} // namespace alpenglow::rsl

// Strings and standard output: 3Delight manual, 6.4.7.
#include "shadeops/describe.h"

namespace alpenglow::shadeops {

std::vector<Shadeop> stringShadeops() {
    std::vector<Shadeop> list;
    const auto add = [&](const char* name, std::vector<Signature> signatures, Lowering lowering, const char* doc) -> Shadeop& {
        Shadeop op;
        op.section = "Strings";
        op.source = "3Delight manual, 6.4.7";
        op.name = name;
        op.signatures = std::move(signatures);
        op.lowering = lowering;
        op.derivative = DerivativeRule::Zero;
        op.doc = doc;
        list.push_back(std::move(op));
        return list.back();
    };
    const std::string conversions =
        "%f %e %g %d (= %.0f, also %i) for floats; %p (also %v %n) for points, vectors, normals and %c for colours: "
        "[x y z]; %m for matrices, rows separated by commas; %s for strings. "
        "All take a precision and a width. %g without precision is the shorter of %f and %e; with one it is %f.";
    add("format", sigs({{"string format(string pattern)"}, {"string format(string pattern; any value, ...)"}}), Lowering::Service,
        ("The text of the pattern with its conversions filled in. " + conversions).c_str())
        .examples = {{"format(\"%s %d\", \"a\", 3)", "a 3"}, {"format(\"%.2f\", 0.5)", "0.50"}};
    add("printf", sigs({{"void printf(string pattern)"}, {"void printf(string pattern; any value, ...)"}}), Lowering::Service,
        ("Prints to standard output, once per sample, in the order of samples. " + conversions).c_str())
        .pure = false;
    list.back().examples = {{"printf(\"u is %g\", u)", "u is 0.5"}};
    add("print",
        sigs({{"void print(string pattern)"}, {"void print(string pattern; any value, ...)"}, {"void print(any value, ...)"}}),
        Lowering::Service,
        "Like printf(), and ends the line. Where the first argument is no text, or a text without conversions, the values are "
        "printed one after the other with blanks between them (PRMan).")
        .pure = false;
    list.back().examples = {{"print(\"u is %g\", u)", "u is 0.5"}, {"print(u, N)", "0.5 [0 0 1]"}};
    add("concat", sigs({{"string concat(string a, string b, ...)"}}), Lowering::Service, "Joins strings.").examples = {
        {"concat(\"a\", \"b\", \"c\")", "abc"}};
    add("match", sigs({{"float match(string pattern, string subject)"}}), Lowering::Service,
        "1 if the POSIX regular expression occurs anywhere in subject, else 0.");
    list.back().examples = {{"match(\"a.c\", \"abc\")", "1"}};
    add("stringhash", sigs({{"float stringhash(string text)"}, {"color stringhash(string text)"}}), Lowering::Service,
        "A hash of the text in [0,1), as float or color, for pictures of identifiers.");
    list.back().examples = {{"stringhash(\"a\") == stringhash(\"a\") && stringhash(\"a\") != stringhash(\"b\")", "1"}};
    return list;
}

} // namespace alpenglow::shadeops

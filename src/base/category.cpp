#include "base/category.h"
#include "base/limits.h"

namespace alpenglow {

namespace {

std::string_view trimmed(std::string_view s) {
    while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
    while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
    return s;
}

bool hasWord(std::string_view list, std::string_view word) {
    while (true) {
        const size_t comma = list.find(',');
        if (trimmed(list.substr(0, comma)) == word) return true;
        if (comma == std::string_view::npos) return false;
        list.remove_prefix(comma + 1);
    }
}

/// Parses and evaluates in one pass: expressions are short.
struct Reader {
    std::string_view text, categories;
    std::string error;
    int depth = 0;

    char next() {
        while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
        return text.empty() ? 0 : text.front();
    }
    bool take(char c) {
        if (next() != c) return false;
        text.remove_prefix(1);
        return true;
    }
    void fail(std::string why) {
        if (error.empty()) error = std::move(why);
        text = {};
    }

    bool list() {
        bool any = false, asked = false, excluded = false;
        do {
            const bool without = next() == '-' || next() == '!';
            const bool in = either();
            if (without) excluded |= !in;
            else asked = true, any |= in;
        } while (take(','));
        return (any || !asked) && !excluded;
    }
    bool either() {
        bool in = both();
        while (take('|')) in = both() || in;
        return in;
    }
    bool both() {
        bool in = one();
        while (take('&')) in = one() && in;
        return in;
    }
    bool one() {
        if (++depth > limits::kCategoryDepth) fail("it is nested too deeply");
        bool in = false;
        if (take('-') || take('!')) {
            in = !one();
        } else if (take('(')) {
            in = list();
            if (!take(')')) fail("a ')' is missing");
        } else {
            next();
            const size_t end = std::min(text.find_first_of(",|&()!"), text.size());
            const std::string_view word = trimmed(text.substr(0, end));
            if (word.empty()) fail("a name is missing");
            else text.remove_prefix(end);
            in = hasWord(categories, word);
        }
        --depth;
        return in;
    }
    bool all() {
        if (!next()) return true; // no restriction
        const bool in = list();
        if (error.empty() && next()) fail(std::string("'") + text.front() + "' is unexpected there");
        return in;
    }
};

} // namespace

bool inCategory(std::string_view expression, std::string_view categories) {
    Reader r{expression, categories, {}, 0};
    const bool in = r.all();
    return in || !r.error.empty();
}

std::string categoryError(std::string_view expression) {
    Reader r{expression, {}, {}, 0};
    r.all();
    return r.error;
}

} // namespace alpenglow

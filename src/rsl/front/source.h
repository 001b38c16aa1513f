// The texts of one compilation and the messages about them. Places of a program index this set.
#pragma once
#include "rsl/front/ast.h"
#include "rsl/messages/messages.h"
#include <deque>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::rsl::front {

/// The texts, numbered from 0, and the messages about them until flush().
class SourceSet {
public:
    /// Adds a text; `line` and `column` of its places count from 1. The text's address stays valid.
    int add(std::string name, std::string text);
    /// A view of file `of` whose lines are counted `delta` higher, under another name (#line).
    int addView(int of, std::string name, int delta);
    /// The text of a file; of a view that of the file.
    const std::string& text(int file) const {
        return entries_[file].view >= 0 ? text(entries_[file].view) : *entries_[file].text;
    }
    /// The name for messages.
    const std::string& name(int file) const { return entries_[file].name; }
    /// All of them, by number.
    std::vector<std::string> names() const;
    /// Keeps a string alive as long as the set.
    std::string_view keep(std::string);

    /// Notes a message: an error or a warning, as its table says. `hint` "": the message's own, if it has one.
    void report(Place, const Raised&, std::string hint = {}, std::vector<std::string> notes = {});
    /// Number of errors so far.
    int errors() const { return errors_; }
    /// True once so many errors were found that going on is of no use.
    bool tooMany() const;
    /// While muted nothing is noted, and nothing counted.
    bool muted = false;
    /// What is checked has no part in any shader: its errors are warnings.
    bool unused = false;
    int excused = 0; ///< errors that became warnings so
    /// The text ends too early, which has been reported; what is missing at its end is not reported again.
    bool cut = false;
    /// Hands all messages over, sorted by place.
    void flush(Diagnostics&);

private:
    struct Entry {
        std::string name;
        const std::string* text = nullptr;
        int view = -1;
        int delta = 0;
    };
    struct Message {
        Place place;
        Severity severity; ///< that of `raised`, or less
        Raised raised;
        std::string text, hint;
        std::vector<std::string> notes;
        size_t order = 0;
    };
    std::string line(Place) const;
    std::vector<Entry> entries_;
    std::deque<std::string> kept_;
    std::vector<Message> messages_;
    std::set<std::pair<std::vector<int>, std::string>> seen_;
    int errors_ = 0;
};

} // namespace alpenglow::rsl::front

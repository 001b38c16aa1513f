#include "base/xml.h"
#include <algorithm>
#include <cstdint>
#include <fmt/format.h>

namespace alpenglow {

namespace {

/// Ends the reading; never leaves this file.
struct XmlFault {
    size_t at; ///< byte of the text that the message is about
    std::string why;
};

bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// A code point as UTF-8; false: there is no such character in XML.
bool addCharacter(std::string& to, uint32_t c) {
    const bool control = c < 32 && c != 9 && c != 10 && c != 13;
    if (control || (c >= 0xd800 && c <= 0xdfff) || c == 0xfffe || c == 0xffff || c > 0x10ffff) return false;
    if (c < 0x80) {
        to += char(c);
        return true;
    }
    const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    to += char((0xff00u >> (more + 1)) | (c >> (6 * more))); // as many ones as there are bytes
    for (int k = more - 1; k >= 0; --k) to += char(0x80 | (c >> (6 * k) & 0x3f));
    return true;
}

class XmlReader {
public:
    XmlReader(std::string_view t, const XmlRules& r) : text_(t), rules_(r) {}
    XmlElement document();

private:
    [[noreturn]] void fail(std::string why) const { fail(at_, std::move(why)); }
    [[noreturn]] void fail(size_t at, std::string why) const { throw XmlFault{std::min(at, text_.size()), std::move(why)}; }
    bool starts(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
    /// The text up to a word, which is passed.
    std::string_view until(std::string_view word, const char* what) {
        const size_t found = text_.find(word, at_), from = at_;
        if (found == text_.npos) fail(fmt::format("{} does not end", what));
        at_ = found + word.size();
        return text_.substr(from, found - from);
    }
    void blanks() {
        while (at_ < text_.size() && blank(text_[at_])) ++at_;
    }
    std::string name();
    std::string value();
    void entity(std::string& to);
    void characters(size_t end);
    void begin();
    void end();
    void step();
    void count(XmlElement& e);

    std::string_view text_;
    const XmlRules& rules_;
    XmlElement root_;
    std::vector<XmlElement*> open_; ///< a parent gets no other child before this one is closed, so that pointers hold
    bool rooted_ = false;
    size_t at_ = 0, elements_ = 0;
    size_t counted_ = 0, lineStart_ = 0; ///< bytes that have been looked at for line ends; where the line begins
    int line_ = 1;
};

/// The place that is read, counted on from the last element.
void XmlReader::count(XmlElement& e) {
    for (; counted_ < at_; ++counted_)
        if (text_[counted_] == '\n') {
            ++line_;
            lineStart_ = counted_ + 1;
        }
    e.line = line_;
    e.column = int(at_ - lineStart_) + 1;
}

std::string XmlReader::name() {
    const size_t from = at_;
    const auto letter = [](unsigned char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c >= 0x80; };
    while (at_ < text_.size()) {
        const auto c = static_cast<unsigned char>(text_[at_]);
        if (!(letter(c) || (c >= '0' && c <= '9') || c == '_' || c == ':' || c == '-' || c == '.')) break;
        ++at_;
    }
    if (at_ == from) fail("a name is missing");
    return std::string(text_.substr(from, at_ - from));
}

/// At a '&'.
void XmlReader::entity(std::string& to) {
    static constexpr std::pair<std::string_view, char> kEntities[] = {
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
    constexpr size_t kLongest = 10; // bytes of a number of a character
    const size_t from = at_, end = text_.substr(at_ + 1, kLongest + 1).find(';');
    const std::string_view word = text_.substr(at_ + 1, end == text_.npos ? 0 : end);
    at_ += word.size() + 2;
    for (const auto& [known, letter] : kEntities)
        if (word == known) {
            to += letter;
            return;
        }
    const bool hex = word.starts_with("#x");
    uint32_t code = 0;
    bool number = word.size() > (hex ? 2u : 1u) && word[0] == '#';
    for (const char c : word.substr(std::min<size_t>(word.size(), hex ? 2 : 1))) {
        const int digit = c >= '0' && c <= '9'   ? c - '0'
                          : c >= 'a' && c <= 'f' ? c - 'a' + 10
                          : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                 : 16;
        number = number && digit < (hex ? 16 : 10) && code < 0x1000000; // the next digit must not overflow
        code = code * (hex ? 16 : 10) + uint32_t(digit);
    }
    if (!number || !addCharacter(to, code))
        fail(from, "an entity is not one of &amp; &lt; &gt; &quot; &apos; nor the number of a character");
}

std::string XmlReader::value() {
    const char quote = at_ < text_.size() ? text_[at_] : 0;
    if (quote != '"' && quote != '\'') fail("the value of an attribute is not in quotes");
    const size_t end = text_.find(quote, ++at_);
    if (end == text_.npos) fail("the value of an attribute does not end");
    std::string out;
    while (at_ < end) {
        const char c = text_[at_];
        if (c == '<') fail("there is a < in the value of an attribute");
        if (c == '&') {
            entity(out);
            continue;
        }
        out += c;
        ++at_;
    }
    at_ = end + 1;
    return out;
}

/// Character data up to `end`: of the innermost element.
void XmlReader::characters(size_t end) {
    std::string between;
    std::string& to = open_.empty() ? between : open_.back()->text;
    while (at_ < end) {
        const char c = text_[at_];
        if (open_.empty() && !blank(c) && static_cast<unsigned char>(c) < 0x80) // a mark of UTF-8 may come first
            fail(rooted_ ? "there is something behind the outermost element" : "there is no element");
        if (c == '&') {
            entity(to);
            continue;
        }
        to += c;
        ++at_;
    }
}

void XmlReader::begin() {
    if (++elements_ > rules_.elements) fail(fmt::format("there are more than {} elements", rules_.elements));
    if (open_.size() >= rules_.depth) fail(fmt::format("elements lie more than {} deep", rules_.depth));
    if (open_.empty() && rooted_) fail("there is something behind the outermost element");
    XmlElement& e = open_.empty() ? root_ : open_.back()->children.emplace_back();
    rooted_ = true;
    count(e);
    ++at_;
    e.name = name();
    for (;;) {
        blanks();
        if (starts("/>")) {
            at_ += 2;
            return;
        }
        if (starts(">")) {
            ++at_;
            open_.push_back(&e);
            return;
        }
        if (at_ >= text_.size()) fail("an element does not end");
        std::string n = name();
        blanks();
        if (!starts("=")) fail(fmt::format("attribute {} has no value", n.substr(0, 40)));
        ++at_;
        blanks();
        std::string v = value();
        e.attributes.emplace_back(std::move(n), std::move(v));
    }
}

void XmlReader::end() {
    const size_t from = at_;
    at_ += 2;
    const std::string n = name();
    blanks();
    if (!starts(">")) fail("the end of an element does not end");
    ++at_;
    if (open_.empty() || (!rules_.anyEndTag && open_.back()->name != n))
        fail(from, fmt::format("</{}> ends another element than the one that is open", n.substr(0, 40)));
    std::string& text = open_.back()->text;
    while (!text.empty() && blank(text.back())) text.pop_back();
    text.erase(0, std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    open_.pop_back();
}

void XmlReader::step() {
    if (starts("<!--")) {
        at_ += 4; // "<!-->" is no comment
        until("-->", "a comment");
    } else if (starts("<![CDATA[")) {
        if (open_.empty()) fail("there is text outside of the outermost element");
        at_ += 9;
        open_.back()->text += until("]]>", "a CDATA section");
    } else if (starts("<?")) until("?>", "a processing instruction");
    else if (starts("<!")) fail("document types are not read");
    else if (starts("</")) end();
    else begin();
}

XmlElement XmlReader::document() {
    if (text_.size() > rules_.bytes) fail(0, fmt::format("it has more than {} bytes", rules_.bytes));
    while (at_ < text_.size()) {
        characters(std::min(text_.find('<', at_), text_.size()));
        if (at_ < text_.size()) step();
    }
    if (!open_.empty()) fail(fmt::format("<{}> is not closed", open_.back()->name.substr(0, 40)));
    if (!rooted_) fail("there is no element");
    return std::move(root_);
}

} // namespace

const std::string& XmlElement::attribute(std::string_view wanted) const {
    static const std::string none;
    for (const auto& [n, v] : attributes)
        if (n == wanted) return v;
    return none;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
    for (const XmlElement& c : children)
        if (c.name == wanted) return &c;
    return nullptr;
}

std::optional<XmlElement> parseXml(std::string_view text, const std::string& file, Diagnostics& d, const XmlRules& rules) {
    try {
        return XmlReader(text, rules).document();
    } catch (const XmlFault& f) {
        const std::string_view before = text.substr(0, f.at);
        const size_t lineStart = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
        d.report(Severity::Error, Rie::Syntax,
                 {file, int(std::count(before.begin(), before.end(), '\n')) + 1, int(f.at - lineStart) + 1},
                 fmt::format("this is no sound XML: {}", f.why));
    }
    return {};
}

} // namespace alpenglow

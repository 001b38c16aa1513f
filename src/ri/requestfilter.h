// What is left out, put in and replaced in a stream of requests.
#pragma once
#include "base/pattern.h"
#include "ri/receiver.h"
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// A request as one line of ASCII RIB, for people and patterns. Of arrays it holds the first sixteen values.
std::string headOf(const Call&);

/// A pattern of requests: an extended regular expression (base/pattern.h) that begins where the request does and ends where one
/// of its words does. `Surface` is every Surface, `Surface "plastic"` those of this shader, `.*Source` lights.
class RequestPattern {
public:
    /// Returns nothing after an error, with its text in `error`.
    static std::optional<RequestPattern> make(const std::string& text, std::string& error);
    /// line: of headOf(), or the name of an unknown request.
    bool matches(const std::string& line) const { return pattern_->occurs(line); }

private:
    std::shared_ptr<const Pattern> pattern_;
};

/// What RequestFilter does.
struct FilterRules {
    /// Requests that replace others.
    struct Replacement {
        RequestPattern of;    ///< what is replaced
        std::vector<Call> by; ///< empty: nothing takes its place
    };
    std::vector<int> frames;               ///< FrameBegin blocks of these numbers stay, and what is outside; empty: all
    std::vector<Call> before;              ///< put in before the first request, behind the version
    std::vector<Replacement> replacements; ///< the first that fits counts; the result is not replaced again
    std::vector<RequestPattern> drop;      ///< what fits one of these is left out
    std::vector<RequestPattern> only;      ///< not empty: what fits none is left out
};

/// Applies rules to a stream and passes on the result.
class RequestFilter : public RequestReceiver {
public:
    /// to: receives what stays; it must outlive this.
    RequestFilter(FilterRules rules, RequestReceiver& to) : rules_(std::move(rules)), to_(to) {}
    void request(const Call&) override;
    void unknown(const std::string& name, const std::vector<Value>& values) override;
    void comment(const std::string& kind, const std::string& text) override;
    bool over() const override { return to_.over(); }
    /// After the last stream: what waits for a first request comes even if there was none.
    void finish() { begin(); }
    /// Numbers of the frames that were met.
    const std::set<int>& frames() const { return frames_; }

private:
    void begin();
    bool wanted(const std::string& line) const;
    /// Whether the request lies in a frame that is left out.
    bool elsewhere(const Call&);

    const FilterRules rules_;
    RequestReceiver& to_;
    bool begun_ = false;
    int skipped_ = 0; ///< frames open that are left out
    std::set<int> frames_;
};

/// Requests in text. Messages are added to `reported`.
std::vector<Call> requestsOf(const std::string& text, const std::string& name, Diagnostics& reported);

} // namespace alpenglow::ri

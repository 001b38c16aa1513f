#include "scene/lightpaths.h"
#include "scene/lightpathtext.h"
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <unordered_map>

namespace alpenglow::scene {

namespace {

struct Kind {
    PathEvent event;
    PathScattering scattering;
};
/// What there is.
constexpr auto kKinds = [] {
    using enum PathEvent;
    using enum PathScattering;
    return std::array<Kind, 12>{{{Object, None},
                                 {Camera, None},
                                 {Reflection, Diffuse},
                                 {Reflection, Glossy},
                                 {Reflection, Singular},
                                 {Transmission, Diffuse},
                                 {Transmission, Glossy},
                                 {Transmission, Singular},
                                 {Transmission, Straight},
                                 {Volume, None},
                                 {Light, None},
                                 {Sky, None}}};
}();
constexpr size_t kKindCount = std::size(kKinds);
constexpr size_t kStraightKind = 8;
static_assert(kKinds[kStraightKind].scattering == PathScattering::Straight);

/// Sets of up to two of so many labels.
size_t labelSets(size_t labels) { return 1 + labels + labels * (labels - (labels > 0)) / 2; }

/// Of such a set: none, then single ones, then pairs.
size_t labelSet(size_t labels, int a, int b) {
    if (a < 0) std::swap(a, b);
    if (a < 0) return 0;
    if (b < 0 || a == b) return 1 + size_t(a);
    const size_t i = size_t(std::min(a, b)), j = size_t(std::max(a, b));
    return 1 + labels + i * (2 * labels - i - 1) / 2 + (j - i - 1);
}

std::string trimmed(const std::string& s) {
    const size_t b = s.find_first_not_of(" \t"), e = s.find_last_not_of(" \t");
    return b == std::string::npos ? "" : s.substr(b, e - b + 1);
}

/// A state while the automaton is made: the positions at which a path may have arrived, with the beginnings of the expressions
/// behind them.
using Places = std::vector<uint64_t>;

struct Hash {
    size_t operator()(const Places& p) const {
        uint64_t h = 0;
        for (uint64_t w : p) h = (h ^ w) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        return size_t(h);
    }
};

bool test(const Places& p, size_t i) { return p[i / 64] >> (i % 64) & 1; }
void set(Places& p, size_t i) { p[i / 64] |= uint64_t(1) << (i % 64); }

/// All expressions as one, with numbers of their own for positions. The beginning of expression e is position `positions + e`.
struct Joint {
    size_t positions = 0, words = 0;
    std::vector<const PathPosition*> at;
    std::vector<Places> follow; ///< by place
    std::vector<uint64_t> ends; ///< by place: the expressions that may end there
    Places begin, silent;       ///< silent: of expressions that do not see straight passages

    explicit Joint(std::span<const LightPathText> texts) {
        for (const LightPathText& t : texts) positions += t.positions.size();
        words = (positions + texts.size() + 63) / 64;
        follow.assign(positions + texts.size(), Places(words));
        ends.assign(follow.size(), 0);
        begin.assign(words, 0);
        silent.assign(words, 0);
        size_t first = 0;
        for (size_t e = 0; e < texts.size(); ++e) {
            const LightPathText& t = texts[e];
            const uint64_t own = uint64_t(1) << e;
            for (size_t p = 0; p < t.positions.size(); ++p) {
                at.push_back(&t.positions[p]);
                for (size_t q = 0; q < t.positions.size(); ++q)
                    if (t.follow[p][q]) set(follow[first + p], first + q);
                if (t.first[p]) set(follow[positions + e], first + p);
                if (t.last[p]) ends[first + p] |= own;
                if (!t.straight) set(silent, first + p);
            }
            if (t.empty) ends[positions + e] |= own;
            if (!t.straight) set(silent, positions + e);
            set(begin, positions + e);
            first += t.positions.size();
        }
    }

    Places reach(const Places& from) const {
        Places to(words, 0);
        for (size_t p = 0; p < follow.size(); ++p)
            if (test(from, p))
                for (size_t w = 0; w < words; ++w) to[w] |= follow[p][w];
        return to;
    }
    uint64_t endsIn(const Places& p) const {
        uint64_t e = 0;
        for (size_t i = 0; i < ends.size(); ++i)
            if (test(p, i)) e |= ends[i];
        return e;
    }
};

} // namespace

std::optional<std::string> lightPathIn(const std::string& source) {
    std::string s = trimmed(source);
    if (s.rfind("color ", 0) == 0) s = trimmed(s.substr(6)); // PRMan's form
    if (s.rfind("lpe:", 0) != 0) return std::nullopt;
    return s.substr(4);
}

std::optional<std::string> lightPathOfWord(std::string_view word) {
    if (word == "direct") return "C[RTV]?[LO]";
    if (word == "indirect") return "C[RTV][RTV]+[LO]";
    if (word == "other") return "other";
    return std::nullopt;
}

int LightPaths::label(std::string_view name) const {
    const auto i = std::find(labels_.begin(), labels_.end(), name);
    return i == labels_.end() ? -1 : int(i - labels_.begin());
}

int LightPaths::symbol(PathEvent e, PathScattering s, int labelA, int labelB) const {
    size_t kind = 0;
    for (size_t k = 0; k < kKindCount; ++k)
        if (kKinds[k].event == e && kKinds[k].scattering == s) kind = k;
    return int(kind * labelSets(labels_.size()) + labelSet(labels_.size(), labelA, labelB));
}

LightPaths::LightPaths(std::span<const Source> sources, Diagnostics& d) {
    partsOf_.resize(sources.size());
    std::vector<LightPathText> texts;
    std::vector<size_t> of; // by text
    size_t room = kMostPositions;
    for (size_t i = 0; i < sources.size(); ++i) {
        if (sources[i].expression == "other") continue;
        auto text = readLightPath(sources[i].expression, room, sources[i].place, d);
        if (!text) continue;
        texts.push_back(std::move(*text));
        std::string why;
        if (texts.size() > kMostOutputs ? (why = "there are more than " + std::to_string(kMostOutputs) + " of them", false)
                                        : build(texts, why)) {
            room -= texts.back().positions.size();
            of.push_back(i);
            continue;
        }
        texts.pop_back();
        d.report(Severity::Error, Rie::Limit, sources[i].place,
                 "light path expression \"" + sources[i].expression.substr(0, 60) + "\": with those before it " + why +
                     "; it is left out");
    }
    std::string why;
    build(texts, why);
    std::vector<std::vector<int>> byText(partsOf_.begin(), partsOf_.begin() + long(texts.size() + 1));
    partsOf_.assign(sources.size(), {});
    for (size_t i = 0; i < sources.size(); ++i)
        if (sources[i].expression == "other") partsOf_[i] = {0};
    for (size_t k = 0; k < of.size(); ++k) {
        partsOf_[of[k]] = byText[k];
        if (byText[k].empty())
            d.report(Severity::Warning, Rie::Consistency, sources[of[k]].place,
                     "light path expression \"" + sources[of[k]].expression.substr(0, 60) + "\" matches no path",
                     "paths begin with C and end with the light: L, B or O");
    }
}

/// The automaton of these. False: it is too large, `why`.
bool LightPaths::build(std::span<const LightPathText> texts, std::string& why) {
    labels_.clear();
    for (const LightPathText& t : texts)
        for (const PathPosition& p : t.positions)
            for (const PathEvents& e : p.any)
                for (const std::string& l : e.labels)
                    if (label(l) < 0) labels_.push_back(l);
    if (labels_.size() > kMostLabels) {
        why = "they name more than " + std::to_string(kMostLabels) + " labels";
        return false;
    }
    const Joint joint(texts);
    // Events that every position treats alike are one class.
    const size_t sets = labelSets(labels_.size());
    classOf_.assign(kKindCount * sets, 0);
    std::map<Places, uint16_t> known;
    std::vector<Places> matching; // by class: the positions that it may stand at
    const auto classify = [&](size_t kind, int a, int b) {
        std::vector<std::string> carried;
        if (a >= 0) carried.push_back(labels_[size_t(a)]);
        if (b >= 0) carried.push_back(labels_[size_t(b)]);
        Places m(joint.words + 1, 0);
        for (size_t p = 0; p < joint.positions; ++p)
            if (joint.at[p]->has(kKinds[kind].event, kKinds[kind].scattering, carried)) set(m, p);
        m.back() = kind == kStraightKind;
        const auto [i, fresh] = known.try_emplace(m, uint16_t(known.size()));
        if (fresh) matching.push_back(m);
        classOf_[kind * sets + labelSet(labels_.size(), a, b)] = i->second;
    };
    const int labels = int(labels_.size());
    for (size_t kind = 0; kind < kKindCount; ++kind)
        for (int a = -1; a < labels; ++a)
            for (int b = a < 0 ? -1 : a; b < labels; ++b) {
                classify(kind, a, b == a ? -1 : b);
                if (a < 0) break;
            }
    classes_ = matching.size();

    countsStraight_ = std::any_of(texts.begin(), texts.end(), [](const LightPathText& t) { return t.straight; });
    std::unordered_map<Places, State, Hash> numbers;
    std::deque<Places> states(1, Places(joint.words, ~uint64_t(0))); // of kNone, which nothing leads to; number() adds to it
    const auto number = [&](const Places& p) {
        const auto [i, fresh] = numbers.try_emplace(p, State(states.size()));
        if (fresh) states.push_back(p);
        return i->second;
    };
    table_.assign(classes_, kNone);
    number(Places(joint.words, 0)); // kDead
    const State start = number(joint.begin);
    for (size_t s = kDead; s < states.size(); ++s) {
        if (states.size() > kMostStates || states.size() * classes_ > kMostTable) {
            why = "they need more than " + std::to_string(std::min(kMostStates, kMostTable / classes_)) + " states";
            return false;
        }
        const Places& here = states[s];
        const Places reach = joint.reach(here);
        for (const Places& m : matching) {
            Places to(joint.words);
            for (size_t w = 0; w < joint.words; ++w)
                to[w] = m.back() ? (reach[w] & m[w] & ~joint.silent[w]) | (here[w] & joint.silent[w]) : reach[w] & m[w];
            table_.push_back(number(to));
        }
    }
    begin_ = next(start, symbol(PathEvent::Camera));
    std::vector<uint64_t> accepts;
    for (const Places& p : states) accepts.push_back(joint.endsIn(p));
    accepts[kNone] = 0;
    partsOf_.assign(std::max(partsOf_.size(), texts.size() + 1), {});
    return makeParts(accepts, why);
}

/// Numbers the sets of expressions that a path which ends with light can match. `accepts`: by state.
bool LightPaths::makeParts(std::span<const uint64_t> accepts, std::string& why) {
    std::vector<char> ends(accepts.size(), 0);
    const size_t sets = labelSets(labels_.size());
    for (size_t s = kDead; s < accepts.size(); ++s)
        for (size_t kind = 0; kind < kKindCount; ++kind)
            for (size_t l = 0; l < sets && (kKinds[kind].event >= PathEvent::Light); ++l)
                ends[next(State(s), int(kind * sets + l))] = 1;
    partOf_.assign(accepts.size(), 0);
    std::map<uint64_t, int> known{{0, 0}};
    for (size_t s = kDead; s < accepts.size(); ++s) {
        if (!ends[s]) continue;
        const auto [i, fresh] = known.try_emplace(accepts[s], int(known.size()));
        partOf_[s] = uint8_t(std::min<int>(i->second, 255));
        for (size_t e = 0; fresh && e < kMostOutputs; ++e)
            if (accepts[s] >> e & 1) partsOf_[e].push_back(i->second);
    }
    parts_ = int(known.size());
    if (known.size() <= kMostParts) return true;
    why = "light falls into more than " + std::to_string(kMostParts) + " parts";
    return false;
}

} // namespace alpenglow::scene

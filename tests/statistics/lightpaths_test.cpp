// Light path expressions: what they mean, against a matcher that knows nothing of automata; what is wrong in one; and sums that
// are exact by construction.
#include "render/film.h"
#include "scene/lightpaths.h"
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck.h>
#include <set>

namespace lightpaths_test {

using namespace alpenglow;
using scene::LightPaths;
using scene::PathEvent;
using scene::PathScattering;

namespace {

struct Event {
    PathEvent event;
    PathScattering how;
    std::vector<std::string> labels;
};
using Path = std::vector<Event>;

const std::vector<std::string> kLabels = {"key", "fill"};

/// An expression as a tree, which knows its text and how to match.
struct Tree {
    enum Kind { One, Sequence, Either, Repeat } kind = One;
    std::vector<Tree> of;
    int least = 0, most = 0; ///< Repeat; most -1: any number
    std::string text;        ///< One
    uint8_t events = 0xff, how = 0xff;
    int label = -1;
    bool negated = false;

    bool meets(const Event& e) const {
        bool in = (events >> int(e.event) & 1) && (how >> int(e.how) & 1);
        if (label >= 0) in = in && std::find(e.labels.begin(), e.labels.end(), kLabels[size_t(label)]) != e.labels.end();
        return in != negated;
    }
    std::string print() const {
        if (kind == One) return text;
        std::string s;
        for (size_t i = 0; i < of.size(); ++i) s += (i && kind == Either ? "|" : "") + of[i].print();
        if (kind != Repeat) return "(" + s + ")";
        const std::string count = "{" + std::to_string(least) + (most < 0 ? ",}" : "," + std::to_string(most) + "}");
        return s + (least == 0 && most < 0 ? "*" : least == 1 && most < 0 ? "+" : least == 0 && most == 1 ? "?" : count);
    }
    /// Where a match that begins at `from` may end.
    std::set<size_t> ends(const Path& p, size_t from) const {
        if (kind == One) return from < p.size() && meets(p[from]) ? std::set<size_t>{from + 1} : std::set<size_t>{};
        std::set<size_t> at{from}, all;
        const auto step = [&](const Tree& t) {
            std::set<size_t> next;
            for (size_t a : at) next.merge(t.ends(p, a));
            at = next;
        };
        if (kind == Either) {
            for (const Tree& t : of) all.merge(t.ends(p, from));
            return all;
        }
        if (kind == Sequence) {
            for (const Tree& t : of) step(t);
            return at;
        }
        for (int k = 0; !at.empty() && k <= (most < 0 ? int(p.size()) + least : most); ++k) {
            if (k >= least) all.insert(at.begin(), at.end());
            step(of[0]);
        }
        return all;
    }
};

struct Maker {
    std::mt19937 random;
    bool straight = false;
    int below(int n) { return int(random() % uint32_t(n)); }

    Tree one() {
        static const std::string events = "CRTVLBO", hows = "DGSs";
        const auto eventBits = [&](int k) { return uint8_t(k == 4 ? 1 << 4 | 1 << 5 : 1 << k); };
        Tree t;
        const int what = below(6), e = below(7), h = below(4), l = below(2);
        const auto how = [&] {
            straight |= h == 3;
            return uint8_t(1 << (h + 1));
        };
        if (what == 0) t.text = ".";
        else if (what == 1) t.text = events[size_t(e)], t.events = eventBits(e);
        else if (what == 2) t.text = hows[size_t(h)], t.how = how();
        else if (what == 3)
            t.text = std::string("<") + events[size_t(e)] + hows[size_t(h)] + ">", t.events = eventBits(e), t.how = how();
        else if (what == 4)
            t.text = std::string("<") + events[size_t(e)] + ".'" + kLabels[size_t(l)] + "'>", t.events = eventBits(e),
            t.label = l;
        else t.text = std::string("[^") + events[size_t(e)] + "]", t.events = eventBits(e), t.negated = true;
        return t;
    }
    Tree tree(int depth) {
        const int what = depth > 3 ? 0 : below(5);
        if (what < 2) return one();
        Tree t;
        t.kind = Tree::Kind(what - 1);
        const int children = t.kind == Tree::Repeat ? 1 : 1 + below(3);
        for (int i = 0; i < children; ++i) t.of.push_back(tree(depth + 1));
        if (t.kind == Tree::Repeat) {
            t.least = below(3);
            t.most = below(2) ? -1 : std::max(1, t.least + below(2));
            if (t.of[0].kind == Tree::Repeat) { // braces behind a star: the tree says it by parentheses
                Tree around;
                around.kind = Tree::Sequence;
                around.of = t.of;
                t.of = {around};
            }
        }
        return t;
    }
    Event event() {
        const int e = below(7);
        Event r{PathEvent(e), PathScattering::None, {}};
        if (e == 1) r.how = PathScattering(1 + below(3));
        if (e == 2) r.how = PathScattering(1 + below(4));
        if (below(3) == 0) r.labels.push_back(kLabels[size_t(below(2))]);
        if (below(6) == 0) r.labels.push_back(kLabels[size_t(below(2))]);
        return r;
    }
};

/// Whether the outputs have the light of a path, by expression.
std::vector<bool> shows(const LightPaths& l, const Path& path, size_t outputs) {
    LightPaths::State s = l.begin();
    for (size_t i = 1; i < path.size(); ++i) {
        const Event& e = path[i];
        int label[2] = {-1, -1};
        for (size_t k = 0; k < std::min<size_t>(2, e.labels.size()); ++k) label[k] = l.label(e.labels[k]);
        s = l.next(s, l.symbol(e.event, e.how, label[0], label[1]));
    }
    std::vector<bool> in;
    for (size_t k = 0; k < outputs; ++k) in.push_back(std::count(l.partsOf(k).begin(), l.partsOf(k).end(), l.part(s)) > 0);
    return in;
}

TEST(LightPathExpressions, AgreeWithAMatcherThatTriesEverything) {
    int matched = 0;
    const auto holds = [&](uint32_t seed) {
        Maker m{std::mt19937(seed)};
        std::vector<LightPaths::Source> sources;
        std::vector<Tree> trees;
        std::vector<bool> straight;
        for (int k = 0; k < 3; ++k) {
            m.straight = false;
            Tree t;
            t.kind = Tree::Sequence;
            Tree camera;
            camera.text = "C", camera.events = 1;
            t.of = {camera, m.tree(0)};
            trees.push_back(t);
            sources.push_back({"C" + t.of[1].print(), {}});
            straight.push_back(m.straight);
        }
        sources.push_back({"other", {}});
        Diagnostics d;
        const LightPaths l(sources, d);
        for (int n = 0; n < 40; ++n) {
            Path path{{PathEvent::Camera, PathScattering::None, {}}};
            for (int k = m.below(6); k > 0; --k) path.push_back(m.event());
            path.push_back({PathEvent(4 + m.below(3)), PathScattering::None, {}});
            if (m.below(2)) path.back().labels.push_back(kLabels[size_t(m.below(2))]);
            const std::vector<bool> in = shows(l, path, 4);
            bool any = false;
            for (size_t k = 0; k < 3; ++k) {
                Path seen;
                for (const Event& e : path)
                    if (straight[k] || e.how != PathScattering::Straight) seen.push_back(e);
                const bool is = trees[k].ends(seen, 0).count(seen.size()) > 0;
                any |= is;
                matched += is;
                RC_ASSERT(in[k] == is);
            }
            RC_ASSERT(in[3] == !any);
        }
    };
    EXPECT_TRUE(rc::check("automaton", [&](uint32_t seed) { holds(seed); }));
    EXPECT_GT(matched, 50); // not only that nothing matches
}

/// Messages of expressions.
std::string said(const std::vector<std::string>& expressions) {
    std::vector<LightPaths::Source> sources;
    for (const std::string& e : expressions) sources.push_back({e, {"scene.rib", 7, 3}});
    Diagnostics d;
    const LightPaths l(sources, d);
    std::string all;
    for (const Diagnostic& m : d.all()) all += m.message + " (" + m.hint + ")\n";
    return all;
}

TEST(LightPathExpressions, TheUsualNotation) {
    EXPECT_EQ(scene::lightPathIn("lpe:C<RD>L"), "C<RD>L");
    EXPECT_EQ(scene::lightPathIn(" color lpe: C.*L"), " C.*L");
    EXPECT_FALSE(scene::lightPathIn("direct"));
    for (const char* good :
         {"C<RD>L", "C<RD>[<L.>O]", "C<RS>[DS]+[<L.>O]", "C[<RD><RG>].*<L.'key'>", "C(D|G){1,2}S*O", "C<[RT][DG]>L", "C<R[^D]>B",
          "C<RD'diffuse'>.*[LO]", "C<.D[^'a''b']>L", "C <T s>* L", "C[^S]*O", "C<TS>+<L.\"key\">", "CD{2}L", "CD{2,}L", "C<L>"})
        EXPECT_EQ(said({good}), "") << good;
    for (const char* word : {"direct", "indirect"}) EXPECT_EQ(said({*scene::lightPathOfWord(word)}), "") << word;
}

TEST(LightPathExpressions, WhatIsWrongIsSaidWithItsPlace) {
    const std::pair<const char*, const char*> cases[] = {{"C<RX>L", "character 4: \"X\" is not a scattering"},
                                                         {"C<XD>L", "character 3: \"X\" is not an event"},
                                                         {"C<RD>l", "did you mean L?"},
                                                         {"C(DL", "character 5: \")\" is missing"},
                                                         {"CD)L", "character 3: \")\" closes nothing"},
                                                         {"C[DL", "\"]\" is missing"},
                                                         {"C<RDL", "character 5: a label in quotes is missing"},
                                                         {"C<L.'key>", "the quote is not closed"},
                                                         {"C<L.''>", "a label is empty"},
                                                         {"C||L", "an event is missing"},
                                                         {"", "character 1: an event is missing"},
                                                         {"CD{x}L", "character 4: a number is missing"},
                                                         {"CD{3,2}L", "n up to m"},
                                                         {"CD{0}L", "m not 0"},
                                                         {"CU2L", "lobes have no numbers"},
                                                         {"CD1L", "lobes have no numbers"},
                                                         {"unoccluded;C<RD>L", "is not available"},
                                                         {"holdout;CL", "is not available"},
                                                         {"*", "character 1"},
                                                         {"C<RD>", "matches no path"},
                                                         {"LC", "matches no path"},
                                                         {"CD{4000}L", "more than 1024 events"}};
    for (const auto& [expression, message] : cases)
        EXPECT_NE(said({expression}).find(message), std::string::npos) << expression << ": " << said({expression});
}

TEST(LightPathExpressions, WhatIsTooLargeIsSaid) {
    EXPECT_NE(said({std::string(LightPaths::kMostLength + 1, 'C')}).find("characters"), std::string::npos);
    EXPECT_NE(said({"C" + std::string(LightPaths::kMostDepth + 2, '(') + "D"}).find("deep"), std::string::npos);
    EXPECT_NE(said({"C((D{100}){100}){100}L"}).find(std::to_string(LightPaths::kMostPositions)), std::string::npos);
    std::vector<std::string> many;
    for (size_t k = 0; k < LightPaths::kMostOutputs + 1; ++k) many.push_back("CD{" + std::to_string(k + 1) + "}L");
    EXPECT_NE(said(many).find("more than"), std::string::npos);
    // The k-th event from the end: 2^k states.
    EXPECT_NE(said({"C.*D.{20}L"}).find("states"), std::string::npos) << LightPaths::kMostStates << " " << LightPaths::kMostTable;
    std::string labels = "C";
    for (size_t k = 0; k <= LightPaths::kMostLabels; ++k) labels += "<L.'" + std::to_string(k) + "'>";
    EXPECT_NE(said({labels}).find("labels"), std::string::npos);
    std::vector<std::string> overlapping; // every set of these is a part
    for (int k = 0; k < 7; ++k) overlapping.push_back("C.*<R.'" + std::to_string(k) + "'>.*L");
    EXPECT_NE(said(overlapping).find(std::to_string(LightPaths::kMostParts) + " parts"), std::string::npos);
    EXPECT_EQ(said({"C<RX>L", "CL"}).find("\"CL\""), std::string::npos); // the others stay
}

TEST(LightPathExpressions, PartsOfAPixelAddUpToItsIntegers) {
    using namespace render;
    FilmDescription d;
    d.width = d.height = 1;
    d.window = {0, 0, 1, 1};
    for (int part = 0; part < 3; ++part)
        for (int k = 0; k < 3; ++k)
            d.channels.push_back({std::to_string(part * 3 + k), ChannelRule(int(ChannelRule::PartOfRed) + k)});
    Film film(d);
    std::mt19937 random(3);
    for (uint32_t s = 0; s < 1000; ++s) {
        float values[9];
        Color sum(0);
        for (int i = 0; i < 9; ++i) {
            values[i] = float(random() % 1000) * std::ldexp(1.f, int(random() % 40) - 30);
            sum[i % 3] += values[i];
        }
        film.add(0, 0, s, {.radiance = sum, .alpha = 1, .aovs = values});
    }
    for (int k = 0; k < 3; ++k) {
        Int128 all = 0;
        for (int part = 0; part < 3; ++part) all += film.fixedAov(0, 0, part * 3 + k);
        EXPECT_TRUE(all == film.fixed(0, 0, k)) << k;
    }
}

} // namespace

} // namespace lightpaths_test

// Random requests made of the table's samples, shuffled and damaged: nothing crashes, and what reaches a frame keeps the promises
// that scene/scene.h makes about primitives.
#include "collect.h"
#include "ri/requests/request.h"
#include "scene/counts.h"
#include <cmath>
#include <random>

namespace random_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

std::vector<std::string> words(const std::string& s) {
    std::vector<std::string> w;
    std::string item;
    for (char c : s + " ") {
        if (c != ' ') item += c;
        else if (!item.empty()) w.push_back(std::move(item)), item.clear();
    }
    return w;
}

void checkPromises(const scene::Primitive& p, const std::string& text) {
    ASSERT_NE(p.attributes, nullptr);
    scene::VariableCounts c;
    std::string why;
    ASSERT_TRUE(scene::variableCounts(p, &c, &why)) << p.kind << why << text;
    for (float f : p.numbers) ASSERT_TRUE(std::isfinite(f)) << text;
    int positions = 0;
    for (const scene::Param& v : p.params) {
        if (v.name == "P" || v.name == "Pw" || v.name == "Pz") ++positions;
        if (v.name == "uknot" || v.name == "vknot" || v.name.ends_with("args")) continue;
        size_t want = size_t(c.of(v.cls)) * size_t(std::max(v.arrayLength, 1)) * size_t(scene::componentCount(v.type));
        ASSERT_EQ(v.type == scene::Type::String ? v.strings.size() : v.numbers.size(), want) << p.kind << " " << v.name << "\n"
                                                                                             << text;
        for (float f : v.numbers) ASSERT_TRUE(std::isfinite(f)) << text;
    }
    if (c.vertex > 4 || p.kind == "Polygon") ASSERT_LE(positions, 1) << text;
    ASSERT_TRUE(p.motionKeys.empty() || p.motionTimes.size() == p.motionKeys.size() + 1) << text;
    for (auto& k : p.motionKeys) checkPromises(*k, text);
    ASSERT_EQ(p.toWorld.times.size(), p.toWorld.keys.size());
}

} // namespace

TEST(Random, RequestsKeepTheirPromises) {
    std::mt19937 random(20240607);
    auto below = [&](size_t n) { return size_t(random() % n); };
    const auto& table = requestTable();
    const char* junk[] = {"[",          "]",     "\"",
                          "-1",         "0",     "1e30",
                          "2147483647", "1e-30", "\"P\"",
                          "\"x\"",      "foo",   "\"varying color q\"",
                          "[1 2 3]",    "[]",    "\"nonperiodic\"",
                          "#"};
    size_t primitives = 0;
    for (int round = 0; round < 4000; ++round) {
        std::string text = below(4) ? "WorldBegin\n" : "";
        size_t n = 3 + below(25);
        for (size_t i = 0; i < n; ++i) {
            const Request& r = table[below(table.size())];
            if (r.name == "ReadArchive" || r.name == "Procedural") continue; // files are no business of this test
            std::vector<std::string> w = words(std::string(r.sample));
            while (!w.empty() && below(5) == 0) {
                size_t k = below(w.size());
                switch (below(4)) {
                case 0:
                    w.erase(w.begin() + std::ptrdiff_t(k));
                    break;
                case 1:
                    w[k] = junk[below(std::size(junk))];
                    break;
                case 2:
                    w.insert(w.begin() + std::ptrdiff_t(k), junk[below(std::size(junk))]);
                    break;
                default:
                    std::swap(w[k], w[below(w.size())]);
                }
            }
            text += std::string(r.name);
            for (auto& s : w) text += " " + s;
            text += "\n";
        }
        auto c = read(text);
        for (auto& f : c->frames) {
            for (auto& p : f->primitives) checkPromises(*p, text);
            for (auto& o : f->objects)
                for (auto& p : o.primitives) {
                    checkPromises(*p, text);
                    for (int l : p->attributes->lights) ASSERT_LT(size_t(l), f->lights.size()) << text;
                    ASSERT_LT(p->attributes->areaLight, int(f->lights.size())) << text;
                }
            for (auto& i : f->instances) ASSERT_LT(size_t(i.object), f->objects.size());
            for (auto& p : f->primitives) {
                for (int l : p->attributes->lights) ASSERT_LT(size_t(l), f->lights.size()) << text;
                ASSERT_LT(p->attributes->areaLight, int(f->lights.size())) << text;
            }
            primitives += f->primitives.size();
        }
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(primitives, 1000u); // the damage is not so great that nothing is left to check
}

} // namespace random_test

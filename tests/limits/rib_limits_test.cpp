// What a RIB stream may cost.
#include "base/limits.h"
#include "ri/collect.h"
#include "ri/source.h"
#include <zlib.h>

namespace rib_limits_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

std::string repeat(const std::string& s, int n) {
    std::string r;
    for (int i = 0; i < n; ++i) r += s;
    return r;
}

std::string gzip(const std::string& text) {
    z_stream z{};
    EXPECT_EQ(deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY), Z_OK);
    std::string out(compressBound(uLong(text.size())) + 64, '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = uInt(text.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
    out.resize(out.size() - z.avail_out);
    deflateEnd(&z);
    return out;
}

} // namespace

TEST(RibLimits, InflatedBytes) {
    // The same code with a smaller number: kGzipBytes is 64 GiB.
    static_assert(limits::kGzipBytes >= size_t(1) << 30);
    const std::string text(100'000, ' '), packed = gzip(text);
    for (size_t most : {text.size(), text.size() - 1}) {
        auto s = inflating(memorySource(packed), most);
        std::vector<char> out(8192);
        size_t total = 0;
        for (size_t n; (n = s->read(out.data(), out.size())) > 0;) total += n;
        EXPECT_EQ(s->limitHit(), most < text.size());
        EXPECT_EQ(s->failure().empty(), most == text.size());
        EXPECT_LE(total, most);
    }
}

TEST(RibLimits, NestingOfConditions) {
    // The comparison inside counts as one: the innermost number is at depth n + 1.
    auto condition = [](int n) {
        return inWorld("IfBegin \"" + std::string(size_t(n), '(') + "1" + std::string(size_t(n), ')') +
                       "\"\nSphere 1 -1 1 360\nIfEnd");
    };
    auto below = condition(limits::kConditionDepth - 1);
    EXPECT_EQ(below->count(), 0u) << below->messages();
    EXPECT_EQ(below->frame().primitives.size(), 1u);
    auto beyond = condition(limits::kConditionDepth);
    EXPECT_EQ(beyond->only().place.line, 2);
    EXPECT_NE(beyond->only().message.find("nested too deeply"), std::string::npos);
    EXPECT_GE(condition(1'000'000)->count(), 1u); // and no deep recursion
}

TEST(RibLimits, Lights) {
    static_assert(limits::kLights >= 1'000'000); // the same code with a smaller number
    ReaderOptions options;
    options.mostLights = 100;
    auto c = read("WorldBegin\n" + repeat("LightSource \"pointlight\" 1\n", 150) + "Sphere 1 -1 1 360\nWorldEnd\n", options);
    EXPECT_EQ(c->only().code, Rie::Limit);
    EXPECT_EQ(c->only().place.line, 102);
    EXPECT_EQ(c->frame().lights.size(), 100u);
    EXPECT_EQ(c->frame().primitives.size(), 1u);
}

TEST(RibLimits, LightsInARow) {
    // Each kept the list of those before it: 30,000 took 2.3 GB.
    auto c = inWorld(repeat("LightSource \"pointlight\" 1\n", 1000) + "Sphere 1 -1 1 360\n");
    size_t listed = 0;
    for (const scene::Light& l : c->frame().lights) listed += l.attributes->lights.size();
    EXPECT_EQ(listed, 0u);
    EXPECT_EQ(c->primitive().attributes->lights.size(), 1000u);
}

TEST(RibLimits, CopiesOfObjectsInObjects) {
    // An object of 500 spheres, copied into another: 500 times make the limit, once more exceeds it.
    const int spheres = 500, times = int(limits::kObjectCopies) / spheres;
    const std::string first = "ObjectBegin 1\n" + repeat("Sphere 1 -1 1 360\n", spheres) + "ObjectEnd\n";
    for (int extra : {0, 1}) {
        auto c =
            inWorld(first + "ObjectBegin 2\n" + repeat("ObjectInstance 1\n", times + extra) + "ObjectEnd\nObjectInstance 2\n");
        if (extra == 0) EXPECT_EQ(c->count(), 0u) << c->messages();
        else EXPECT_EQ(c->only().code, Rie::Limit);
        EXPECT_EQ(c->frame().instances.size(), 1u);
    }
}

} // namespace rib_limits_test

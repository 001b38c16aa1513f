// Code generation from kernels made by hand: every construct of the IR against values worked out here.
#include "handmade.h"
#include <cmath>
#include <cstring>

namespace alpenglow::rsl::test::codegen_test {
namespace {

TEST(Codegen, ArithmeticEverywhere) {
    Made m;
    Inst *x = m.input("x"), *y = m.input("y"), *k = m.input("k", Kind::Float, true);
    Inst* sum = m.put(Op::Add, Kind::Float, {m.put(Op::Mul, Kind::Float, {x, k}), y});
    Inst* quotient = m.put(Op::Div, Kind::Float, {sum, y});
    Inst* less = m.put(Op::Less, Kind::Bool, {x, y});
    Inst* pick = m.put(Op::Select, Kind::Float, {less, x, m.put(Op::Neg, Kind::Float, {y})});
    Inst* t = m.put(Op::Triple, Kind::Triple, {sum, quotient, pick});
    m.output("t", t);
    m.output("b", m.put(Op::ToFloat, Kind::Float, {m.put(Op::Not, Kind::Bool, {less})}));
    m.output("u", m.put(Op::Mul, Kind::Float, {k, k}));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        EXPECT_EQ(kernel->lanes(), o.lanes * o.vectors > 64 ? 64 : o.lanes * o.vectors);
        Batch run;
        auto value = [](int i, int n, int) { return i == 0 ? 0.37f * float(n) - 9 : i == 1 ? float(n % 7) - 2 : 1.7f; };
        run(*kernel, o, value);
        for (int n = 0; n < kPoints; n++) {
            const float a = value(0, n, 0), b = value(1, n, 0), c = 1.7f;
            const float s = a * c + b;
            EXPECT_EQ(run(0, 0, n), s);
            EXPECT_EQ(run(0, 1, n), b == 0 ? 0.0f : s / b);
            EXPECT_EQ(run(0, 2, n), a < b ? a : -b);
            EXPECT_EQ(run(1, 0, n), a < b ? 0.0f : 1.0f);
            EXPECT_EQ(run(2, 0, n), c * c);
        }
    }
}

// x^3 / (1 + y), x = u, y = u v, with first and second derivatives.
// A function so large that it gets the register allocator that does not take time for it (jit/llvm/allocator.h): a hundred
// values that are all alive, against the same arithmetic here.
TEST(Codegen, VeryLargeFunctions) {
    constexpr size_t kAlive = 100, kSteps = 24000;
    const auto other = [](size_t step) { return step * 7 % (kAlive - 1); };
    Made m;
    Inst *x = m.input("x"), *half = m.number(.5f);
    std::vector<Inst*> v(kAlive, x);
    for (size_t s = 0; s < kSteps; ++s) {
        Inst*& at = v[s % kAlive];
        at = m.put(Op::Add, Kind::Float, {m.put(Op::Mul, Kind::Float, {at, half}), v[other(s)]});
        at = m.put(Op::Sub, Kind::Float, {at, m.put(Op::Mul, Kind::Float, {v[other(s + 1)], half})});
    }
    m.output("first", v.front());
    m.output("last", v.back());
    const KernelOptions o = configurations().front();
    auto kernel = compile(m, o);
    ASSERT_TRUE(kernel);
    Batch run;
    const auto value = [](int, int n, int) { return .01f * float(n) - .7f; };
    run(*kernel, o, value);
    for (int n = 0; n < kPoints; n++) {
        std::vector<float> w(kAlive, value(0, n, 0));
        for (size_t s = 0; s < kSteps; ++s) {
            float& at = w[s % kAlive];
            at = at * .5f + w[other(s)];
            at = at - w[other(s + 1)] * .5f;
        }
        ASSERT_TRUE(std::isfinite(w.front()) && std::isfinite(w.back()));
        ASSERT_EQ(run(0, 0, n), w.front()) << n;
        ASSERT_EQ(run(1, 0, n), w.back()) << n;
    }
}

TEST(Codegen, Jets) {
    Made m;
    Inst *x = m.input("x", Kind::Float, false, 2), *y = m.input("y", Kind::Float, false, 2);
    auto order = [](Inst* i, int k) {
        i->order = uint8_t(k);
        return i;
    };
    Inst* cube = order(m.put(Op::Mul, Kind::Float, {order(m.put(Op::Mul, Kind::Float, {x, x}), 2), x}), 2);
    Inst* one = m.number(1);
    Inst* q = order(m.put(Op::Div, Kind::Float, {cube, order(m.put(Op::Add, Kind::Float, {one, y}), 2)}), 2);
    Inst *du = order(m.put(Op::Du, Kind::Float, {q}), 1), *dv = order(m.put(Op::Dv, Kind::Float, {q}), 1);
    m.output("du", du);
    m.output("dv", dv);
    m.output("duu", m.put(Op::Du, Kind::Float, {du}));
    m.output("duv", m.put(Op::Dv, Kind::Float, {du}));
    m.output("dvv", m.put(Op::Dv, Kind::Float, {dv}));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        auto u = [](int n) { return 0.2f + 0.01f * float(n); };
        auto v = [](int n) { return 0.5f + 0.02f * float(n % 11); };
        run(*kernel, o, [&](int i, int n, int row) {
            const float jx[6] = {u(n), 1, 0, 0, 0, 0}, jy[6] = {u(n) * v(n), v(n), u(n), 0, 1, 0};
            return i == 0 ? jx[row] : jy[row];
        });
        for (int n = 0; n < kPoints; n++) {
            const double a = u(n), b = v(n), d = 1 + a * b;
            // f = a^3/d. With d_a = b, d_b = a:
            const double fa = 3 * a * a / d - a * a * a * b / (d * d), fb = -a * a * a * a / (d * d);
            const double faa = 6 * a / d - 6 * a * a * b / (d * d) + 2 * a * a * a * b * b / (d * d * d);
            const double fab = -4 * a * a * a / (d * d) + 2 * a * a * a * a * b / (d * d * d);
            const double fbb = 2 * a * a * a * a * a / (d * d * d);
            const double expected[5] = {fa, fb, faa, fab, fbb};
            for (int k = 0; k < 5; k++)
                EXPECT_NEAR(run(k, 0, n), expected[k], 2e-6 * (1 + std::abs(expected[k]))) << k << " at " << n;
        }
    }
}

// sum = 0; i = 0; while (i < x) { if (x > 5) sum += i; else sum += 2 i; i += 1 }
TEST(Codegen, VaryingLoopAndIf) {
    Made m;
    Inst *x = m.input("x"), *zero = m.number(0), *one = m.number(1), *five = m.number(5);
    Inst* loop = m.k.make(Op::Loop, Kind::None, {zero, zero});
    loop->results = {Kind::Float, Kind::Float};
    loop->regions.resize(2);
    auto &test = loop->regions[0], &body = loop->regions[1];
    Inst* i0 = m.param(test, Kind::Float);
    m.param(test, Kind::Float);
    m.regions.push_back(&test);
    test.yields = {m.put(Op::Less, Kind::Bool, {i0, x})};
    m.regions.back() = &body;
    Inst *i1 = m.param(body, Kind::Float), *sum = m.param(body, Kind::Float);
    Inst* big = m.put(Op::Less, Kind::Bool, {five, x});
    Inst* branch = m.k.make(Op::If, Kind::None, {big});
    branch->results = {Kind::Float};
    branch->regions.resize(2);
    m.regions.push_back(&branch->regions[0]);
    branch->regions[0].yields = {m.put(Op::Add, Kind::Float, {sum, i1})};
    m.regions.back() = &branch->regions[1];
    branch->regions[1].yields = {m.put(Op::Add, Kind::Float, {sum, m.put(Op::Add, Kind::Float, {i1, i1})})};
    m.regions.pop_back();
    body.body.push_back(branch);
    Inst* chosen = m.put(Op::Result, Kind::Float, {branch}, 0);
    body.yields = {m.put(Op::Add, Kind::Float, {i1, one}), chosen};
    m.regions.pop_back();
    m.k.body.body.push_back(loop);
    m.output("sum", m.put(Op::Result, Kind::Float, {loop}, 1));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        auto value = [](int, int n, int) { return float(n % 13) - 1.5f; };
        run(*kernel, o, value);
        for (int n = 0; n < kPoints; n++) {
            float expected = 0;
            const float given = value(0, n, 0);
            for (float i = 0; i < given; i += 1) expected += given > 5 ? i : 2 * i;
            EXPECT_EQ(run(0, 0, n), expected) << n;
        }
    }
}

// while (1): ends because the caller says so.
TEST(Codegen, EndlessLoopStops) {
    Made m;
    Inst *x = m.input("x"), *one = m.number(1);
    Inst* loop = m.k.make(Op::Loop, Kind::None, {x});
    loop->results = {Kind::Float};
    loop->regions.resize(2);
    m.regions.push_back(&loop->regions[0]);
    Inst* p0 = m.param(loop->regions[0], Kind::Float);
    loop->regions[0].yields = {m.put(Op::Equal, Kind::Bool, {p0, p0})};
    m.regions.back() = &loop->regions[1];
    Inst* p = m.param(loop->regions[1], Kind::Float);
    loop->regions[1].yields = {m.put(Op::Add, Kind::Float, {p, one})};
    m.regions.pop_back();
    m.k.body.body.push_back(loop);
    m.output("y", m.put(Op::Result, Kind::Float, {loop}, 0));
    KernelOptions o;
    auto kernel = compile(m, o);
    ASSERT_TRUE(kernel);
    Batch run;
    StopFlag stop{1};
    run.call.stop = &stop;
    run(*kernel, o, [](int, int n, int) { return float(n); });
    EXPECT_EQ(run(0, 0, 3), 3.0f);
}

// a[10], a[k] = k^2 for k = 0..9 by a uniform loop; result a[x] with x outside too; b[20] scattered and gathered.
TEST(Codegen, Arrays) {
    Made m;
    Inst *x = m.input("x"), *zero = m.number(0), *one = m.number(1), *ten = m.number(10);
    Inst* a = m.put(Op::ArrayNew, Kind::Array, {}, 10);
    a->element = Kind::Float;
    Inst* b = m.put(Op::ArrayNew, Kind::Array, {}, 20);
    b->element = Kind::Triple;
    Inst* loop = m.k.make(Op::Loop, Kind::None, {zero});
    loop->results = {Kind::Float};
    loop->regions.resize(2);
    m.regions.push_back(&loop->regions[0]);
    Inst* p0 = m.param(loop->regions[0], Kind::Float);
    loop->regions[0].yields = {m.put(Op::Less, Kind::Bool, {p0, ten})};
    m.regions.back() = &loop->regions[1];
    Inst* p = m.param(loop->regions[1], Kind::Float);
    m.put(Op::ArrayStore, Kind::None, {a, p, m.put(Op::Mul, Kind::Float, {p, p})});
    loop->regions[1].yields = {m.put(Op::Add, Kind::Float, {p, one})};
    m.regions.pop_back();
    m.k.body.body.push_back(loop);
    Inst* branch = m.k.make(Op::If, Kind::None, {m.put(Op::Less, Kind::Bool, {zero, x})});
    branch->regions.resize(2);
    m.regions.push_back(&branch->regions[0]);
    m.put(Op::ArrayStore, Kind::None, {b, x, m.put(Op::Triple, Kind::Triple, {x, one, ten})});
    m.regions.pop_back();
    m.k.body.body.push_back(branch);
    m.output("a", m.put(Op::ArrayLoad, Kind::Float, {a, x}));
    m.output("b", m.put(Op::ArrayLoad, Kind::Triple, {b, x}));
    m.output("c", m.put(Op::ArrayLoad, Kind::Triple, {b, m.number(3)}));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        auto value = [](int, int n, int) { return float(n) * 0.5f - 5; };
        run(*kernel, o, value);
        for (int n = 0; n < kPoints; n++) {
            const float given = value(0, n, 0);
            const int ka = std::min(9, std::max(0, int(given))), kb = std::min(19, std::max(0, int(given)));
            EXPECT_EQ(run(0, 0, n), float(ka * ka)) << n;
            EXPECT_EQ(run(1, 0, n), given > 0 ? given : 0.0f) << n;
            EXPECT_EQ(run(1, 2, n), given > 0 ? 10.0f : 0.0f) << n;
            EXPECT_EQ(run(2, 0, n), kb == 3 && given > 0 ? given : 0.0f) << n;
        }
    }
}

TEST(Codegen, ArrayInputs) {
    Made m;
    Inst* x = m.input("x");
    for (bool uniform : {true, false}) {
        ir::Input in;
        in.name = uniform ? "u" : "v";
        in.kind = Kind::Triple;
        in.array = 18;
        in.uniform = uniform;
        m.k.inputs.push_back(in);
        Inst* a = m.put(Op::ArrayInput, Kind::Array, {}, int(m.k.inputs.size()) - 1);
        a->element = Kind::Triple;
        m.output(in.name.c_str(), m.put(Op::ArrayLoad, Kind::Triple, {a, x}));
    }
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        run(*kernel, o,
            [](int i, int n, int row) { return i == 0 ? float(n % 18) : float(row) + (i == 2 ? 100.0f * float(n) : 0); });
        for (int n = 0; n < kPoints; n++)
            for (int c = 0; c < 3; c++) {
                EXPECT_EQ(run(0, c, n), float(n % 18 * 3 + c));
                EXPECT_EQ(run(1, c, n), float(n % 18 * 3 + c) + 100.0f * float(n));
            }
    }
}

// A service under a mask: it is given the lanes, its arguments and the place of its results; strings are ids.
TEST(Codegen, ServicesSeeTheMask) {
    Made m;
    Inst *x = m.input("x"), *zero = m.number(0);
    Inst* text = m.put(Op::ConstString, Kind::String);
    text->text = "rose";
    Inst* branch = m.k.make(Op::If, Kind::None, {m.put(Op::Less, Kind::Bool, {zero, x})});
    branch->results = {Kind::Float};
    branch->regions.resize(2);
    m.regions.push_back(&branch->regions[0]);
    Inst* call = m.put(Op::Service, Kind::Float, {x, text});
    call->site = m.site("test");
    branch->regions[0].yields = {call};
    m.regions.pop_back();
    branch->regions[1].yields = {zero};
    m.k.body.body.push_back(branch);
    m.output("y", m.put(Op::Result, Kind::Float, {branch}, 0));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        int lanesServed = 0;
        run.call.user = &lanesServed;
        run.call.service = [](KernelCall* c, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in,
                              float* out) {
            EXPECT_EQ(site, 0);
            for (int l = 0; l < lanes; l++) {
                if (!(mask >> l & 1)) continue;
                EXPECT_LT(first + l, kPoints);
                int32_t id;
                std::memcpy(&id, in + lanes + l, 4);
                EXPECT_EQ(internedString(id), "rose");
                out[l] = in[l] * in[l];
                ++*static_cast<int*>(c->user);
            }
        };
        run(*kernel, o, [](int, int n, int) { return float(n % 5) - 2; });
        for (int n = 0; n < kPoints; n++) {
            const float given = float(n % 5) - 2;
            EXPECT_EQ(run(0, 0, n), given > 0 ? given * given : 0.0f);
        }
        EXPECT_EQ(lanesServed, kPoints / 5 * 2);
    }
}

// Two lights; the second reaches only points with x > 0. The sum of Cl.r times the index + 1.
TEST(Codegen, LightLoop) {
    Made m;
    Inst *p = m.input("P", Kind::Triple), *angle = m.number(1), *zero = m.number(0), *one = m.number(1);
    Inst* loop = m.k.make(Op::LightLoop, Kind::None, {p, p, angle, zero});
    loop->results = {Kind::Float};
    loop->site = m.site("illuminance");
    loop->regions.resize(1);
    auto& body = loop->regions[0];
    m.param(body, Kind::Triple);
    Inst* cl = m.param(body, Kind::Triple);
    m.param(body, Kind::Triple);
    Inst *index = m.param(body, Kind::Float), *sum = m.param(body, Kind::Float);
    m.regions.push_back(&body);
    Inst* r = m.put(Op::Extract, Kind::Float, {cl}, 0);
    body.yields = {
        m.put(Op::Add, Kind::Float, {sum, m.put(Op::Mul, Kind::Float, {r, m.put(Op::Add, Kind::Float, {index, one})})})};
    m.regions.pop_back();
    m.k.body.body.push_back(loop);
    m.output("sum", m.put(Op::Result, Kind::Float, {loop}, 0));
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        Batch run;
        run.call.lightBegin = [](KernelCall*, int32_t, int32_t, uint64_t, int32_t, const float*) { return int32_t(2); };
        run.call.lightFetch = [](KernelCall* c, int32_t, int32_t light, int32_t first, uint64_t mask, int32_t lanes, float* out) {
            uint64_t lit = 0;
            for (int l = 0; l < lanes; l++) {
                const float x = c->in[0][first + l];
                if (light == 0 || x > 0) lit |= uint64_t(1) << l;
                out[3 * lanes + l] = light == 0 ? 2.0f : x;
            }
            return lit & mask;
        };
        run.call.lightEnd = [](KernelCall*, int32_t, int32_t, int32_t) {};
        run(*kernel, o, [](int, int n, int) { return float(n % 5) - 2; });
        for (int n = 0; n < kPoints; n++) {
            const float x = float(n % 5) - 2;
            EXPECT_EQ(run(0, 0, n), 2.0f + (x > 0 ? 2 * x : 0)) << n;
        }
    }
}

// Requests: y = request(x); z = request(y + 1) for x > 0 only; the result x + y + z. Coroutines a strip, resumed out of order.
TEST(Codegen, SuspendsAndResumes) {
    Made m;
    Inst *x = m.input("x"), *one = m.number(1), *zero = m.number(0);
    Inst* y = m.put(Op::Request, Kind::Float, {x});
    y->site = m.site("trace");
    Inst* branch = m.k.make(Op::If, Kind::None, {m.put(Op::Less, Kind::Bool, {zero, x})});
    branch->results = {Kind::Float};
    branch->regions.resize(2);
    m.regions.push_back(&branch->regions[0]);
    Inst* z = m.put(Op::Request, Kind::Float, {m.put(Op::Add, Kind::Float, {y, one})});
    z->site = m.site("trace");
    branch->regions[0].yields = {z};
    m.regions.pop_back();
    branch->regions[1].yields = {zero};
    m.k.body.body.push_back(branch);
    Inst* s = m.put(Op::Add, Kind::Float, {m.put(Op::Add, Kind::Float, {x, y}), m.put(Op::Result, Kind::Float, {branch}, 0)});
    m.output("s", s);
    struct Pending {
        uint64_t mask = 0;
        const float* in = nullptr;
        float* out = nullptr;
        int lanes = 0;
    };
    struct Scheduler {
        Pending last;
        int64_t live = 0;
    };
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        auto kernel = compile(m, o);
        ASSERT_TRUE(kernel);
        EXPECT_TRUE(kernel->facts().suspends);
        Rows rows(kPoints);
        float *in = rows.make(1), *out = rows.make(1);
        for (int n = 0; n < kPoints; n++) in[n] = float(n % 5) - 2;
        KernelCall call{};
        call.in = const_cast<const float* const*>(&in);
        call.out = &out;
        call.n = kPoints;
        call.stride = rows.stride;
        Scheduler scheduler;
        call.user = &scheduler;
        call.alloc = [](KernelCall* c, uint64_t bytes) -> void* {
            static_cast<Scheduler*>(c->user)->live += int64_t(bytes);
            return std::aligned_alloc(64, (bytes + 63) / 64 * 64);
        };
        call.release = [](KernelCall* c, void* p, uint64_t bytes) {
            static_cast<Scheduler*>(c->user)->live -= int64_t(bytes);
            std::free(p);
        };
        call.service = [](KernelCall* c, int32_t, int32_t, uint64_t mask, int32_t lanes, const float* in, float* out) {
            static_cast<Scheduler*>(c->user)->last = {mask, in, out, lanes};
        };
        struct Strip {
            void* handle;
            Pending pending;
        };
        std::vector<Strip> strips;
        for (int first = 0; first < kPoints; first += kernel->lanes()) {
            void* h = kernel->start(&call, first);
            ASSERT_TRUE(h);
            ASSERT_FALSE(kernel->finished(h));
            strips.push_back({h, scheduler.last});
        }
        while (!strips.empty()) {
            Strip strip = strips.back();
            strips.pop_back();
            for (int l = 0; l < strip.pending.lanes; l++)
                if (strip.pending.mask >> l & 1) strip.pending.out[l] = 10 * strip.pending.in[l];
            kernel->resume(strip.handle);
            if (kernel->finished(strip.handle)) kernel->destroy(strip.handle);
            else strips.insert(strips.begin(), {strip.handle, scheduler.last});
        }
        EXPECT_EQ(scheduler.live, 0);
        for (int n = 0; n < kPoints; n++) {
            const float given = in[n], answer = 10 * given;
            EXPECT_EQ(out[n], given + answer + (given > 0 ? 10 * (answer + 1) : 0)) << n;
        }
    }
}

// Without memory for a frame the kernel says so.
TEST(Codegen, NoFrameMemory) {
    Made m;
    Inst* y = m.put(Op::Request, Kind::Float, {m.input("x")});
    y->site = m.site("trace");
    m.output("y", y);
    auto kernel = compile(m, KernelOptions{});
    ASSERT_TRUE(kernel);
    Rows rows(8);
    float *in = rows.make(1), *out = rows.make(1);
    KernelCall call{};
    call.in = const_cast<const float* const*>(&in);
    call.out = &out;
    call.n = 8;
    call.stride = 64;
    call.alloc = [](KernelCall*, uint64_t) -> void* { return nullptr; };
    EXPECT_EQ(kernel->start(&call, 0), nullptr);
}

TEST(Codegen, RuntimeIsInlined) {
    Made m;
    Inst *x = m.input("x"), *k = m.input("k", Kind::Float, true);
    const Shadeop* sine = findShadeop("sin");
    ASSERT_TRUE(sine);
    const std::string symbol = sine->signatures[0].symbol;
    m.output("y", m.call(symbol.c_str(), Kind::Float, {x}));
    m.output("z", m.call(symbol.c_str(), Kind::Float, {k}));
    std::vector<float> reference;
    for (const auto& o : configurations()) {
        SCOPED_TRACE(describe(o));
        std::string text;
        auto kernel = compile(m, o, &text);
        ASSERT_TRUE(kernel);
        EXPECT_EQ(text.find("call void @" + symbol), std::string::npos);
        if (o.optimize == 2) { EXPECT_EQ(text.find("alloca"), std::string::npos); }
        Batch run;
        run(*kernel, o, [](int i, int n, int) { return i == 0 ? 0.1f * float(n) : 0.7f; });
        if (reference.empty()) reference.assign(run.out[0], run.out[0] + kPoints);
        for (int n = 0; n < kPoints; n++) {
            EXPECT_NEAR(run(0, 0, n), std::sin(0.1 * n), 1e-6);
            EXPECT_EQ(run(0, 0, n), reference[size_t(n)]);
            EXPECT_NEAR(run(1, 0, n), std::sin(0.7), 1e-6);
        }
    }
}

} // namespace
} // namespace alpenglow::rsl::test::codegen_test

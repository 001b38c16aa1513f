// From text to optimised IR, for tests.
#pragma once
#include "rsl/ir/build.h"
#include "rsl/ir/edit.h"
#include "rsl/ir/print.h"
#include "rsl/ir/verify.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/optimize.h"
#include <gtest/gtest.h>
#include <memory>

namespace alpenglow::rsl {

struct Compiled {
    std::unique_ptr<Program> program;
    std::unique_ptr<ir::Kernel> kernel;
    std::string messages;

    int count(ir::Op op) const {
        int n = 0;
        ir::forEach(static_cast<const ir::Region&>(kernel->body), [&](const ir::Inst* i) { n += i->op == op; });
        return n;
    }
    int sites(ir::Op op, const std::string& name) const {
        int n = 0;
        ir::forEach(static_cast<const ir::Region&>(kernel->body),
                    [&](const ir::Inst* i) { n += i->op == op && kernel->sites[static_cast<size_t>(i->site)].op == name; });
        return n;
    }
    std::string text() const { return ir::print(*kernel); }
};

/// Null kernel after an error; the messages say which. Included files are looked for in the folder of `file`.
inline Compiled compile(const std::string& source, const KernelOptions& options = {}, bool optimise = true,
                        const std::string& file = "test.sl") {
    Compiled c;
    Diagnostics d;
    c.program = compileText(source, file, {}, d);
    if (c.program && !c.program->shaders.empty()) {
        c.kernel = buildKernel(*c.program, *c.program->shaders.back(), options, d);
        if (c.kernel) {
            EXPECT_EQ(ir::verify(*c.kernel), "") << ir::print(*c.kernel);
            if (optimise) {
                passes::optimize(*c.kernel, options, d);
                EXPECT_EQ(ir::verify(*c.kernel), "") << ir::print(*c.kernel);
            }
        }
    }
    for (const Diagnostic& m : d.all()) c.messages += toString(m);
    EXPECT_NE(c.kernel, nullptr) << c.messages;
    return c;
}

inline KernelOptions pathOptions() {
    KernelOptions o;
    o.path = true;
    return o;
}

} // namespace alpenglow::rsl

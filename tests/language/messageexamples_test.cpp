// The table of messages: the example of each kind has that message and no other, at the severity that the table says.
#include "rsl/compiler.h"
#include "rsl/front/ast.h"
#include "rsl/messages/messages.h"
#include "rsl/nonlinear.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace alpenglow::rsl::messageexamples_test {
namespace {

/// The messages about the example, found in the way that `Shown` states.
std::vector<Diagnostic> saidOf(const MessageKind& kind) {
    Diagnostics d;
    if (kind.shown == Shown::Compile || kind.shown == Shown::Warnings) {
        FrontOptions options;
        options.lint = kind.shown == Shown::Warnings;
        compileText(kind.example, "example.sl", options, d);
        return d.all();
    }
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    const auto shaders = ShaderCompiler::allOfFile(compiler.loadText(kind.example, "example.sl", d));
    if (shaders.empty()) return d.all();
    KernelOptions o;
    for (size_t i = 1; i < shaders.size(); ++i) o.coShaders.push_back(ShaderCompiler::coShader(shaders[i], shaders[i]->name()));
    if (kind.shown == Shown::Path) {
        for (Diagnostic& m : nonlinearUses(shaders[0]->program(), shaders[0]->shader(), o)) d.report(std::move(m));
    } else {
        compiler.analyse(*shaders[0], o, d);
    }
    return d.all();
}

std::vector<const MessageText*> textsOf(const MessageKind& kind) {
    std::vector<const MessageText*> all;
    for (const MessageText* t : messageTexts())
        if (&t->kind == &kind) all.push_back(t);
    return all;
}

} // namespace

TEST(MessageExamples, HaveTheirMessageAndNoOther) {
    for (const MessageKind* kind : messageKinds()) {
        if (kind->shown == Shown::Elsewhere) continue;
        const auto said = saidOf(*kind);
        const Severity severity = textsOf(*kind)[0]->severity;
        EXPECT_FALSE(said.empty()) << kind->id << " has an example without a message:\n" << kind->example;
        for (const Diagnostic& d : said) {
            EXPECT_EQ(d.id, kind->id) << kind->example << toString(d);
            EXPECT_EQ(d.severity, severity) << kind->id << "\n" << toString(d);
        }
    }
}

TEST(MessageExamples, AreThereForAllThatAFileCanShow) {
    size_t elsewhere = 0;
    for (const MessageKind* kind : messageKinds()) {
        const bool none = kind->shown == Shown::Elsewhere;
        elsewhere += none;
        EXPECT_EQ(*kind->example == 0, none) << kind->id;
        EXPECT_EQ(*kind->reason != 0, none) << kind->id;
        EXPECT_GT(std::string(kind->about).size(), 20u) << kind->id;
        EXPECT_EQ(std::string(kind->about).back(), '.') << kind->id;
    }
    EXPECT_EQ(elsewhere, 30u); // fewer are better
    EXPECT_GT(messageKinds().size(), 170u);
}

/// They stand in the manual: what an example does not need is left out.
TEST(MessageExamples, AreShort) {
    for (const MessageKind* kind : messageKinds()) {
        const std::string text = kind->example;
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 8) << kind->id;
        if (!text.empty()) EXPECT_EQ(text.back(), '\n') << kind->id;
    }
}

} // namespace alpenglow::rsl::messageexamples_test

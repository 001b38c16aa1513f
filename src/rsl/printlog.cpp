#include "rsl/printlog.h"
#include "base/limits.h"
#include "base/printable.h"
#include <algorithm>
#include <bit>
#include <tuple>

namespace alpenglow::rsl {
namespace {

// By the bits, so that every float has its place in the order.
auto order(const PrintKey& k) {
    return std::tuple(k.sample, k.y, k.x, k.bounces, k.vertex, std::string_view(k.program), std::bit_cast<uint32_t>(k.place[0]),
                      std::bit_cast<uint32_t>(k.place[1]), std::bit_cast<uint32_t>(k.place[2]));
}

} // namespace

void PrintLog::keep(Message m) {
    bytes_ += sizeof(Message) + m.text.size() + m.key.program.size();
    if (bytes_ > limits::kPrintBytes) write();
    messages_.push_back(std::move(m));
}

void PrintLog::add(const PrintKey& key, const std::string& text) {
    const std::lock_guard lock(mutex_);
    keep({key, text});
}

void PrintLog::once(const std::string& where, const std::string& program, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (saidBytes_ > limits::kPrintBytes || !said_.insert({where, text}).second) return;
    saidBytes_ += where.size() + text.size();
    PrintKey key;
    key.program = program;
    keep({key, text, true});
}

void PrintLog::flush() {
    const std::lock_guard lock(mutex_);
    write();
    std::fflush(to_);
}

void PrintLog::discard() {
    const std::lock_guard lock(mutex_);
    std::erase_if(messages_, [](const Message& m) { return !m.lasting; });
    bytes_ = 0;
}

void PrintLog::write() {
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const Message& a, const Message& b) { return order(a.key) < order(b.key); });
    for (const Message& m : messages_) {
        const std::string text = printable(m.text);
        std::fwrite(text.data(), 1, text.size(), to_);
    }
    messages_.clear();
    bytes_ = 0;
}

} // namespace alpenglow::rsl

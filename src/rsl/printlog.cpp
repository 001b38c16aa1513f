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

/// The bits of a key.
std::string PrintLog::nameOf(const PrintKey& k) {
    std::string name;
    const auto add = [&](const auto& v) { name.append(reinterpret_cast<const char*>(&v), sizeof v); };
    add(k.sample), add(k.y), add(k.x), add(k.bounces), add(k.vertex), add(k.place), add(k.call);
    return name + k.program;
}

void PrintLog::keep(Message m) {
    const size_t bytes = sizeof(Message) + m.text.size() + m.key.program.size();
    if (bytes_ + bytes > most_ && !spill()) write();
    bytes_ += bytes;
    messages_.push_back(std::move(m));
}

void PrintLog::add(const PrintKey& key, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (key.run && runOf_.try_emplace(key.point, key.run).first->second != key.run) return;
    const std::string name = nameOf(key);
    if (size_t& n = kept_[name]; ++n > kOfOneCall) {
        ++lost_[name];
        return;
    }
    keep({key, text});
}

void PrintLog::once(const std::string& where, const std::string& program, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (saidBytes_ > limits::kPrintBytes || !reported_.insert({where, text}).second) return;
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
    runs_.clear();
    std::erase_if(messages_, [](const Message& m) { return !m.lasting; });
    bytes_ = 0;
    kept_.clear();
    lost_.clear();
    runOf_.clear();
}

bool PrintLog::pending() {
    const std::lock_guard lock(mutex_);
    return !runs_.empty() || std::any_of(messages_.begin(), messages_.end(), [](const Message& m) { return !m.lasting; });
}

void PrintLog::goOn(PrintLog& from) {
    for (const auto& reported : from.reported_) reported_.insert(reported);
    std::erase_if(messages_, [&](const Message& m) { return m.lasting; });
    for (Message& m : from.messages_) keep(std::move(m));
    for (Run& r : from.runs_) runs_.push_back(std::move(r));
    for (const auto& [name, n] : from.lost_) lost_[name] += n;
    from.messages_.clear();
    from.runs_.clear();
    from.kept_.clear();
    from.lost_.clear();
    from.bytes_ = 0;
}

bool PrintLog::before(const Message& a, const Message& b) { return order(a.key) < order(b.key); }

void PrintLog::sort() { std::stable_sort(messages_.begin(), messages_.end(), before); }

bool PrintLog::put(std::FILE* f, const Message& m) {
    const PrintKey& k = m.key;
    const uint64_t lengths[2] = {k.program.size(), m.text.size()};
    const auto all = [f](const void* p, size_t n) { return std::fwrite(p, 1, n, f) == n; };
    return all(&k.sample, sizeof k.sample) && all(&k.y, sizeof k.y) && all(&k.x, sizeof k.x) &&
           all(&k.bounces, sizeof k.bounces) && all(&k.vertex, sizeof k.vertex) && all(k.place.data(), sizeof k.place) &&
           all(k.call.data(), sizeof k.call) && all(lengths, sizeof lengths) && all(k.program.data(), k.program.size()) &&
           all(m.text.data(), m.text.size());
}

bool PrintLog::get(std::FILE* f, Message& m) {
    PrintKey& k = m.key;
    uint64_t lengths[2];
    const auto all = [f](void* p, size_t n) { return std::fread(p, 1, n, f) == n; };
    if (!all(&k.sample, sizeof k.sample) || !all(&k.y, sizeof k.y) || !all(&k.x, sizeof k.x) ||
        !all(&k.bounces, sizeof k.bounces) || !all(&k.vertex, sizeof k.vertex) || !all(k.place.data(), sizeof k.place) ||
        !all(k.call.data(), sizeof k.call) || !all(lengths, sizeof lengths))
        return false;
    k.program.resize(lengths[0]);
    m.text.resize(lengths[1]);
    return all(k.program.data(), lengths[0]) && all(m.text.data(), lengths[1]);
}

/// Moves what discard() would forget to a file. False: there is no room for it, and nothing has changed.
bool PrintLog::spill() {
    if (runs_.size() >= limits::kPrintRuns) return false;
    Run run(std::tmpfile());
    if (!run) return false;
    sort();
    for (const Message& m : messages_)
        if (!m.lasting && !put(run.get(), m)) return false;
    if (std::fflush(run.get()) != 0) return false;
    std::rewind(run.get());
    runs_.push_back(std::move(run));
    std::erase_if(messages_, [](const Message& m) { return !m.lasting; });
    bytes_ = 0;
    kept_.clear();
    return true;
}

/// What was too much of calls at a point.
void PrintLog::writeRest(const Calls& written, PrintKey point) {
    for (const auto& [call, n] : written) {
        point.call = call;
        const auto lost = lost_.find(nameOf(point));
        const size_t rest = n - std::min(n, kOfOneCall) + (lost == lost_.end() ? 0 : lost->second);
        if (rest == 0) continue;
        std::fprintf(to_, "(%zu more messages of %s:%d at this point are left out)\n", rest, printable(point.program).c_str(),
                     call[1]);
    }
}

void PrintLog::write() {
    sort();
    struct Source {
        std::FILE* file; ///< null: the messages in memory, which are the newest
        size_t next = 0;
        Message head{};
    };
    std::vector<Source> sources;
    const auto advance = [&](Source& s) {
        if (s.file) return get(s.file, s.head);
        if (s.next == messages_.size()) return false;
        s.head = std::move(messages_[s.next++]);
        return true;
    };
    const auto add = [&](std::FILE* f) {
        if (Source s{f}; advance(s)) sources.push_back(std::move(s));
    };
    for (const Run& r : runs_) add(r.get());
    add(nullptr);
    Calls written;
    PrintKey point;
    while (!sources.empty()) {
        const auto first = std::min_element(sources.begin(), sources.end(),
                                            [](const Source& a, const Source& b) { return before(a.head, b.head); });
        const PrintKey& key = first->head.key;
        if (order(key) != order(point)) {
            writeRest(written, point);
            written.clear();
            point = key;
        }
        if (first->head.lasting || ++written[key.call] <= kOfOneCall) {
            const std::string text = printable(first->head.text);
            std::fwrite(text.data(), 1, text.size(), to_);
        }
        if (!advance(*first)) sources.erase(first);
    }
    writeRest(written, point);
    runs_.clear();
    messages_.clear();
    bytes_ = 0;
    kept_.clear();
    lost_.clear();
}

} // namespace alpenglow::rsl

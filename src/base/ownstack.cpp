#include "base/ownstack.h"
#include <cstdint>
#include <exception>
#include <new>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

namespace alpenglow {
namespace {

constexpr size_t kStackBytes = size_t(8) << 20;

struct Work {
    const std::function<void()>& body;
    std::exception_ptr thrown;
};

/// makecontext() passes ints only: the two halves of a pointer.
void enter(unsigned high, unsigned low) {
    auto* w = reinterpret_cast<Work*>(uintptr_t(uint64_t(high) << 32 | low));
    try {
        w->body();
    } catch (...) { w->thrown = std::current_exception(); } // nothing may leave a context
}

/// Pages with one below them that cannot be written: an overflow is a fault, as on any stack.
class Pages {
public:
    Pages() {
        at_ = mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
        if (at_ == MAP_FAILED) throw std::bad_alloc();
        mprotect(at_, size_t(sysconf(_SC_PAGESIZE)), PROT_NONE);
    }
    ~Pages() { munmap(at_, kStackBytes); }
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;
    void* at() const { return at_; }

private:
    void* at_;
};

} // namespace

void onOwnStack(const std::function<void()>& body) {
    const Pages pages;
    Work work{body, nullptr};
    ucontext_t back, there;
    if (getcontext(&there) != 0) throw std::bad_alloc();
    there.uc_stack.ss_sp = pages.at();
    there.uc_stack.ss_size = kStackBytes;
    there.uc_link = &back;
    const auto address = uint64_t(reinterpret_cast<uintptr_t>(&work));
    makecontext(&there, reinterpret_cast<void (*)()>(enter), 2, unsigned(address >> 32), unsigned(address));
    if (swapcontext(&back, &there) != 0) throw std::bad_alloc();
    if (work.thrown) std::rethrow_exception(work.thrown);
}

} // namespace alpenglow

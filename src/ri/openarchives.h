// The archives and procedurals that are open.
#pragma once
#include <memory>
#include <string>
#include <utility>

namespace alpenglow::ri {

/// Their keys, the innermost last. Copies share what is in them: a procedural that waits keeps those that it stands in, and they
/// may nest by the thousand.
class OpenArchives {
public:
    OpenArchives() = default;
    OpenArchives(const OpenArchives&) = default;
    /// Take over without counting.
    OpenArchives(OpenArchives&& o) noexcept : last_(std::move(o.last_)) {}
    OpenArchives& operator=(OpenArchives o) noexcept {
        last_.swap(o.last_);
        return *this;
    }
    ~OpenArchives() {
        // One by one: links that free each other would recurse.
        while (last_ && last_.use_count() == 1) last_ = std::shared_ptr<Link>(std::move(last_->outer));
    }
    /// Number of open archives.
    size_t size() const { return last_ ? last_->count : 0; }
    /// None is open.
    bool empty() const { return !last_; }
    /// Opens an archive within the innermost.
    void push(std::string key) {
        const size_t count = size() + 1;
        last_ = std::make_shared<Link>(Link{std::move(key), std::move(last_), count});
    }
    /// Must not be empty.
    void pop() { last_ = std::shared_ptr<Link>(last_->outer); }
    /// Whether an archive of this key is open.
    bool contains(const std::string& key) const {
        for (const Link* l = last_.get(); l; l = l->outer.get())
            if (l->key == key) return true;
        return false;
    }

private:
    struct Link {
        std::string key;
        std::shared_ptr<Link> outer;
        size_t count;
    };
    std::shared_ptr<Link> last_;
};

} // namespace alpenglow::ri

// Motion blocks (RISpec 3.2, section 6): the calls are kept until MotionEnd, then done once, with all their samples.
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/motion.h"
#include <algorithm>
#include <fmt/format.h>

namespace alpenglow::ri {

void Interpreter::beginMotion(const Call& call) {
    Motion m;
    m.place = call.place;
    m.times = call.reals(0);
    if (m.times.empty()) {
        reporter.error(Rie::BadMotion, call.place, "MotionBegin has no times: one is assumed");
        m.times.push_back(0);
    }
    if (m.times.size() > size_t(limits::kStackDepth)) {
        reporter.error(Rie::Limit, call.place, fmt::format("MotionBegin has more than {} times", limits::kStackDepth));
        m.times.resize(size_t(limits::kStackDepth));
    }
    for (size_t i = 1; i < m.times.size(); ++i) {
        if (m.times[i] > m.times[i - 1]) continue;
        reporter.error(Rie::BadMotion, call.place,
                       fmt::format("the times of a motion block must increase: {} comes after {}", m.times[i], m.times[i - 1]),
                       "the samples from there on are not used");
        m.times.resize(i);
        break;
    }
    motion_ = std::move(m);
}

void Interpreter::endMotion(const Call& call) {
    if (!motion_) {
        reporter.error(Rie::Nesting, call.place, "MotionEnd without MotionBegin");
        return;
    }
    Motion m = std::move(*motion_);
    motion_.reset();
    if (m.calls.empty()) {
        reporter.error(Rie::BadMotion, m.place, "the motion block is empty");
        return;
    }
    const Request* r = m.calls[0].request;
    for (size_t i = 1; i < m.calls.size(); ++i) {
        if (m.calls[i].request == r) continue;
        reporter.error(Rie::BadMotion, m.calls[i].place,
                       fmt::format("a motion block holds one request: {} after {}", m.calls[i].request->name, r->name));
        m.calls.resize(i);
        break;
    }
    if (m.calls.size() < m.times.size())
        reporter.error(Rie::BadMotion, m.place,
                       fmt::format("the motion block has {} times but {} samples", m.times.size(), m.calls.size()));
    else if (m.calls.size() > m.times.size())
        reporter.error(Rie::BadMotion, m.calls[m.times.size()].place,
                       fmt::format("the motion block has more samples than its {} times", m.times.size()));
    size_t n = std::min(m.calls.size(), m.times.size());
    m.calls.resize(n);
    m.times.resize(n);
    if (n == 1) return dispatch(m.calls[0]);
    if (r->matrix) return moveTransform(m);
    if (r->kind == Kind::Primitive) return movePrimitive(m);
    incapable(m.calls[0], fmt::format("motion of {} is not followed: its first sample holds", r->name));
    dispatch(m.calls[0]);
}

void Interpreter::moveTransform(const Motion& m) {
    const Request* r = m.calls[0].request;
    checkScope(m.calls[0]);
    scene::Transform t;
    t.times.clear();
    t.keys.clear();
    bool rotation = r->name == "Rotate";
    const bool whole = r->name == "ConcatTransform" || r->name == "Transform"; // matrices of any making
    for (const Call& c : m.calls)
        for (size_t k = 1; rotation && k < 4; ++k) rotation = c.number(0, k) == m.calls[0].number(0, k);
    for (size_t i = 0; i < m.calls.size(); ++i) {
        auto matrix = r->matrix(*this, m.calls[i]);
        if (!matrix) continue; // reported
        if (rotation && i > 0) {
            const auto &a = m.calls[i - 1].numbers(0), &b = m.calls[i].numbers(0);
            addRotationKeys(t, m.times[i - 1], a[0], m.times[i], b[0], b[1], b[2], b[3]);
            continue;
        }
        if (whole && !t.keys.empty()) {
            const Matrix last = t.keys.back();
            const double since = t.times.back();
            addMatrixKeys(t, since, last, m.times[i], *matrix);
            continue;
        }
        t.times.push_back(m.times[i]);
        t.keys.push_back(*matrix);
    }
    if (t.keys.empty()) return;
    if (r->name == "Transform" || r->name == "Identity") replaceCtm(t, m.calls[0]);
    else concat(t, m.calls[0]);
}

void Interpreter::movePrimitive(const Motion& m) {
    std::vector<std::shared_ptr<scene::Primitive>> keys;
    std::vector<float> times;
    auto* outer = capture_;
    for (size_t i = 0; i < m.calls.size(); ++i) {
        size_t before = keys.size();
        capture_ = &keys;
        dispatch(m.calls[i]);
        capture_ = outer;
        if (keys.size() == before + 1) times.push_back(m.times[i]);
    }
    if (keys.empty() || keys.size() != times.size()) return; // refused, or not a primitive with a shape of its own: reported
    scene::Primitive& first = *keys[0];
    auto same = [&](const scene::Primitive& p) {
        bool fits = p.kind == first.kind && p.ints == first.ints && p.ints2 == first.ints2 && p.ints3 == first.ints3 &&
                    p.strings == first.strings && p.numbers.size() == first.numbers.size() &&
                    p.params.size() == first.params.size();
        for (size_t i = 0; fits && i < p.params.size(); ++i) {
            const scene::Param &a = p.params[i], *b = scene::find(first.params, a.name);
            fits = b && a.cls == b->cls && a.type == b->type && a.arrayLength == b->arrayLength &&
                   a.numbers.size() == b->numbers.size() && a.strings.size() == b->strings.size();
        }
        return fits;
    };
    std::vector<std::shared_ptr<scene::Primitive>> rest;
    std::vector<float> kept = {times[0]};
    for (size_t i = 1; i < keys.size(); ++i) {
        if (!same(*keys[i])) {
            reporter.error(Rie::BadMotion, keys[i]->place,
                           fmt::format("this sample of a moving {} does not match the first one", first.kind));
            continue;
        }
        rest.push_back(keys[i]);
        kept.push_back(times[i]);
    }
    if (!rest.empty()) {
        first.motionKeys = std::move(rest);
        first.motionTimes = std::move(kept);
    }
    store(keys[0]);
}

} // namespace alpenglow::ri

#include "sim/narrow_phase.h"

#include "sim/collision/carry_over.h"
#include "sim/tuning.h"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

bool at_work(const Body& body) { return body.moves() && !body.asleep; }

// Exact flights meet others at impacts, not at steps.
bool either_flies(const Body& a, const Body& b) { return a.flying || b.flying; }

auto key(const Manifold& m) { return std::tuple(m.a, m.b, m.part); }

}  // namespace

std::vector<Manifold>& NarrowPhase::find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies,
                                         double h, ThreadPool& pool) {
    if (found_.size() < pairs.size()) found_.resize(pairs.size());
    pool.for_each(pairs.size(), tuning::parallel_grain, [&](std::size_t i, std::size_t thread) {
        const Body &a = bodies[pairs[i].a], &b = bodies[pairs[i].b];
        found_[i].clear();
        double margin = tuning::touch * std::min(a.radius, b.radius);
        if (mode_ == Mode::step) {
            if ((!at_work(a) && !at_work(b)) || either_flies(a, b)) return;
            margin = contact_margin(a, h) + contact_margin(b, h);
        }
        collide(a.collider, a.pose(), b.collider, b.pose(), margin, scratch_[thread], found_[i]);
    });
    previous_.swap(manifolds_);
    manifolds_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (Manifold& m : found_[i]) {
            m.a = pairs[i].a;
            m.b = pairs[i].b;
            manifolds_.push_back(m);
        }
        // A surface's triangles are found in the order of its tree.
        const auto count = std::ptrdiff_t(found_[i].size());
        std::stable_sort(manifolds_.end() - count, manifolds_.end(),
                         [](const Manifold& l, const Manifold& r) { return l.part < r.part; });
    }
    auto old = previous_.begin();
    for (Manifold& m : manifolds_) {
        while (old != previous_.end() && key(*old) < key(m)) ++old;
        if (old == previous_.end() || key(*old) != key(m)) continue;
        carry_over(*old, tuning::carry_reach * std::min(bodies[m.a].radius, bodies[m.b].radius), m);
    }
    return manifolds_;
}

}  // namespace tumble

// Exact manifolds of all pairs that may touch, shared out over the threads and put in order.
#pragma once

#include "sim/broad_phase.h"
#include "sim/collision/collide.h"
#include "sim/thread_pool.h"

#include <vector>

namespace tumble {

class NarrowPhase {
public:
    /// step: pairs of which one body is awake, with the margin of a step. measure: all pairs, touching points only.
    enum class Mode { step, measure };

    explicit NarrowPhase(int threads, Mode mode = Mode::step) : mode_(mode), scratch_(std::size_t(threads)) {}

    /// Ascending by (a, b, part). Valid until the next call, which takes over what the solver has written into them
    /// (impulses, friction, twist) for the pairs that are still there; it may come in the same step again.
    std::vector<Manifold>& find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies, double h,
                                ThreadPool& pool);

private:
    Mode mode_;
    std::vector<CollisionScratch> scratch_;          // one a thread
    std::vector<std::vector<Manifold>> found_;       // one a pair
    std::vector<Manifold> manifolds_, previous_;
};

}  // namespace tumble

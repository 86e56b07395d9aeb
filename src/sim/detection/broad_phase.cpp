#include "sim/detection/broad_phase.h"

#include "sim/detection/settings.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tumble {
namespace {

/// Bounds of the broad phase are larger than the body by `fat_bounds` (share of its radius) and extend over its
/// motion in `fat_steps` steps. On heaps of 1000 boxes, twice the margin gives three times as many pairs that do
/// not touch, and half as many searches (bench_contact "pile of 1000").
constexpr double fat_bounds = 0.05;
constexpr double fat_steps = 8.0;

/// Bodies whose pairs are searched from which on threads share the work: some microseconds each. Limits the cost.
constexpr std::size_t parallel_searches = 16;

double turning_displacement(const Body& body, double h) { return h * body.angular_velocity.norm() * body.radius; }

bool inside(const Bounds& inner, const Bounds& outer) {
    for (int k = 0; k < 3; ++k)
        if (inner.min[k] < outer.min[k] || inner.max[k] > outer.max[k]) return false;
    return true;
}

double room(const Bounds& inner, const Bounds& outer) {
    return std::min((inner.min - outer.min).minCoeff(), (outer.max - inner.max).minCoeff());
}

Bounds carried(Bounds bounds, const Vec3& displacement) {
    bounds.min += displacement.cwiseMin(0.0);
    bounds.max += displacement.cwiseMax(0.0);
    return bounds;
}

}  // namespace

Bounds bounds_of_step(const Body& body, double h) {
    const Bounds bounds = world_bounds(body.collider, body.pose());
    if (!body.moves()) return bounds;
    return carried(bounds.grown(tuning::speculative * body.radius + turning_displacement(body, h)), h * body.velocity);
}

const std::vector<BroadPhase::Pair>& BroadPhase::update(const std::vector<Body>& bodies, double h, ThreadPool* pool) {
    if (!built_) build(bodies);
    if (search_awake_) find_awake(bodies);
    searches_.resize(pool ? std::size_t(pool->size()) : 1);
    if (searches_.size() > 1 && awake_.size() >= tuning::parallel_bodies)
        find_leavers(bodies, h, *pool);
    else
        for (const std::uint32_t i : awake_)
            if (!stays(i, bodies[i], h)) visit(i, bodies[i], h);
    if (fell_asleep_ || !moved_.empty())
        std::erase_if(awake_, [&](std::uint32_t i) { return bodies[i].asleep && kind_ == Pairs::awake; });
    if (moved_.empty() && !fell_asleep_) return pairs_;

    find_added(bodies, pool);
    if (!apart_.empty() || !filters_.empty()) std::erase_if(added_, [&](const Pair& pair) { return kept_apart(pair); });
    spare_.clear();
    std::erase_if(pairs_, [&](const Pair& pair) {
        const State &a = states_[pair.a], &b = states_[pair.b];
        return a.moved || b.moved || (!a.active && !b.active);
    });
    std::merge(pairs_.begin(), pairs_.end(), added_.begin(), added_.end(), std::back_inserter(spare_));
    pairs_.swap(spare_);
    for (const std::uint32_t i : moved_) states_[i].moved = false;
    moved_.clear();
    fell_asleep_ = false;
    return pairs_;
}

void BroadPhase::keep_apart(std::vector<Pair> pairs) {
    if (pairs == apart_) return;
    apart_.swap(pairs);
    std::erase_if(pairs_, [&](const Pair& pair) { return kept_apart(pair); });
    if (!built_) return;
    // Released pairs are tested for overlap only when one of the two bodies leaves its bounds.
    for (const Pair& pair : pairs) {
        if (kept_apart(pair) || (!states_[pair.a].active && !states_[pair.b].active)) continue;
        const auto place = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        if (place == pairs_.end() || *place != pair) pairs_.insert(place, pair);
    }
}

bool BroadPhase::sound() const {
    for (std::uint32_t i = 0; i < states_.size(); ++i)
        if (states_[i].active != active_tree_.holds(i)) return false;
    return std::is_sorted(pairs_.begin(), pairs_.end()) && std::is_sorted(apart_.begin(), apart_.end());
}

void BroadPhase::build(const std::vector<Body>& bodies) {
    list_fixed(bodies);
    states_.resize(bodies.size());
    filters_ = LayerFilters(bodies);
    built_ = true;
}

void BroadPhase::list_fixed(const std::vector<Body>& bodies) {
    fixed_.clear();
    half_spaces_.clear();
    std::vector<Bounds> fixed_bounds;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (body.moves() || body.absent) continue;
        if (std::holds_alternative<HalfSpace>(body.collider))
            half_spaces_.push_back(i);
        else {
            fixed_.push_back(i);
            fixed_bounds.push_back(world_bounds(body.collider, body.pose()));
        }
    }
    fixed_tree_ = BoundsTree(std::move(fixed_bounds));
}

void BroadPhase::exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed) {
    search_awake_ = true;
    if (built_)
        list_fixed(bodies);
    else
        build(bodies);
    const auto has_changed = [&](std::uint32_t i) { return std::binary_search(changed.begin(), changed.end(), i); };
    std::erase_if(pairs_, [&](const Pair& pair) { return has_changed(pair.a) || has_changed(pair.b); });
    DynamicTree::Stack stack;
    for (const std::uint32_t i : changed) {
        active_tree_.remove(i);
        resting_tree_.remove(i);
        states_[i] = {};
        // A body that moves finds its pairs when the next update visits it; no update visits a fixed one.
        if (bodies[i].absent || bodies[i].moves()) continue;
        active_tree_.query(world_bounds(bodies[i].collider, bodies[i].pose()), stack, [&](std::uint32_t other) {
            const Pair pair{std::min(i, other), std::max(i, other)};
            if (!bodies[other].dynamic() || has_changed(other) || kept_apart(pair)) return;
            pairs_.insert(std::lower_bound(pairs_.begin(), pairs_.end(), pair), pair);
        });
    }
}

void BroadPhase::find_awake(const std::vector<Body>& bodies) {
    awake_.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        // Sleeping bodies are visited once more, and once at the start to enter the tree.
        if (body.moves() && (!body.asleep || kind_ == Pairs::all || !resting_tree_.holds(i))) awake_.push_back(i);
    }
    search_awake_ = false;
}

// True if the body's state holds: inside its fat bounds, and awake or ballistic as in the last update.
bool BroadPhase::stays(std::uint32_t i, const Body& body, double h) {
    State& state = states_[i];
    if (active(body) != state.active) return false;
    if (!state.active) return resting_tree_.holds(i);
    const double displacement = h * body.velocity.norm(),
                 margin = tuning::speculative * body.radius + turning_displacement(body, h);
    if (state.displacement > fat_steps * displacement + fat_bounds * body.radius) return false;  // it was faster
    // A body has usually hardly moved since its bounds were computed: no point of it by more than this (chord between
    // quaternions: narrow_phase.h).
    const double moved = (body.position - state.position).norm() +
                         2.0 * (body.orientation.coeffs() - state.orientation.coeffs()).norm() * body.radius;
    if (moved + margin + displacement <= state.room) return true;
    const Bounds bounds = world_bounds(body.collider, body.pose()), &fat = active_tree_.box(i);
    if (!inside(carried(bounds.grown(margin), h * body.velocity), fat)) return false;
    state.position = body.position;
    state.orientation = body.orientation;
    state.room = room(bounds, fat);
    return true;
}

void BroadPhase::find_leavers(const std::vector<Body>& bodies, double h, ThreadPool& pool) {
    pool.together([&](std::size_t thread) {
        auto& leavers = searches_[thread].leavers;
        leavers.clear();
        for (const std::uint32_t i : awake_)
            if (pool.thread_of(i) == thread && !stays(i, bodies[i], h)) leavers.push_back(i);
    });
    std::vector<std::uint32_t>& all = searches_[0].leavers;
    for (std::size_t thread = 1; thread < searches_.size(); ++thread)
        all.insert(all.end(), searches_[thread].leavers.begin(), searches_[thread].leavers.end());
    std::sort(all.begin(), all.end());
    for (const std::uint32_t i : all) visit(i, bodies[i], h);
}

void BroadPhase::visit(std::uint32_t i, const Body& body, double h) {
    State& state = states_[i];
    state.active = active(body);
    if (!state.active && active_tree_.holds(i)) {
        fell_asleep_ = true;
        resting_tree_.set(i, active_tree_.box(i));
        active_tree_.remove(i);
        return;
    }
    if (state.active) resting_tree_.remove(i);
    const Vec3 further = (fat_steps - 1.0) * h * body.velocity;
    DynamicTree& tree = state.active ? active_tree_ : resting_tree_;
    tree.set(i, carried(bounds_of_step(body, h).grown(fat_bounds * body.radius), further));
    state.displacement = fat_steps * h * body.velocity.norm();
    state.room = -1.0;
    state.moved = true;
    moved_.push_back(i);
}

// Finds the pairs of all moved bodies, ascending. The trees do not change while the threads query them.
void BroadPhase::find_added(const std::vector<Body>& bodies, ThreadPool* pool) {
    for (Search& search : searches_) search.pairs.clear();
    const auto sort = [](Search& search) { std::sort(search.pairs.begin(), search.pairs.end()); };
    if (searches_.size() > 1 && moved_.size() >= parallel_searches) {
        pool->for_each(moved_.size(), parallel_searches,
                       [&](std::size_t k, std::size_t thread) { find_pairs_of(moved_[k], bodies, searches_[thread]); });
        pool->together([&](std::size_t thread) { sort(searches_[thread]); });
    } else {
        for (const std::uint32_t i : moved_) find_pairs_of(i, bodies, searches_[0]);
        sort(searches_[0]);
    }
    added_.swap(searches_[0].pairs);
    for (std::size_t thread = 1; thread < searches_.size(); ++thread) {
        const auto& more = searches_[thread].pairs;
        const auto middle = std::ptrdiff_t(added_.size());
        added_.insert(added_.end(), more.begin(), more.end());
        std::inplace_merge(added_.begin(), added_.begin() + middle, added_.end());
    }
}

void BroadPhase::find_pairs_of(std::uint32_t i, const std::vector<Body>& bodies, Search& search) const {
    const bool awake = states_[i].active, dynamic = bodies[i].dynamic();
    const Bounds& box = (awake ? active_tree_ : resting_tree_).box(i);
    const auto meet = [&](std::uint32_t other) {
        if (other == i || (states_[other].moved && other < i)) return;
        if (dynamic || bodies[other].dynamic()) search.pairs.push_back({std::min(i, other), std::max(i, other)});
    };
    active_tree_.query(box, search.stack, meet);
    if (!awake) return;
    resting_tree_.query(box, search.stack, meet);
    if (!dynamic) return;
    const auto add = [&](std::uint32_t fixed) { search.pairs.push_back({std::min(i, fixed), std::max(i, fixed)}); };
    fixed_tree_.query(box, [&](std::uint32_t other) { add(fixed_[other]); });
    for (const std::uint32_t plane : half_spaces_) {
        // The half-space reaches the box if the box's lowest corner is below its plane.
        const auto& space = std::get<HalfSpace>(bodies[plane].collider);
        const Vec3 normal = bodies[plane].rotation * space.normal;
        const double center = normal.dot(box.center() - bodies[plane].position) - space.offset;
        if (center <= normal.cwiseAbs().dot(0.5 * box.extent())) add(plane);
    }
}

}  // namespace tumble

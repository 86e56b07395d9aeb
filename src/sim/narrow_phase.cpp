#include "sim/narrow_phase.h"

#include "sim/collision/carry_over.h"
#include "sim/touch.h"
#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool awake(const Body& body) { return body.moves() && !body.asleep; }

Pose seen_from(const Pose& frame, const Pose& pose) {
    return {frame.to_body(pose.position), frame.rotation.transpose() * pose.rotation};
}

// How far (m) any point within `radius` of the body's centre has moved at most.
double motion(const Pose& from, const Pose& to, double radius) {
    return (to.position - from.position).norm() + std::sqrt(0.5 * (to.rotation - from.rotation).squaredNorm()) * radius;
}

// Along the world's axis that separates them best.
double distance(const Bounds& a, const Bounds& b) {
    double most = b.min[0] - a.max[0];
    for (int k = 0; k < 3; ++k) most = std::max({most, b.min[k] - a.max[k], a.min[k] - b.max[k]});
    return most;
}

// The manifold's normal is that of a face of its second shape (feature_contact.cpp).
bool of_second(const Manifold& m) { return (m.points[0].feature >> 63) != 0; }

}  // namespace

double NarrowPhase::margin(const View& a, const View& b, double h) const {
    if (mode_ == Mode::measure) return touch_distance(a.radius, b.radius);
    return a.speculative + b.speculative + h * ((b.velocity - a.velocity).norm() + a.spin + b.spin);
}

std::vector<Manifold>& NarrowPhase::find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies,
                                         double h, ThreadPool& pool) {
    match(pairs, bodies);
    view(bodies);
    for (Found& found : found_) {
        found.manifolds.clear();
        found.anchors.clear();
    }
    results_.resize(entries_.size());
    pool.for_each(entries_.size(), tuning::parallel_grain, [&](std::size_t i, std::size_t thread) {
        results_[i] = examine(entries_[i], h, thread);
    });
    put_in_order();
    return manifolds_;
}

// The entries for the new list of pairs.
void NarrowPhase::match(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies) {
    const auto same = [](const Entry& entry, const BroadPhase::Pair& pair) { return entry.pair == pair; };
    if (std::equal(entries_.begin(), entries_.end(), pairs.begin(), pairs.end(), same)) return;
    spare_entries_.clear();
    auto old = entries_.begin();
    const auto leave = [&](const Entry& entry) {
        const Body &a = bodies[entry.pair.a], &b = bodies[entry.pair.b];
        moved_ = moved_ || entry.count > 0;
        if (entry.count > 0 && !awake(a) && !awake(b) && mode_ == Mode::step) park(entry);
        free_searches_.push_back(entry.search);
    };
    for (const BroadPhase::Pair& pair : pairs) {
        for (; old != entries_.end() && old->pair < pair; ++old) leave(*old);
        if (old != entries_.end() && old->pair == pair) {
            spare_entries_.push_back(*old++);
            continue;
        }
        Entry entry{pair};
        if (free_searches_.empty()) {
            entry.search = std::uint32_t(searches_.size());
            searches_.emplace_back();
        } else {
            entry.search = free_searches_.back();
            free_searches_.pop_back();
            searches_[entry.search] = {};
        }
        if (!parked_.empty()) unpark(entry);
        spare_entries_.push_back(entry);
    }
    for (; old != entries_.end(); ++old) leave(*old);
    entries_.swap(spare_entries_);
}

void NarrowPhase::park(const Entry& entry) {
    Parked& parked = parked_[entry.pair];
    parked.search = searches_[entry.search];
    parked.manifolds.assign(manifolds_.begin() + entry.first, manifolds_.begin() + entry.first + entry.count);
    parked.anchors.assign(anchors_.begin() + entry.first, anchors_.begin() + entry.first + entry.count);
}

void NarrowPhase::unpark(Entry& entry) {
    const auto found = parked_.find(entry.pair);
    if (found == parked_.end()) return;
    const Parked& parked = found->second;
    searches_[entry.search] = parked.search;
    entry.first = std::uint32_t(manifolds_.size());
    entry.count = std::uint32_t(parked.manifolds.size());
    manifolds_.insert(manifolds_.end(), parked.manifolds.begin(), parked.manifolds.end());
    anchors_.insert(anchors_.end(), parked.anchors.begin(), parked.anchors.end());
    moved_ = true;
    parked_.erase(found);
}

// Of the bodies in the list only: those that sleep far from all others are not even looked at.
void NarrowPhase::view(const std::vector<Body>& bodies) {
    ++call_;
    seen_.resize(bodies.size(), 0);
    views_.resize(bodies.size());
    for (const Entry& entry : entries_) {
        for (const std::uint32_t i : {entry.pair.a, entry.pair.b}) {
            if (seen_[i] == call_) continue;
            seen_[i] = call_;
            const Body& body = bodies[i];
            View& v = views_[i];
            const Pose pose = body.pose();
            if (body.moves()) v.travel += motion(v.pose, pose, body.radius);
            v.pose = pose;
            v.radius = body.radius;
            v.velocity.setZero();
            v.spin = v.speculative = 0.0;
            if (body.moves()) {
                v.velocity = body.velocity;
                v.spin = body.angular_velocity.norm() * body.radius;
                v.speculative = tuning::speculative * body.radius;
            }
            v.bounds = world_bounds(body.collider, v.pose);
            v.collider = &body.collider;
            v.awake = awake(body);
            v.flying = body.flying;
            v.kind = std::holds_alternative<Ball>(body.collider)                                ? View::Kind::ball
                     : std::holds_alternative<std::shared_ptr<const Polyhedron>>(body.collider) ? View::Kind::polyhedron
                                                                                                : View::Kind::fixed;
        }
    }
}

NarrowPhase::Result NarrowPhase::examine(const Entry& entry, double h, std::size_t thread) {
    const View &a = views_[entry.pair.a], &b = views_[entry.pair.b];
    Search& last = searches_[entry.search];
    const auto drop = [&] {
        if (entry.count > 0) last.outcome = Search::Outcome::none;
        return Result{.stays = entry.count == 0};
    };
    // Exact flights meet others at impacts, not at steps.
    if (mode_ == Mode::step && ((!a.awake && !b.awake) || a.flying || b.flying)) return drop();
    const double apart = distance(a.bounds, b.bounds);
    // Most pairs end here: first without the square root, by the sum of the components.
    const bool far = mode_ == Mode::step && apart > a.speculative + b.speculative +
                                                        h * ((b.velocity - a.velocity).cwiseAbs().sum() + a.spin + b.spin);
    const double reach = far ? 0.0 : margin(a, b, h);
    if (far || apart > reach) return drop();
    if (!remembers_ || a.kind == View::Kind::ball || b.kind == View::Kind::ball) return search(entry, a, b, reach, thread);

    // What the bodies have moved by themselves is at hand, and often little enough; else what they moved to each other.
    const double travel = a.travel + b.travel;
    if (holds(entry, a, b, reach, last, last.spent + (travel - last.travel))) return {};
    const bool a_larger = a.radius >= b.radius;
    const View &large = a_larger ? a : b, &small = a_larger ? b : a;
    const Pose pose = seen_from(large.pose, small.pose);
    last.spent += motion(last.pose, pose, small.radius);
    last.pose = pose;
    last.travel = travel;
    if (holds(entry, a, b, reach, last, last.spent)) return {};
    last.spent = 0.0;
    return search(entry, a, b, reach, thread);
}

// Whether what was found last still stands after the bodies have moved (m) against each other. Manifolds are brought up to
// date.
bool NarrowPhase::holds(const Entry& entry, const View& a, const View& b, double reach, const Search& last, double moved) {
    if (last.outcome == Search::Outcome::apart) return last.gap - moved > reach;
    if (last.outcome == Search::Outcome::none || moved >= tuning::reuse_motion * std::min(a.radius, b.radius)) return false;
    bool within = true;
    for (std::uint32_t k = entry.first; k < entry.first + entry.count; ++k) {
        Manifold& m = manifolds_[k];
        follow(anchors_[k], a.pose, b.pose, m);
        for (int i = 0; i < m.count; ++i) within = within && m.points[std::size_t(i)].separation <= reach;
    }
    return within;
}

NarrowPhase::Result NarrowPhase::search(const Entry& entry, const View& a, const View& b, double reach,
                                        std::size_t thread) {
    Found& found = found_[thread];
    Search& last = searches_[entry.search];
    Result result{false, std::uint32_t(thread), std::uint32_t(found.manifolds.size()), 0};
    found.scratch.axis = last.axis;
    found.scratch.gap = 0.0;
    collide(*a.collider, a.pose, *b.collider, b.pose, reach, found.scratch, found.manifolds);
    last.axis = found.scratch.axis;
    last.gap = std::max(reach, found.scratch.gap);
    result.count = std::uint32_t(found.manifolds.size()) - result.first;
    last.outcome = result.count > 0 ? Search::Outcome::near : Search::Outcome::apart;
    if (result.count == 0) {
        result.stays = entry.count == 0;
        return result;
    }
    // A surface's triangles are found in the order of its tree.
    const auto first = found.manifolds.begin() + result.first;
    if (result.count > 1)
        std::stable_sort(first, found.manifolds.end(), [](const Manifold& l, const Manifold& r) { return l.part < r.part; });
    const bool swapped = b.kind == View::Kind::fixed || (b.kind == View::Kind::polyhedron && a.kind == View::Kind::ball);
    std::uint32_t old = entry.first;
    const std::uint32_t old_end = entry.first + entry.count;
    for (auto m = first; m != found.manifolds.end(); ++m) {
        m->a = entry.pair.a;
        m->b = entry.pair.b;
        while (old < old_end && manifolds_[old].part < m->part) ++old;
        if (old < old_end && manifolds_[old].part == m->part) {
            // To where its points are now on the larger body.
            for (std::size_t i = 0; i < std::size_t(manifolds_[old].count); ++i)
                manifolds_[old].points[i].position = a.radius >= b.radius ? a.pose.to_world(anchors_[old].on_a[i])
                                                                          : b.pose.to_world(anchors_[old].on_b[i]);
            carry_over(manifolds_[old], tuning::carry_reach * std::min(a.radius, b.radius), *m);
        }
        found.anchors.push_back(make_anchors(*m, a.pose, b.pose, of_second(*m) != swapped));
    }
    if (result.count == entry.count) {   // in place
        std::copy(first, found.manifolds.end(), manifolds_.begin() + entry.first);
        std::copy(found.anchors.begin() + result.first, found.anchors.end(), anchors_.begin() + entry.first);
        found.manifolds.resize(result.first);
        found.anchors.resize(result.first);
        result.stays = true;
    }
    return result;
}

// Brings the manifolds into the order of the entries, where any have come or gone.
void NarrowPhase::put_in_order() {
    const auto stays = [](const Result& result) { return result.stays; };
    if (!moved_ && std::all_of(results_.begin(), results_.end(), stays)) return;
    spare_manifolds_.clear();
    spare_anchors_.clear();
    std::uint32_t first = 0, end = 0;   // of what stays, one run at a time
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        Entry& entry = entries_[i];
        const Result& result = results_[i];
        const bool run = result.stays && entry.first == end;
        if (!run && (!result.stays || entry.count > 0)) {
            append(manifolds_, anchors_, first, end);
            first = end = result.stays ? entry.first : 0;
        }
        const auto at = std::uint32_t(spare_manifolds_.size()) + (end - first);
        if (result.stays) {
            if (entry.count > 0) end += entry.count;
        } else {
            const Found& found = found_[result.thread];
            append(found.manifolds, found.anchors, result.first, result.first + result.count);
            entry.count = result.count;
        }
        entry.first = at;
    }
    append(manifolds_, anchors_, first, end);
    manifolds_.swap(spare_manifolds_);
    anchors_.swap(spare_anchors_);
    moved_ = false;
}

void NarrowPhase::append(const std::vector<Manifold>& manifolds, const std::vector<Anchors>& anchors, std::uint32_t first,
                         std::uint32_t end) {
    spare_manifolds_.insert(spare_manifolds_.end(), manifolds.begin() + first, manifolds.begin() + end);
    spare_anchors_.insert(spare_anchors_.end(), anchors.begin() + first, anchors.begin() + end);
}

}  // namespace tumble

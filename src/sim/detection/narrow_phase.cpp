#include "sim/detection/narrow_phase.h"

#include "sim/detection/settings.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/geometry/manifold_growth.h"
#include "sim/geometry/persistent_manifold.h"
#include "sim/geometry/settings.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace tumble {
namespace {

/// A contact point without a partner of the same features takes the impulse of an old point up to this distance
/// away (share of the smaller radius): corners that alternate on a rocking box carry the same load. Related
/// test: NarrowPhaseManifold.TakesTheNearestPointWhenFeaturesChange.
constexpr double matching_distance = 0.1;

/// Shapes of many corners are searched for missed points while their motion since the last search is below this
/// share of the radius: such a body rocks. A body that rolls over its corners has new points in each step. Related
/// test: ContactRest.ACoinLiesDown.
constexpr double missed_motion = 0.05;

/// Angle of a body in a step, rad, above which several corners of a cylinder of 64 corners may reach the other surface
/// (tuning::fast_rotation_turn is that of 200 corners). Above it, the points of a body on a plane are those that it
/// rolls on. Related test: Rolling.WheelsOfCornersStayOnTheGround.
constexpr double rolling_turn = 0.1;

// Entries prefetched ahead of use: processing that many takes about as long as one fetch from memory.
constexpr std::size_t ahead = 6;

bool awake(const Body& body) { return body.moves() && !body.asleep; }

// To single precision. Precondition: not negative.
float rounded_down(double x) { return float(x) * (1.0f - std::numeric_limits<float>::epsilon()); }
float rounded_up(double x) { return float(x) * (1.0f + std::numeric_limits<float>::epsilon()); }

// Distance along the world axis that separates the boxes best.
double distance(const Bounds& a, const Bounds& b) {
    double most = b.min[0] - a.max[0];
    for (int k = 0; k < 3; ++k) most = std::max({most, b.min[k] - a.max[k], a.min[k] - b.max[k]});
    return most;
}

bool earlier(const Manifold& l, const Manifold& r) { return l.part != r.part ? l.part < r.part : !l.more && r.more; }

// Manifolds and persistent manifolds are plain numbers, despite Eigen's constructors: copied as memory.
template <class T>
void copy_plain(const std::vector<T>& from, std::size_t first, std::size_t count, std::vector<T>& to,
                std::size_t place) {
    static_assert(std::is_trivially_destructible_v<T>);
    // NOLINTNEXTLINE(bugprone-undefined-memory-manipulation)
    if (count > 0) std::memcpy(static_cast<void*>(to.data() + place), from.data() + first, count * sizeof(T));
}

// A run of manifolds that stay adjacent.
struct Run {
    std::uint32_t from = 0, to = 0, count = 0;
};

std::span<const ContactPoint> reduced(const Manifold& m, const CollisionScratch& scratch) {
    return std::span(scratch.reduced).subspan(m.first_reduced, m.reduced);
}

}  // namespace

bool NarrowPhase::sound() const {
    const std::size_t count = manifolds_.size();
    if (persistent_.size() != count || touching_.size() != count) return false;
    std::size_t first = 0;
    for (const Entry& entry : entries_) {
        const std::size_t end = first + entry.count;
        // A new entry without manifolds has no slot yet.
        if (entry.first != first && (entry.count > 0 || entry.first > count)) return false;
        if (end > count || entry.search >= searches_.size()) return false;
        if (entry.mover != entry.pair.a && entry.mover != entry.pair.b) return false;
        for (; first < end; ++first)
            if (touching_[first] != entry.pair || BodyPair{manifolds_[first].a, manifolds_[first].b} != entry.pair)
                return false;
    }
    const auto earlier_pair = [](const Entry& l, const Entry& r) { return l.pair < r.pair; };
    return first == count && std::is_sorted(entries_.begin(), entries_.end(), earlier_pair) &&
           std::all_of(free_searches_.begin(), free_searches_.end(),
                       [&](std::uint32_t search) { return search < searches_.size(); }) &&
           std::all_of(parked_.begin(), parked_.end(), [](const auto& entry) {
               const Parked& parked = entry.second;
               return parked.persistent.size() == parked.manifolds.size() &&
                      std::all_of(parked.manifolds.begin(), parked.manifolds.end(), [&](const Manifold& m) {
                          return BodyPair{m.a, m.b} == entry.first;
                      });
           });
}

double NarrowPhase::margin(const View& a, const View& b, double h) const {
    if (mode_ == Mode::measure) return touch_distance(a.radius, b.radius);
    return a.speculative + b.speculative + h * ((b.velocity - a.velocity).norm() + a.spin + b.spin);
}

NarrowPhase::Placement NarrowPhase::placement(const View& small, const View& large) {
    Placement p{large.pose.to_body(small.pose.position), {}};
    const Quat turn = large.orientation.conjugate() * small.orientation;
    for (int k = 0; k < 4; ++k) p.orientation[k] = float(turn.coeffs()[k]);
    return p;
}

// Upper bound (m) of the motion of any point within `radius` of the body's center. For a rotation by t the unit
// quaternions are t / 2 apart on their sphere: the farthest point moved by 2 r sin(t / 2), and the chord between the
// quaternions is 2 sin(t / 4), so that twice the chord times r is no less.
double NarrowPhase::motion(const Placement& from, const Placement& to, double radius) {
    float near = 0.0f, opposite = 0.0f;  // a rotation has two quaternions
    for (int k = 0; k < 4; ++k) {
        const float less = to.orientation[k] - from.orientation[k], more = to.orientation[k] + from.orientation[k];
        near += less * less;
        opposite += more * more;
    }
    return (to.position - from.position).norm() + 2.0 * double(std::sqrt(std::min(near, opposite))) * radius;
}

// Runs the work of each thread; on one thread where synchronization costs more than it saves.
template <class Work>
void NarrowPhase::each_share(ThreadPool& pool, Work&& work) {
    if (pool.size() > 1 && entries_.size() >= tuning::parallel_grain)
        return pool.together([&](std::size_t thread) { work(found_[thread]); });
    for (Found& found : found_) work(found);
}

std::vector<Manifold>& NarrowPhase::find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies,
                                         double h, ThreadPool& pool) {
    const bool changed = match(pairs, bodies);
    views_.resize(bodies.size());
    const bool shares_stand = !changed && seen_owners_ == pool.owner_changes();
    seen_owners_ = pool.owner_changes();
    if (!shares_stand) ++share_;
    seen_.resize(bodies.size(), 0);
    each_share(pool, [&](Found& found) {
        found.manifolds.clear();
        found.persistent.clear();
        found.changes.clear();
        if (!shares_stand) take_share(pool, found);
        for (const std::uint32_t i : found.bodies) view(views_[i], bodies[i]);
    });
    each_share(pool, [&](Found& found) {
        for (std::size_t k = 0; k < found.entries.size(); ++k) {
            if (k + ahead < found.entries.size()) ask_for(found.entries[k + ahead]);
            examine(found.entries[k], h, found);
        }
    });
    put_in_order(pool);
    return manifolds_;
}

// Selects the bodies and pairs of a thread. Only bodies in the list: bodies that sleep far from all others are not
// read.
void NarrowPhase::take_share(const ThreadPool& pool, Found& found) {
    const bool alone = found_.size() == 1;
    const auto thread = std::size_t(&found - found_.data());
    const auto own = [&](std::uint32_t body) { return alone || pool.thread_of(body) == thread; };
    found.bodies.clear();
    found.entries.clear();
    for (std::uint32_t k = 0; k < entries_.size(); ++k) {
        for (const std::uint32_t i : {entries_[k].pair.a, entries_[k].pair.b}) {
            if (!own(i) || seen_[i] == share_) continue;
            seen_[i] = share_;
            found.bodies.push_back(i);
        }
        if (own(entries_[k].mover)) found.entries.push_back(k);
    }
}

// Finds the entries for the new list of pairs; returns whether the list differs.
bool NarrowPhase::match(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies) {
    const auto same = [](const Entry& entry, const BroadPhase::Pair& pair) { return entry.pair == pair; };
    if (std::equal(entries_.begin(), entries_.end(), pairs.begin(), pairs.end(), same)) return false;
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
        entry.mover = bodies[pair.a].moves() ? pair.a : pair.b;
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
    return true;
}

void NarrowPhase::forget(std::span<const std::uint32_t> changed) {
    for (const Entry& entry : entries_)
        for (const std::uint32_t i : {entry.pair.a, entry.pair.b})
            if (std::binary_search(changed.begin(), changed.end(), i)) searches_[entry.search] = {};
}

void NarrowPhase::park(const Entry& entry) {
    Parked& parked = parked_[entry.pair];
    parked.search = searches_[entry.search];
    parked.manifolds.assign(manifolds_.begin() + entry.first, manifolds_.begin() + entry.first + entry.count);
    parked.persistent.assign(persistent_.begin() + entry.first, persistent_.begin() + entry.first + entry.count);
}

void NarrowPhase::unpark(Entry& entry) {
    const auto found = parked_.find(entry.pair);
    if (found == parked_.end()) return;
    const Parked& parked = found->second;
    searches_[entry.search] = parked.search;
    entry.first = std::uint32_t(manifolds_.size());
    entry.count = std::uint32_t(parked.manifolds.size());
    manifolds_.insert(manifolds_.end(), parked.manifolds.begin(), parked.manifolds.end());
    persistent_.insert(persistent_.end(), parked.persistent.begin(), parked.persistent.end());
    moved_ = true;
    parked_.erase(found);
}

void NarrowPhase::view(View& v, const Body& body) const {
    if (body.moves())
        v.travel += (body.position - v.pose.position).norm() +
                    2.0 * (body.orientation.coeffs() - v.orientation.coeffs()).norm() * body.radius;
    v.pose = body.pose();
    v.orientation = body.orientation;
    v.radius = body.radius;
    v.velocity.setZero();
    v.spin = v.speculative = 0.0;
    if (body.moves()) {
        v.velocity = body.velocity;
        v.spin = body.angular_velocity.norm() * body.radius;
        v.speculative = tuning::speculative * body.radius;
    }
    const Bounds bounds = world_bounds(body.collider, v.pose);
    v.bounds = bounds;  // through a named variable: see find_gyration()
    v.collider = &body.collider;
    v.awake = awake(body);
    v.flying = body.flying;
    v.surface = contact_surface(body.collider);
}

// Entries are in the order of their first bodies; data of the second body and of the search is scattered.
void NarrowPhase::ask_for(std::uint32_t index) const {
    const Entry& entry = entries_[index];
    const auto* view = reinterpret_cast<const char*>(&views_[entry.pair.b]);
    __builtin_prefetch(&searches_[entry.search]);
    __builtin_prefetch(view);
    __builtin_prefetch(view + 64);
}

void NarrowPhase::examine(std::uint32_t index, double h, Found& found) {
    const Entry& entry = entries_[index];
    const View &a = views_[entry.pair.a], &b = views_[entry.pair.b];
    Search& last = searches_[entry.search];
    const auto drop = [&] {
        if (entry.count == 0) return;
        last.outcome = Search::Outcome::none;
        found.changes.push_back({index, 0, 0});
    };
    // Ballistic bodies meet others at impacts, not at steps.
    if (mode_ == Mode::step && ((!a.awake && !b.awake) || a.flying || b.flying)) return drop();
    const double apart = distance(a.bounds, b.bounds);
    // Most pairs end here: tested first without a square root, by the sum of the components.
    const bool far =
        mode_ == Mode::step &&
        apart > a.speculative + b.speculative + h * ((b.velocity - a.velocity).cwiseAbs().sum() + a.spin + b.spin);
    const double reach = far ? 0.0 : margin(a, b, h);
    if (far || apart > reach) return drop();
    if (!remembers_ || a.surface == ContactSurface::curved || b.surface == ContactSurface::curved)
        return search(index, reach, 0.0, h, found);

    // The bodies' own motion is available and often small enough; otherwise their relative motion is computed.
    const double travel = a.travel + b.travel;
    Standing now = standing(entry, a, b, reach, last, double(last.spent) + (travel - last.travel));
    if (now == Standing::holds) return;
    const bool a_larger = a.radius >= b.radius;
    const View &large = a_larger ? a : b, &small = a_larger ? b : a;
    const Placement now_at = placement(small, large);
    last.spent = rounded_up(double(last.spent) + motion(last.placement, now_at, small.radius));
    last.placement = now_at;
    last.travel = travel;
    if (now == Standing::out_of_date) now = standing(entry, a, b, reach, last, double(last.spent));
    if (now == Standing::holds) return;
    last.sank = last.sank || now == Standing::sank;
    const double moved = last.spent;
    last.spent = 0.0f;
    search(index, reach, moved, h, found);
}

// Validity of the last result after a relative motion (m) of the bodies. Refreshes its manifolds.
NarrowPhase::Standing NarrowPhase::standing(const Entry& entry, const View& a, const View& b, double reach,
                                            const Search& last, double moved) {
    const auto told = [](bool holds) { return holds ? Standing::holds : Standing::out_of_date; };
    const double radius = std::min(a.radius, b.radius);
    if (last.outcome == Search::Outcome::apart) return told(double(last.gap) - moved > reach);
    if (last.outcome == Search::Outcome::none || moved >= tuning::reuse_motion * radius) return Standing::out_of_date;
    const double touch = touch_distance(a.radius, b.radius);
    bool stands = true, missed = false;
    double deepest = 0.0, spare = 0.0;  // of a pair of faces, in one manifold or two
    for (std::uint32_t k = entry.first; k < entry.first + entry.count; ++k) {
        Manifold& m = manifolds_[k];
        refresh(persistent_[k], a.pose, b.pose, m);
        double nearest = reach;
        for (int i = 0; i < m.count; ++i) {
            stands = stands && m.points[std::size_t(i)].separation <= reach;
            nearest = std::min(nearest, m.points[std::size_t(i)].separation);
        }
        deepest = m.more ? std::min(deepest, nearest) : nearest;
        if (!m.more) spare = deepest_reduced_point(persistent_[k], a.pose, b.pose, m);
        const bool last_of_faces = k + 1 == entry.first + entry.count || !manifolds_[k + 1].more;
        missed = missed || (last_of_faces && sank(spare, deepest, radius));
        // A gap within the error of refreshed manifolds on edges and balls may be a touch.
        stands = stands && (nearest <= touch || nearest > moved);
    }
    return missed ? Standing::sank : told(stands);
}

void NarrowPhase::search(std::uint32_t index, double reach, double moved, double h, Found& found) {
    const Entry& entry = entries_[index];
    const View &a = views_[entry.pair.a], &b = views_[entry.pair.b];
    Search& last = searches_[entry.search];
    const double radius = std::min(a.radius, b.radius);
    const auto begin = std::uint32_t(found.manifolds.size());
    found.scratch.axis = last.axis;
    found.scratch.gap = 0.0;
    found.scratch.on_ball = false;
    found.scratch.reduced.clear();
    found.scratch.before = std::span(manifolds_).subspan(entry.first, remembers_ ? entry.count : 0);
    found.scratch.displacement = h * (b.velocity - a.velocity);
    found.scratch.turning = h * a.spin > rolling_turn * a.radius || h * b.spin > rolling_turn * b.radius;
    collide(*a.collider, *b.collider, {a.pose, b.pose, reach, found.scratch, found.manifolds});
    last.axis = std::uint16_t(found.scratch.axis);
    last.gap = rounded_down(found.scratch.gap);
    for (std::size_t k = begin; k < found.manifolds.size(); ++k) {
        const Manifold& m = found.manifolds[k];
        if (!remembers_ || m.count + m.reduced <= 2 * Manifold::capacity) continue;
        last.sank = moved < missed_motion * radius &&
                    (last.sank || missed(std::span(manifolds_).subspan(entry.first, entry.count), m,
                                         reduced(m, found.scratch), radius));
    }
    last.sank = last.sank && entry.count > 0;
    if (last.sank) add_more(entry, radius, begin, found);
    const auto count = std::uint32_t(found.manifolds.size()) - begin;
    // A contact point on a rolling ball moves over it. Left behind by a thousandth of the radius it would support the
    // body from behind, and a slowly rolling body would gain speed out of nothing.
    last.outcome = count == 0              ? Search::Outcome::apart
                   : found.scratch.on_ball ? Search::Outcome::none
                                           : Search::Outcome::near;
    if (count == 0) {
        if (entry.count > 0) found.changes.push_back({index, 0, 0});
        return;
    }
    // The triangles of a mesh are found in the order of its tree.
    const auto first = found.manifolds.begin() + begin;
    if (count > 1) std::stable_sort(first, found.manifolds.end(), earlier);
    const bool swapped = b.surface != ContactSurface::curved &&
                         (b.surface != ContactSurface::polyhedral || a.surface == ContactSurface::curved);
    const bool round = a.surface == ContactSurface::round || b.surface == ContactSurface::round;
    std::uint32_t old = entry.first;
    const std::uint32_t old_end = entry.first + entry.count;
    for (auto m = first; m != found.manifolds.end(); ++m) {
        m->a = entry.pair.a;
        m->b = entry.pair.b;
        const bool alone = m + 1 == found.manifolds.end() || !(m + 1)->more;  // without a second manifold
        const auto bring = [&] {  // moves the old points to their present positions on the larger body
            for (std::size_t i = 0; i < std::size_t(manifolds_[old].count); ++i)
                manifolds_[old].points[i].position = a.radius >= b.radius ? a.pose.to_world(persistent_[old].on_a()[i])
                                                                          : b.pose.to_world(persistent_[old].on_b()[i]);
        };
        while (old < old_end && earlier(manifolds_[old], *m)) ++old;
        if (old < old_end && !earlier(*m, manifolds_[old])) {
            bring();
            match_impulses(manifolds_[old++], matching_distance * radius, *m);
            if (old < old_end && manifolds_[old].part == m->part && alone) {
                bring();
                transfer_impulses(manifolds_[old], *m);
            }
        }
        const bool of_b = round ? m->corners == Corners::of_a : m->on_b() != swapped;
        PersistentManifold& persistent =
            found.persistent.emplace_back(make_persistent_manifold(*m, a.pose, b.pose, of_b));
        if (m->more) continue;
        keep_reduced_points(reduced(*m, found.scratch), std::span(&*m, alone ? 1 : 2), a.pose, b.pose, persistent);
    }
    if (count != entry.count) {
        found.changes.push_back({index, begin, count});
        return;
    }
    std::copy(first, found.manifolds.end(), manifolds_.begin() + entry.first);
    std::copy(found.persistent.begin() + begin, found.persistent.end(), persistent_.begin() + entry.first);
    found.manifolds.resize(begin);
    found.persistent.resize(begin);
}

// Adds second manifolds where reduced points are needed; found after all others.
void NarrowPhase::add_more(const Entry& entry, double radius, std::size_t begin, Found& found) {
    const auto old = std::span(manifolds_).subspan(entry.first, entry.count);
    const std::size_t end = found.manifolds.size();
    for (std::size_t k = begin; k < end; ++k) {
        const auto of_part = [part = found.manifolds[k].part](const Manifold& m) { return m.part == part; };
        const auto first = std::find_if(old.begin(), old.end(), of_part);
        const auto last = std::find_if_not(first, old.end(), of_part);
        if (first == last) continue;
        const Manifold more = grow({first, last}, radius, found.manifolds[k], found.scratch.reduced);
        if (more.count > 0) found.manifolds.push_back(more);
    }
}

// Brings the manifolds into the order of the entries, where any have been added or removed.
void NarrowPhase::put_in_order(ThreadPool& pool) {
    const auto unchanged = [](const Found& found) { return found.changes.empty(); };
    if (!moved_ && std::all_of(found_.begin(), found_.end(), unchanged)) return;
    const auto count = std::uint32_t(entries_.size());
    new_count_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) new_count_[i] = entries_[i].count;
    for (const Found& found : found_)
        for (const Change& change : found.changes) new_count_[change.entry] = change.count;
    new_first_.resize(count);
    std::uint32_t all = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        new_first_[i] = all;
        all += new_count_[i];
    }
    spare_manifolds_.resize(all);
    spare_persistent_.resize(all);
    each_share(pool, [&](const Found& found) {
        // Unchanged manifolds are mostly adjacent: they are copied in one piece.
        Run run;
        const auto flush = [&] {
            copy_plain(manifolds_, run.from, run.count, spare_manifolds_, run.to);
            copy_plain(persistent_, run.from, run.count, spare_persistent_, run.to);
        };
        auto change = found.changes.begin();
        for (const std::uint32_t i : found.entries) {
            if (change != found.changes.end() && change->entry == i) {
                copy_plain(found.manifolds, change->first, change->count, spare_manifolds_, new_first_[i]);
                copy_plain(found.persistent, change->first, change->count, spare_persistent_, new_first_[i]);
                ++change;
                continue;
            }
            const Entry& entry = entries_[i];
            if (entry.count == 0) continue;
            if (entry.first != run.from + run.count || new_first_[i] != run.to + run.count) {
                flush();
                run = {entry.first, new_first_[i], 0};
            }
            run.count += entry.count;
        }
        flush();
    });
    touching_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        entries_[i].first = new_first_[i];
        entries_[i].count = new_count_[i];
        touching_.insert(touching_.end(), new_count_[i], entries_[i].pair);
    }
    ++changes_;
    manifolds_.swap(spare_manifolds_);
    persistent_.swap(spare_persistent_);
    moved_ = false;
}

}  // namespace tumble

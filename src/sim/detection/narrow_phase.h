// Exact manifolds of all pairs that may touch, distributed over the threads and put in order.
//
// A pair remembers its last result. A pair with a gap larger than its motion since then is skipped; a nearly unmoved
// pair refreshes its persistent manifold; otherwise the shapes are searched again. Only relative motion counts: a heap
// that is carried along costs no more than one at rest.
#pragma once

#include "sim/detection/broad_phase.h"
#include "sim/geometry/collide.h"
#include "sim/geometry/persistent_manifold.h"
#include "sim/threads/thread_pool.h"

#include <map>
#include <vector>

namespace tumble {

class NarrowPhase {
public:
    /// step: pairs with an awake body, with the margin of a step. measure: all pairs, touching points only, never from
    /// memory.
    enum class Mode { step, measure };
    enum class Memory { on, off };

    explicit NarrowPhase(int threads, Mode mode = Mode::step, Memory memory = Memory::on)
        : mode_(mode), remembers_(memory == Memory::on && mode == Mode::step), found_(std::size_t(threads)) {}

    /// Manifolds ascending by (a, b, part), valid until the next call. That call keeps the values that the solver has
    /// written into them (impulses, friction, torsional friction) for pairs that still exist; it may come in the same
    /// step again. A pair that leaves the list because both its bodies sleep gets its own back when one wakes.
    /// Precondition: `pairs` ascends.
    std::vector<Manifold>& find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies, double h,
                                ThreadPool& pool);

    /// The results of pairs with one of the bodies hold no longer: it has another shape. `changed` ascends.
    void forget(std::span<const std::uint32_t> changed);

    /// The manifolds of the last call.
    std::vector<Manifold>& manifolds() { return manifolds_; }
    /// Body pairs of these manifolds, in their order: without fetching the manifolds from memory.
    const std::vector<BodyPair>& touching() const { return touching_; }
    /// Increases whenever that list changes.
    std::uint64_t changes() const { return changes_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [mode, remembers, found, entries, spare_entries, searches, free_searches, parked, new_first, new_count,
               views, seen, share, seen_owners, moved, touching, changes, manifolds, spare_manifolds, persistent,
               spare_persistent] = self;
        archive.rebuilt(mode, remembers, seen, share, seen_owners, moved, changes);
        archive.keep(entries, searches, parked, touching, manifolds, persistent);
        archive.any(free_searches);
        archive.by_body_or_none(views);
        archive.scratch(found, spare_entries, new_first, new_count, spare_manifolds, spare_persistent);
        archive.require([&] { return self.sound(); });
    }

private:
    // Data of a body that its pairs need, close together: most pairs read only the first two cache lines.
    struct alignas(64) View {
        Bounds bounds;
        double travel = 0.0;  // m, sum over the calls of the largest motion of any of its points
        double speculative = 0.0;
        Vec3 velocity = Vec3::Zero();
        double spin = 0.0, radius = 0.0;  // spin: m/s of the farthest point
        const CollisionShape* collider = nullptr;
        ContactSurface surface = ContactSurface::polyhedral;
        bool awake = false, flying = false;
        Pose pose;
        Quat orientation = Quat::Identity();
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [bounds, travel, speculative, velocity, spin, radius, collider, surface, awake, flying, pose,
                   orientation] = self;
            archive.keep(travel, pose.position, orientation);
            archive.scratch(bounds, speculative, velocity, spin, radius, collider, surface, awake, flying);
        }
    };
    // Pose of a body in another one's frame; the rotation in single precision, which is enough for distances.
    struct Placement {
        Vec3 position = Vec3::Zero();
        float orientation[4] = {0.0f, 0.0f, 0.0f, 1.0f};  // x, y, z, w
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [position, orientation] = self;
            archive.keep(position, orientation);
        }
    };
    // Memory of a pair: the last search, and the pose of the smaller body relative to the larger, at the search or at a
    // later check, when it had moved by `spent` since. One cache line: there are many pairs, and each costs a fetch
    // from memory.
    struct alignas(64) Search {
        enum class Outcome : std::uint8_t { none, apart, near } outcome = Outcome::none;
        bool sank = false;               // a reduced point sank: from then on no point is removed
        std::uint16_t axis = 0;          // hint for boxes
        float gap = 0.0f, spent = 0.0f;  // m, lower bound of the gap and upper bound of the motion
        double travel = 0.0;             // m, of both bodies until then
        Placement placement;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [outcome, sank, axis, gap, spent, travel, placement] = self;
            archive.enumeration(outcome, Outcome::near);
            archive.any(axis);
            archive.keep(sank, gap, spent, travel, placement);
        }
    };
    static_assert(sizeof(Search) == 64);
    struct Entry {
        BroadPhase::Pair pair;
        std::uint32_t search = 0;            // index in searches_
        std::uint32_t first = 0, count = 0;  // range in manifolds_ and in the persistent manifolds
        std::uint32_t mover = 0;             // index of the pair's body whose thread processes it
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [pair, search, first, count, mover] = self;
            archive.keep(pair);
            archive.body(mover);
            archive.any(search, first, count);
        }
    };
    // An entry of this call with new or moved manifolds, and where the new ones lie.
    struct Change {
        std::uint32_t entry = 0, first = 0, count = 0;
    };
    struct Found {  // results of one thread
        CollisionScratch scratch;
        std::vector<Manifold> manifolds;
        std::vector<PersistentManifold> persistent;
        std::vector<Change> changes;                 // ascending by entry
        std::vector<std::uint32_t> bodies, entries;  // its own, of this call
    };
    struct Parked {
        Search search;
        std::vector<Manifold> manifolds;
        std::vector<PersistentManifold> persistent;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [search, manifolds, persistent] = self;
            archive.keep(search, manifolds, persistent);
        }
    };

    /// True if the manifolds are the manifolds of the entries, in their order, and the searches exist.
    bool sound() const;
    bool match(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies);
    void park(const Entry& entry);
    void unpark(Entry& entry);
    template <class Work>
    void each_share(ThreadPool& pool, Work&& work);
    void take_share(const ThreadPool& pool, Found& found);
    static Placement placement(const View& small, const View& large);
    static double motion(const Placement& from, const Placement& to, double radius);
    void view(View& v, const Body& body) const;
    double margin(const View& a, const View& b, double h) const;
    enum class Standing { holds, out_of_date, sank };
    Standing standing(const Entry& entry, const View& a, const View& b, double reach, const Search& last, double moved);
    void ask_for(std::uint32_t entry) const;
    void examine(std::uint32_t entry, double h, Found& found);
    void search(std::uint32_t entry, double margin, double moved, double h, Found& found);
    void add_more(const Entry& entry, double radius, std::size_t begin, Found& found);
    void put_in_order(ThreadPool& pool);

    Mode mode_;
    bool remembers_;
    std::vector<Found> found_;                    // one per thread
    std::vector<Entry> entries_, spare_entries_;  // ascending by pair
    std::vector<Search> searches_;
    std::vector<std::uint32_t> free_searches_;
    std::map<BroadPhase::Pair, Parked> parked_;         // of sleeping pairs
    std::vector<std::uint32_t> new_first_, new_count_;  // by entry
    std::vector<View> views_;                           // one per body
    std::vector<std::uint64_t> seen_;                   // by body: the last distribution that included it
    std::uint64_t share_ = 0;
    std::uint64_t seen_owners_ = UINT64_MAX;  // ThreadPool::owner_changes() of the last distribution of the pairs
    bool moved_ = false;                      // manifolds_ and the entries are in different orders
    std::vector<BodyPair> touching_;
    std::uint64_t changes_ = 0;
    std::vector<Manifold> manifolds_, spare_manifolds_;
    std::vector<PersistentManifold> persistent_, spare_persistent_;
};

}  // namespace tumble

// Exact manifolds of all pairs that may touch, shared out over the threads and put in order.
//
// A pair remembers what was found for it. Apart by more than it has moved since, it is passed over; nearly unmoved, its
// manifold follows the bodies by its anchors; else the shapes are searched again. Motion counts between the two bodies:
// a heap that is carried along costs no more than one at rest.
#pragma once

#include "sim/detection/broad_phase.h"
#include "sim/geometry/persistent_manifold.h"
#include "sim/geometry/collide.h"
#include "sim/threads/thread_pool.h"

#include <map>
#include <vector>

namespace tumble {

class NarrowPhase {
public:
    /// step: pairs of which one body is awake, with the margin of a step. measure: all pairs, touching points only, never
    /// from memory.
    enum class Mode { step, measure };
    enum class Memory { on, off };

    explicit NarrowPhase(int threads, Mode mode = Mode::step, Memory memory = Memory::on)
        : mode_(mode), remembers_(memory == Memory::on && mode == Mode::step), found_(std::size_t(threads)) {}

    /// Ascending by (a, b, part). Valid until the next call, which takes over what the solver has written into them
    /// (impulses, friction, twist) for the pairs that are still there; it may come in the same step again. A pair that
    /// leaves the list because both its bodies sleep gets its own back when one wakes. `pairs` ascends.
    std::vector<Manifold>& find(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Body>& bodies, double h,
                                ThreadPool& pool);

    /// Whose these manifolds are, one by one: without having to fetch them from memory.
    const std::vector<BodyPair>& touching() const { return touching_; }
    /// Grows whenever that list changes.
    std::uint64_t changes() const { return changes_; }

private:
    // What the pairs need of a body, close together: most look at the first two cache lines only.
    struct alignas(64) View {
        Bounds bounds;
        double travel = 0.0;   // m, sum of what any of its points moved at most from call to call
        double speculative = 0.0;
        Vec3 velocity = Vec3::Zero();
        double spin = 0.0, radius = 0.0;   // spin: m/s of the farthest point
        const CollisionShape* collider = nullptr;
        enum class Kind : std::uint8_t { polyhedron, ball, fixed } kind = Kind::polyhedron;   // fixed: half-space or surface
        bool awake = false, flying = false;
        Pose pose;
        Quat orientation = Quat::Identity();
    };
    // Where a body is in another one's frame; turned in single precision, which is enough to tell how far.
    struct Placement {
        Vec3 position = Vec3::Zero();
        float orientation[4] = {0.0f, 0.0f, 0.0f, 1.0f};   // x, y, z, w
    };
    // What is known of a pair: the last search, and where the smaller body was for the larger, at the search or at a later look, when
    // it had moved by `spent` since. One cache line: there are many pairs, and memory hands them out one by one.
    struct alignas(64) Search {
        enum class Outcome : std::uint8_t { none, apart, near } outcome = Outcome::none;
        bool sank = false;                        // by a point that was left out: from now on no point is given up
        std::uint16_t axis = 0;                   // hint for boxes
        float gap = 0.0f, spent = 0.0f;           // m, at least and at most
        double travel = 0.0;                      // m, of both bodies by then
        Placement placement;
    };
    static_assert(sizeof(Search) == 64);
    struct Entry {
        BroadPhase::Pair pair;
        std::uint32_t search = 0;                 // index in searches_
        std::uint32_t first = 0, count = 0;       // in manifolds_ and anchors_
        std::uint32_t mover = 0;                  // that of the pair's bodies whose thread looks at it
    };
    // Of this call, an entry whose manifolds do not stay where they are: where the new ones lie.
    struct Change {
        std::uint32_t entry = 0, first = 0, count = 0;
    };
    struct Found {                                // by one thread
        CollisionScratch scratch;
        std::vector<Manifold> manifolds;
        std::vector<PersistentManifold> anchors;
        std::vector<Change> changes;              // ascending by entry
        std::vector<std::uint32_t> bodies, entries;   // its own, of this call
    };
    struct Parked {
        Search search;
        std::vector<Manifold> manifolds;
        std::vector<PersistentManifold> anchors;
    };

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
    void search(std::uint32_t entry, const View& a, const View& b, double margin, double moved, double h, Found& found);
    void add_more(const Entry& entry, double radius, std::size_t begin, Found& found);
    void put_in_order(ThreadPool& pool);

    Mode mode_;
    bool remembers_;
    std::vector<Found> found_;                    // one a thread
    std::vector<Entry> entries_, spare_entries_;  // ascending by pair
    std::vector<Search> searches_;
    std::vector<std::uint32_t> free_searches_;
    std::map<BroadPhase::Pair, Parked> parked_;   // of sleeping pairs
    std::vector<std::uint32_t> new_first_, new_count_;   // by entry
    std::vector<View> views_;                     // one a body
    std::vector<std::uint64_t> seen_;             // by body: the last time of sharing out that it came up in
    std::uint64_t share_ = 0;
    std::uint64_t seen_owners_ = UINT64_MAX;      // of the bodies, when the pairs were shared out last
    bool moved_ = false;                          // manifolds_ and the entries are no longer in the same order
    std::vector<BodyPair> touching_;
    std::uint64_t changes_ = 0;
    std::vector<Manifold> manifolds_, spare_manifolds_;
    std::vector<PersistentManifold> anchors_, spare_anchors_;
};

}  // namespace tumble

// Hits within a step, at their own times. At the end of a step the bodies overlap, and the normal and the points of
// that pose are not those of the hit: a ball that is hit off its center would leave in a wrong direction. So the bodies
// go back to the poses in which they met, get their impulses there, and go on with their new velocities for the rest of
// the step, in which they may meet others. This keeps the momenta, the angular momentum about any point, and the
// energy.
#pragma once

#include "sim/ccd/time_of_impact.h"
#include "sim/contact/model/contact.h"
#include "sim/geometry/manifold.h"
#include "sim/math/wrench.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

class ContactDetection;
struct StepContext;

/// The manifolds of an island: their pairs of bodies, and their indices.
struct HitIsland {
    std::span<const BodyPair> pairs;
    std::span<const std::uint32_t> manifolds;
    std::size_t touching_pairs;  // number of different pairs
};

class HitStage {
public:
    /// Resolves the hits of the last step between bodies without joints. `step`: the coming step; `detection`: with the
    /// contacts of the present poses. Returns whether any body was hit, and moved: these contacts are then out of date.
    bool resolve(const StepContext& step, ContactDetection& detection);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [movers, hits, cluster, contacts, first_of_pair, search, scratch, found] = self;
        archive.scratch(movers, hits, cluster, contacts, first_of_pair, scratch, found);
        archive.keep(search);
    }

private:
    struct Mover {  // a body that was hit
        std::uint32_t body;
        double lag;        // s, from its last hit to the end of the step
        BodyVelocity way;  // of its pose since then
    };
    struct Hit {
        std::uint32_t a, b;
        double lag;  // s, from the hit to the end of the step
    };
    struct Member {  // a body at the time of a hit
        std::uint32_t body;
        Vec3 position;  // at the end of the step, as are the others
        Quat orientation;
        Mat3 rotation;
        Vec3 momentum, angular_momentum;
        BodyVelocity velocity;                      // of a kinematic body
        Impulse late;                               // of the forces from the hit to the end of the step
        Vec3 momentum_then, angular_momentum_then;  // before the hit
        bool struck = false;
    };
    bool resolve_island(const HitIsland& island, const std::vector<Manifold>& manifolds, const StepContext& step);
    Mover mover(std::uint32_t body, const StepContext& step) const;
    std::optional<Hit> next_hit(std::uint32_t a, std::uint32_t b, const StepContext& step);
    void find_touch(const Hit& hit, const StepContext& step);
    bool gather(const Hit& hit, const HitIsland& island, const std::vector<Manifold>& manifolds,
                const StepContext& step);
    bool strike(const Hit& hit, const HitIsland& island, const std::vector<Manifold>& manifolds,
                const StepContext& step);
    void join(std::uint32_t body, double lag, const HitIsland& island, const std::vector<Manifold>& manifolds,
              const StepContext& step);
    static void leave(const Member& member, std::vector<Body>& bodies);
    void go_on(const Member& member, double rest, const StepContext& step);
    bool add_touching(std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> pair,
                      const std::vector<Manifold>& manifolds, const StepContext& step);

    std::vector<Mover> movers_;
    std::vector<Hit> hits_;
    std::vector<Member> cluster_;
    std::vector<Contact> contacts_;
    std::size_t first_of_pair_ = 0;
    ImpactSearch search_;
    CollisionScratch scratch_;
    std::vector<Manifold> found_;
};

}  // namespace tumble

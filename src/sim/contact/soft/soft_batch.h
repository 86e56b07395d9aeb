// Islands of the soft solver (soft_solver.h) in the kernel's lanes (soft_layout.h).
//
// A sweep visits each block's manifolds, color by color, and then those between the blocks. Blocks share no moving
// body: each thread has its own blocks, whose bodies and rows stay in its core's cache, and threads synchronize twice
// per sweep, not once per color.
#pragma once

#include "sim/contact/soft/aligned_floats.h"
#include "sim/contact/soft/energy_budget.h"
#include "sim/contact/soft/soft_areas.h"
#include "sim/contact/soft/soft_joints.h"
#include "sim/contact/soft/soft_kernel.h"
#include "sim/contact/soft/soft_layout.h"
#include "sim/contact/soft/soft_resistance.h"
#include "sim/contact/soft/soft_solver.h"
#include "sim/threads/spin_barrier.h"

#include <cstdint>
#include <vector>

namespace tumble {

class SoftBatch {
public:
    explicit SoftBatch(const soft::Kernel& kernel);

    /// prepare() is called by one thread, the following functions by all threads of a team.
    /// - `layout`: closed, and valid until then.
    /// - slot: as in the layout.
    /// - `batch`: gives the factor of the number of substeps, and the joints.
    /// - `mass_unit` (kg): unit of masses and impulses, a power of two.
    /// - `again`: the batch is that of the last step.
    /// - `resists`: some bodies resist turning.
    void prepare(const ContactProblem& problem, const IslandBatch& batch, const SoftLayout& layout,
                 const std::vector<std::uint32_t>& slot, double mass_unit, bool again, bool resists);
    /// `batch`: gets the lost energy of a net. `carried`: by joint, gets the moments of soft_joints.h.
    void run(const ContactProblem& problem, IslandBatch& batch, const std::vector<std::uint32_t>& slot,
             std::vector<Vec3>& carried, std::size_t thread, std::size_t team, SpinBarrier& barrier);

private:
    // Data of a body needed for packing, close together in memory.
    struct PackedBody {
        Vec3 position = Vec3::Zero();
        double radius = 0.0, friction = 0.0, restitution = 0.0;
        std::uint32_t slot = 0;
        PairRules pair_rules;
        bool dynamic = false;
        bool rotates_fast = false;  // rotates so fast that its corners approach along curves
    };
    // The manifold points that the points of a lane stand for.
    struct Source {
        std::uint8_t count = 0;
        std::uint8_t point[Manifold::capacity] = {};
        bool swapped = false;  // the lane's A is the manifold's B
    };

    static soft::Softness softness(double frequency, double d);
    static PackedBody packed(const Body& body, std::uint32_t slot) {
        return {body.position, body.radius, body.friction, body.restitution, slot, body.pair_rules, body.dynamic()};
    }
    void pack_bodies(const ContactProblem& problem, std::size_t first, std::size_t last);
    void pack_movers(const ContactProblem& problem);
    const PackedBody& find_packed(std::uint32_t body, std::uint32_t manifold, const ContactProblem& problem,
                                  const std::vector<std::uint32_t>& slot, PackedBody& made) const;
    void pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t group, std::size_t l,
                   const std::vector<std::uint32_t>& slot);
    void pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot);
    void unpack(const ContactProblem& problem, std::size_t group);
    void hand_back(const ContactProblem& problem, std::size_t first, std::size_t last);

    float* state(std::size_t s) { return state_.data() + soft::body_floats * s; }
    float* rows_of(std::size_t group) { return rows_.data() + group * soft::group_rows * std::size_t(kernel_.lanes); }

    const soft::Kernel& kernel_;
    double d_ = 0.0;  // s, length of a substep
    int substeps_ = 1;
    double mass_unit_ = 1.0;  // kg
    soft::Substep substep_{};
    AlignedFloats state_, inertia_, before_, forces_, rows_;  // before_, forces_: 8 floats per slot
    const SoftLayout* layout_ = nullptr;  // slot k + 1 is the k-th body of its blocks' order; the movers follow
    std::size_t slots_ = 0;
    std::vector<PackedBody> packed_;  // by slot
    IslandEnergies energies_;
    SoftJoints joints_;
    SoftAreas areas_;
    SoftResistance resistance_;
    std::vector<std::uint32_t> lane_bodies_;
    std::vector<std::uint16_t> lane_moved_;
    std::vector<std::uint8_t> lane_points_;
    std::vector<Source> sources_;        // by lane
    std::vector<std::uint8_t> reached_;  // by slot: whether an impulse has reached it
};

}  // namespace tumble

// Islands that are solved softly (soft_solver.h), in the kernel's lanes (soft_layout.h).
//
// A sweep goes through each block's manifolds, colour by colour, and then through those between the blocks. Blocks share no
// moving body: each thread keeps to its own, whose bodies and rows stay in its core's cache, and the threads meet twice a
// sweep, not once a colour.
#pragma once

#include "sim/contact/soft/island_energies.h"
#include "sim/contact/soft/soft_kernel.h"
#include "sim/contact/soft/soft_layout.h"
#include "sim/contact/soft/soft_solver.h"
#include "sim/threads/spin_barrier.h"

#include <cstdint>
#include <vector>

namespace tumble {

class SoftBatch {
public:
    explicit SoftBatch(const soft::Kernel& kernel);

    /// By one thread; then all the rest, by all threads of a team. `layout`: closed, and to stay until then. slot: as it has them.
    /// `finer`: times as many substeps; `mass_unit` (kg): a power of two that masses and impulses are counted in.
    void prepare(const ContactProblem& problem, int finer, const SoftLayout& layout, double mass_unit);
    void run(const ContactProblem& problem, const std::vector<std::uint32_t>& slot, std::size_t thread, std::size_t team,
             SpinBarrier& barrier);

private:
    // Memory aligned for the widest kernel.
    class Floats {
    public:
        void resize(std::size_t count);
        float* data() { return data_; }

    private:
        std::vector<float> memory_;
        float* data_ = nullptr;
    };
    // What packing needs of a body, close together in memory.
    struct Place {
        Vec3 position = Vec3::Zero();
        double radius = 0.0, friction = 0.0, restitution = 0.0;
        std::uint32_t slot = 0;
        bool dynamic = false;
        bool swings = false;   // turns so fast that its corners come down along curves
    };
    // Which points of a lane's manifold are its points.
    struct Source {
        std::uint8_t count = 0;
        std::uint8_t point[Manifold::capacity] = {};
        bool swapped = false;   // the lane's A is the manifold's B
    };

    static soft::Softness softness(double frequency, double d);
    static Place place_of(const Body& body, std::uint32_t slot) {
        return {body.position, body.radius, body.friction, body.restitution, slot, body.dynamic()};
    }
    void pack_bodies(const ContactProblem& problem, std::size_t first, std::size_t last);
    void pack_movers(const ContactProblem& problem);
    const Place& find_place(std::uint32_t body, std::uint32_t manifold, const ContactProblem& problem,
                            const std::vector<std::uint32_t>& slot, Place& made) const;
    void pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t group, std::size_t l,
                   const std::vector<std::uint32_t>& slot);
    void pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot);
    void unpack(const ContactProblem& problem, std::size_t group);
    void hand_back(const ContactProblem& problem, std::size_t first, std::size_t last);

    float* state(std::size_t s) { return state_.data() + soft::body_floats * s; }
    float* row(std::size_t group, int r) { return rows_.data() + (group * soft::group_rows + std::size_t(r)) * std::size_t(kernel_.lanes); }

    const soft::Kernel& kernel_;
    double d_ = 0.0;                                  // s, a substep
    int substeps_ = 1;
    double mass_unit_ = 1.0;                          // kg
    soft::Substep substep_{};
    Floats state_, inertia_, before_, forces_, rows_;    // before_, forces_: 8 floats a slot
    const SoftLayout* layout_ = nullptr;              // slot k + 1 is the k-th of its blocks' order; then the movers'
    std::size_t slots_ = 0;
    std::vector<Place> places_;                       // by slot
    IslandEnergies energies_;
    std::vector<std::uint32_t> lane_bodies_;
    std::vector<std::uint16_t> lane_moved_;
    std::vector<std::uint8_t> lane_points_;
    std::vector<Source> sources_;                     // by lane
    std::vector<std::uint8_t> reached_;               // by slot: whether an impulse has
};

}  // namespace tumble

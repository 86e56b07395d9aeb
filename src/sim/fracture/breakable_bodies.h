// All bodies of a world that can break, and the joints that pieces take with them.
#pragma once

#include "sim/fracture/breakable_body.h"
#include "sim/joints/joint.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class BreakableBodies {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// Makes the bodies of all cells absent. `scene_index`: by body, its index in the scene.
    BreakableBodies(const SceneDescription& scene, std::span<const std::uint32_t> scene_index,
                    const std::vector<Joint>& joints, std::vector<Body>& bodies);

    bool empty() const { return list_.empty(); }
    std::size_t size() const { return list_.size(); }
    BreakableBody& operator[](std::uint32_t entry) { return list_[entry]; }
    const BreakableBody& operator[](std::uint32_t entry) const { return list_[entry]; }
    /// The entry that a body belongs to, as the whole or as a cell; or none.
    std::uint32_t entry_of(std::uint32_t body) const { return owner_.empty() ? none : owner_[body]; }
    /// The body that moves a body: for a body in pieces its first piece, for a cell its piece, otherwise the body
    /// itself.
    std::uint32_t mover_of(std::uint32_t body) const;

    /// Completes the state of a body, which has that of its mover: of a cell its share of a piece.
    void describe(std::uint32_t body, const Body& mover, BodyState& state) const;

    /// The same for the report of a cell, whose body may be absent.
    void describe(std::uint32_t body, BodyReport& report) const;

    /// Joints act on the pieces that hold their anchors.
    void attach(std::vector<Joint>& joints, const std::vector<Body>& bodies) const;
    /// Makes the bodies of all pieces, for a world that goes on from a checkpoint: masses and shapes, not states.
    void rebuild(std::vector<Body>& bodies, std::vector<Joint>& joints);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [list, owner, cell, anchors] = self;
        archive.keep_each(list);
        archive.rebuilt(owner, cell, anchors);
    }

private:
    struct Anchor {  // of a joint, on a body that can break
        std::size_t joint;
        bool second;  // its second body
        std::uint32_t entry, cell;
        Vec3 place;  // m, body frame, from the body's origin
    };

    std::vector<BreakableBody> list_;   // in the order of the scene
    std::vector<std::uint32_t> owner_;  // by body
    std::vector<std::uint32_t> cell_;   // by body: of the bodies of cells
    std::vector<Anchor> anchors_;
};

}  // namespace tumble

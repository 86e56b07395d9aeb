#include "sim/fracture/breakable_bodies.h"

#include <Eigen/Eigenvalues>

namespace tumble {

BreakableBodies::BreakableBodies(const SceneDescription& scene, std::span<const std::uint32_t> scene_index,
                                 const std::vector<Joint>& joints, std::vector<Body>& bodies) {
    std::vector<std::uint32_t> place;
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
        if (!scene.bodies[k].fracture) continue;
        if (place.empty()) {
            place.resize(bodies.size());
            for (std::uint32_t i = 0; i < bodies.size(); ++i) place[scene_index[i]] = i;
            owner_.assign(bodies.size(), none);
            cell_.assign(bodies.size(), none);
        }
        const auto entry = std::uint32_t(list_.size());
        const BreakableBody& body = list_.emplace_back(scene, k, place, bodies);
        owner_[body.whole()] = entry;
        for (std::uint32_t cell = 0; cell < body.cells(); ++cell) {
            owner_[body.body_of(cell)] = entry;
            cell_[body.body_of(cell)] = cell;
        }
    }
    if (list_.empty()) return;
    for (std::size_t k = 0; k < joints.size(); ++k)
        for (const bool second : {false, true}) {
            const std::uint32_t i = second ? joints[k].b : joints[k].a;
            if (i == Joint::world || owner_[i] == none) continue;
            const Vec3 place_of_anchor = (second ? joints[k].anchor_b : joints[k].anchor_a) + bodies[i].center_of_mass;
            anchors_.push_back({k, second, owner_[i], list_[owner_[i]].cell_at(i, place_of_anchor), place_of_anchor});
        }
}

std::uint32_t BreakableBodies::mover_of(std::uint32_t body) const {
    const std::uint32_t entry = entry_of(body);
    if (entry == none || !list_[entry].in_pieces()) return entry == none ? body : list_[entry].whole();
    return list_[entry].piece_of(cell_[body] == none ? 0 : cell_[body]);
}

void BreakableBodies::describe(std::uint32_t body, const Body& mover, BodyState& state) const {
    const std::uint32_t entry = entry_of(body);
    if (entry == none) return;
    const BreakableBody& owner = list_[entry];
    const std::uint32_t cell = cell_[body];
    state.absent = owner.in_pieces() == (cell == none);
    const Vec3& center = cell == none ? owner.center_of_mass() : owner.mass_of(cell).center_of_mass;
    const Vec3 arm = mover.rotation * (center - mover.center_of_mass);
    state.center_of_mass += arm;
    state.velocity = mover.point_velocity(arm);
    if (state.absent) {
        state.mass = 0.0;
        state.momentum.setZero();
        state.angular_momentum.setZero();
    } else if (cell != none && mover.dynamic()) {
        const MassProperties& own = owner.mass_of(cell);
        state.mass = own.mass;
        state.momentum = own.mass * state.velocity;
        state.angular_momentum = mover.rotation * (own.inertia * (mover.rotation.transpose() * mover.angular_velocity));
    }
}

void BreakableBodies::describe(std::uint32_t body, BodyReport& report) const {
    const std::uint32_t entry = entry_of(body);
    if (entry == none || cell_[body] == none) return;
    const MassProperties& own = list_[entry].mass_of(cell_[body]);
    report.mass = own.mass;
    report.inertia = own.inertia;
    report.principal_inertia = Eigen::SelfAdjointEigenSolver<Mat3>(own.inertia).eigenvalues();
    report.center_of_mass = own.center_of_mass;
}

void BreakableBodies::attach(std::vector<Joint>& joints, const std::vector<Body>& bodies) const {
    for (const Anchor& anchor : anchors_) {
        Joint& joint = joints[anchor.joint];
        const std::uint32_t piece = list_[anchor.entry].piece_of(anchor.cell);
        (anchor.second ? joint.b : joint.a) = piece;
        (anchor.second ? joint.anchor_b : joint.anchor_a) = anchor.place - bodies[piece].center_of_mass;
    }
}

void BreakableBodies::rebuild(std::vector<Body>& bodies, std::vector<Joint>& joints) {
    for (BreakableBody& body : list_) body.rebuild(bodies);
    attach(joints, bodies);
}

}  // namespace tumble

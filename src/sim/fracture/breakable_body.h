// A body with bonds (scene/description/fracture.h), whole or in pieces. It stands in the list of bodies as the whole
// and as one body for each of its cells. A piece is a set of cells that bonds connect: the body of its first cell moves
// for all of them, with a compound of their shapes; the bodies of the others are absent. The whole and its pieces share
// one body frame, with the same origin.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"
#include "sim/fracture/bond_graph.h"
#include "sim/snapshot/break_record.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

class BreakableBody {
public:
    /// Makes the bodies of the cells absent. `scene_body`: index of the whole in the scene; `place`: index in `bodies`
    /// of each body of the scene.
    BreakableBody(const SceneDescription& scene, std::size_t scene_body, std::span<const std::uint32_t> place,
                  std::vector<Body>& bodies);

    const FractureDescription& description() const { return *description_; }
    const BondGraph& graph() const { return graph_; }
    /// To solve for its forces; part() takes bonds.
    BondGraph& graph() { return graph_; }
    std::size_t cells() const { return cells_.size(); }
    std::uint32_t whole() const { return whole_; }
    double blow_time() const { return blow_time_; }         // s
    const Vec3& center_of_mass() const { return center_; }  // m, of the whole, from its origin
    /// The body of a cell, and the body that moves the cell now.
    std::uint32_t body_of(std::uint32_t cell) const { return own_[cell]; }
    std::uint32_t piece_of(std::uint32_t cell) const { return piece_[cell]; }
    /// The cells of a piece, ascending.
    std::vector<std::uint32_t> cells_of(std::uint32_t piece) const;
    const MassProperties& mass_of(std::uint32_t cell) const { return cells_[cell].mass; }
    /// Frame: that of the body, with its origin in the center of mass of the cell.
    const Polyhedron& hull_of(std::uint32_t cell) const;
    const CollisionShape& collider_of(std::uint32_t cell) const { return cells_[cell].collider; }
    /// False for a piece that has broken as often as it may, or has no bonds.
    bool may_break(std::uint32_t piece) const;
    bool in_pieces() const { return in_pieces_; }
    /// The bodies that move its cells, ascending.
    const std::vector<std::uint32_t>& pieces() const { return pieces_; }

    /// A bond that fails under a wrench (N, N m); without its time, body and energy.
    BreakRecord record(std::uint32_t bond, const Wrench& wrench) const;

    /// The cell of a piece that is nearest to a point (m, body frame, from the body's origin).
    std::uint32_t cell_at(std::uint32_t piece, const Vec3& point) const;

    /// A body that has come apart.
    struct Parting {
        Body whole;                         // as it was
        std::uint32_t index = 0;            // of the whole
        std::vector<std::uint32_t> pieces;  // bodies; one of them may have the index of the whole
    };
    /// The piece that is nearest to a point, which all pieces have in the same place of the body.
    std::uint32_t piece_at(const Vec3& point) const;
    /// Takes the bonds of the graph over: the bodies of pieces that have come apart appear, with the motion of the
    /// bodies that they were part of, and the latter vanish.
    std::vector<Parting> part(BondGraph graph, std::vector<Body>& bodies);

    /// Makes the bodies of its pieces after a checkpoint has been read: masses and shapes, not states.
    void rebuild(std::vector<Body>& bodies);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [description, graph, whole, own, piece, pieces, generation, cut, cells, type, track, center, blow_time,
               in_pieces] = self;
        archive.rebuilt(description, graph, whole, own, piece, pieces, cells, type, track, center, blow_time,
                        in_pieces);
        for (auto& times : generation) archive.count(times);
        for (auto& failed : cut) archive.between(std::uint8_t(0), failed, std::uint8_t(1));
    }

private:
    struct Cell {
        MassProperties mass;  // about its center of mass, in the body frame
        CollisionShape collider;
    };
    Parting part(std::uint32_t old, const BondGraph& graph, std::vector<Body>& bodies);
    template <class Choose>
    std::uint32_t nearest_cell(const Vec3& point, const Choose& choose) const;
    void compose(const std::vector<std::uint32_t>& cells, Body& body) const;

    std::shared_ptr<const FractureDescription> description_;
    BondGraph graph_;
    std::uint32_t whole_ = 0;
    std::vector<std::uint32_t> own_, piece_;  // by cell: bodies
    std::vector<std::uint32_t> pieces_;       // bodies, ascending
    std::vector<int> generation_;             // by cell: how many times its piece has broken
    std::vector<std::uint8_t> cut_;           // by bond: 1 if it has failed
    std::vector<Cell> cells_;
    BodyType type_ = BodyType::dynamic;  // of the whole, and of pieces that bonds hold to the world
    std::shared_ptr<const KeyframeTrack> track_;
    Vec3 center_ = Vec3::Zero();  // m
    double blow_time_ = 0.0;      // s
    bool in_pieces_ = false;
};

/// The bonds that fail first, ascending: from a utilization of 1 on (by bond), and no less than all bonds of the same
/// two cells: a crack relieves its neighborhood.
std::vector<std::uint32_t> failing_first(const BondGraph& graph, std::span<const double> utilization);

/// The bodies that vanished, appeared or have another shape, ascending.
std::vector<std::uint32_t> changed_bodies(std::span<const BreakableBody::Parting> partings);

}  // namespace tumble

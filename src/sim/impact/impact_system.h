// Equations of one impact: the touching contacts of an island, over mass-weighted velocities of its bodies
// (velocity_row.h). Each contact is a unit row with v_rel = length (w . y + offset). The offset is the contribution of
// fixed and kinematic bodies, which have a velocity but no entry in y. An impulse j moves y by j length along w.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/impact/joined_groups.h"
#include "sim/impact/mass_root.h"
#include "sim/impact/velocity_row.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace tumble {

/// Bodies that an impact can reach: connected dynamic bodies, and their contacts; both ascending.
struct Island {
    std::vector<std::uint32_t> bodies, contacts;
    std::vector<Joint*> joints =
        {};  // that hold any of the bodies; with a body of a joint the list has all of its group
    std::span<const Joint> all_joints = {};  // of the set: gears name theirs by number
};

/// The impulses of an impact one by one, if asked for: one entry for each contact and pass of the law.
struct ImpactTrace {
    struct Entry {
        std::uint32_t contact;             // index in the list of contacts
        int pass;                          // of the law, from 0
        double speed_before, speed_after;  // v_rel, m/s
        double restitution;                // that the law used
        double impulse;                    // N s along the normal
    };
    std::vector<Entry> entries;
    int passes = 0;
};

class ImpactSystem {
public:
    /// Reads the island's touching contacts. Both lists are kept by reference; nothing is changed before store().
    /// `trace`: gets the impulses of the passes, or null.
    ImpactSystem(const Island& island, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                 ImpactTrace* trace = nullptr);

    /// Rows of contacts, then rows of joints at their limits.
    std::size_t size() const { return rows_.size(); }
    std::size_t contacts() const { return index_.size(); }
    std::size_t bodies() const { return roots_.size(); }
    const std::vector<VelocityRow>& rows() const { return rows_; }
    const Contact& contact(std::size_t i) const { return contacts_[index_[i]]; }
    double restitution(std::size_t i) const {
        return i < contacts() ? contact(i).restitution : groups_->limits()[limit_[i - contacts()]].restitution;
    }
    bool flies(std::size_t i) const {
        return i < contacts() && (bodies_[contact(i).a].flying || bodies_[contact(i).b].flying);
    }
    std::uint32_t contact_index(std::size_t i) const { return index_[i]; }
    /// Products of a projection on all rows: rows squared times the numbers of the longest.
    double work() const;

    /// v_rel, m/s.
    double speed(std::size_t i) const { return length_[i] * (rows_[i].dot(velocity_) + offset_[i]); }
    double length(std::size_t i) const { return length_[i]; }  // kg^-1/2
    /// m/s: slower approaches are rounding. Follows from the initial velocities.
    double rounding() const { return rounding_; }
    bool approaching(std::size_t i) const { return speed(i) < -rounding_; }
    /// |y| of all the cluster's bodies moving with the fastest wall; 0 without a moving wall.
    double wall_velocity() const { return wall_velocity_; }
    const Eigen::VectorXd& velocity() const { return velocity_; }

    /// n . (velocity of B's point - velocity of A's point) along any direction as a form of y, and its offset, m/s. The
    /// form of joined bodies is that of their groups; without mobility it is empty.
    VelocityRow relative_row(const Contact& c, const Vec3& direction);
    double offset(const Contact& c, const Vec3& direction) const;

    /// Adds `amount` along the unit row of contact i: an impulse of amount / length.
    void apply(std::size_t i, double amount) {
        rows_[i].add_to(velocity_, amount);
        if (groups_) apply_own(rows_[i], amount);
        impulse_[i] += amount / length_[i];
    }
    /// Adds `amount` N s along a form from relative_row().
    void apply_along(const VelocityRow& row, double amount) {
        row.add_to(velocity_, amount);
        if (groups_) apply_own(row, amount);
    }
    double impulse(std::size_t i) const { return impulse_[i]; }  // N s, sum of all pushes
    /// True if the impulse is more than rounding, which gives some contacts a push, and not their mirror images.
    bool felt(std::size_t i) const;

    /// For the trace of a pass: announce() its pushes before the first of them, end_pass() after the last.
    bool traced() const { return trace_ != nullptr; }
    void announce(std::size_t i, double amount, double restitution);
    void end_pass();

    /// Writes the velocities of changed bodies, and each touching contact's impulse and v_rel. Returns the impulses of
    /// the joints; the momenta before the impact must be those of the bodies.
    std::vector<JointImpulse> store(std::vector<Contact>& contacts, std::vector<Body>& bodies);
    /// The same without the contacts.
    std::vector<JointImpulse> store_velocities(std::vector<Body>& bodies);

private:
    std::uint32_t place(std::uint32_t body) const;
    bool joined(std::uint32_t place) const { return place != VelocityRow::none && groups_->joined(place); }
    VelocityRow join(const VelocityRow& own);
    void apply_own(const VelocityRow& row, double amount);
    void add_row(const VelocityRow& form, double speed);
    double speed_at_start(std::size_t i) const { return length_[i] * (rows_[i].dot(start_) + offset_[i]); }
    void add_limits();

    const std::vector<std::uint32_t>& body_index_;  // ascending
    const std::vector<Contact>& contacts_;
    const std::vector<Body>& bodies_;
    std::vector<MassRoot> roots_;
    Eigen::VectorXd velocity_, start_;  // present and initial y
    std::vector<std::uint32_t> index_;  // row to contact
    std::vector<std::size_t> limit_;    // row, after the rows of contacts, to limit
    std::vector<VelocityRow> rows_;
    std::vector<double> length_, offset_, impulse_;
    double rounding_ = 0.0, wall_velocity_ = 0.0;
    ImpactTrace* trace_ = nullptr;
    std::vector<std::size_t> announced_;  // rows of this pass, for the trace

    // With joints alone. Joined bodies' velocity_ is the part that fits their joints: an impact keeps the rest.
    std::optional<JoinedGroups> groups_;
    std::deque<JoinedRow> joined_rows_;
    std::vector<VelocityRow> own_;  // by JoinedRow::own: the form of the struck bodies alone
    Eigen::VectorXd pushed_;        // change of y by the pushes on joined bodies, without their joints
};

}  // namespace tumble

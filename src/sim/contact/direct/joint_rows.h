// The joints of one island as rows of the Jacobian J over its velocities, for the direct solver
// (docs/explanation/joints.md).
//
// Each row is one law of one coordinate: its impulse is
//   f = clamp(e + (b - J u) / R, least, most)
// with the estimate e of the last round. The laws differ in these numbers only:
//   lock    no bounds; b closes the coordinate's error at the end of the step
//   limit   f >= 0 (lower) or f <= 0 (upper); b = -distance / h
//   spring  R = 1 / (h (h K + C)), b = (K (rest - value) + C v) / (h K + C), e = 0: implicit, stable for any K and C
//   motor   as a spring to its target, or b = speed; bounds: its largest force times h
//   friction b = 0; bounds: its force times h; of a ball, one for the length of the vector of three rows
// Rows of angles are scaled by the island's length, as the angular velocities are: all rows are in m/s and N s.
#pragma once

#include "sim/contact/direct/contact_rows.h"
#include "sim/contact/direct/gear_row.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/joints/gear.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/pendulum_rate.h"
#include "sim/math/block_cholesky.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The island that the rows belong to.
struct JointIsland {
    const ContactProblem& problem;
    std::span<const std::uint32_t> bodies;  // ascending
    std::span<const std::uint32_t> joints;  // indices into JointSet::active()
    double length;                          // m, that scales angular velocities
    double from, to;                        // s: of the step or substep
};

class JointRows {
public:
    static constexpr int none = contact_rows::none;
    struct Row {
        double on_a[6] = {}, on_b[6] = {};
        double offset = 0.0;                   // m/s, of bodies with prescribed velocity
        double target = 0.0;                   // m/s: b
        double estimate = 0.0, impulse = 0.0;  // N s: e and f
        double speed = 0.0, change = 0.0;      // m/s: J u + offset, J du
        double compliance = 0.0;               // 1/kg: R
        double least = 0.0, most = 0.0;        // N s
        // m or rad, of locks and limits: value of the coordinate at the end of the step, and the one to be pushed to.
        double reference = 0.0, goal = 0.0;
        double weight = 0.0;  // kg: 1 / R where f is not at a bound
        Vec3 direction = Vec3::Zero();
        std::int8_t bound = 2;  // of f: -1 least, 0 none, 1 most; 2 not known
        std::uint8_t coordinate = 0;
        Joint::Law law = Joint::lock;
        bool closes = false;   // takes part in close()
        bool rests = false;    // a limit that the coordinate is at from the start
        bool bounces = false;  // a limit with restitution that the coordinate is to meet with its whole speed: open
        double room = 0.0, approach = 0.0;  // m or rad, and m/s or rad/s: of such a limit, at the start
        bool soft = false;         // its estimate stays 0: a spring; in a correction, a row whose error is moved out
        bool inert = false;        // a spring with the armature: it acts in the fit too
        bool starts_ball = false;  // this row and the next two are a vector of friction, bounded by `most` in length
        bool turns() const { return coordinate >= 3; }
    };
    /// A gear, which has one row: where it acts.
    struct GearSide {
        std::uint32_t joint = 0;
        int a = none, b = none;
        Vec3 point = Vec3::Zero(), direction = Vec3::Zero();
        bool turns = false;
        double factor = 0.0;  // of the impulse of the row, in units of the rows of joints
    };
    struct Gear {
        GearRow row;
        std::array<GearSide, 2> sides;
        double value = 0.0;  // m or rad: largest term of the relation
    };
    struct Block {
        std::uint32_t joint = 0;
        int a = none, b = none;
        std::uint32_t pair = 0;  // index in the matrix
        std::size_t first = 0, count = 0;
        Vec3 point = Vec3::Zero();
        FreeAxes axes;
        bool breaks = false;  // gives way in this step: its impulses stay as they are
        Gear* gear = nullptr;
    };

    /// The impact of a coordinate on its limit, at the end of a part of the step.
    struct Strike {
        std::uint32_t joint = 0;
        std::uint8_t coordinate = 0;
        Joint::Law law = Joint::lower;
        double time = 0.0;     // s, from the start of the part
        double rebound = 0.0;  // m/s or rad/s
    };

    bool empty() const { return blocks_.empty(); }
    std::span<Row> rows() { return rows_; }
    std::span<const Row> rows(const Block& block) const { return std::span(rows_).subspan(block.first, block.count); }
    double length() const { return length_; }  // m, of the island
    /// True if the impulses of the last step have settled: only then are they estimates of the next ones.
    bool estimated() const;
    /// True if the joints form no loop: otherwise their impulses are not unique, and the last step gives no estimate.
    bool tree() const { return tree_; }
    std::span<Block> blocks() { return blocks_; }
    void clear() {
        blocks_.clear();
        gears_.clear();
        rows_.clear();
    }

    /// Begins a step of `h` s. Limits with restitution are open until they are met: find_strikes(). Without `bounce`
    /// they are as those without. Rebounds that `least_hop` steps of their load would stop do not happen.
    void start_step(double h, bool bounce, double least_hop = 0.5 * tuning::limit_hop) {
        step_ = part_ = h;
        bounce_ = bounce;
        least_hop_ = least_hop;
        strikes_.clear();
    }
    void stop_bounces() { bounce_ = false; }
    /// Keeps those of the open limits that are met first until `ends`, the poses at the end of the part that was
    /// solved. The next linearize() closes them. `kicks`: the rest of the forces acts at the end. Returns whether there
    /// are any.
    bool find_strikes(const JointIsland& island, std::span<const JointSide> ends, bool kicks);
    std::span<const Strike> strikes() const { return strikes_; }
    void forget_strikes() { strikes_.clear(); }

    /// Rows for the present poses. `compliance` (1/kg) of the rigid rows.
    void linearize(const JointIsland& island, double compliance);
    /// Pairs of island bodies coupled by joints, appended to the pairs in contact.
    void add_pairs(std::vector<BlockCholesky::Pair>& pairs);

    void evaluate_speeds(const std::vector<double>& u);
    void evaluate_changes(const std::vector<double>& du);
    /// Moves the speeds by a fraction of the changes.
    void advance_speeds(double along);
    /// Impulses along the Newton step, without and with their derivatives.
    void evaluate(double along);
    void evaluate_with_weights();
    /// True if the last evaluate_with_weights() has moved a row to or from a bound.
    bool weights_changed() const { return weights_changed_; }
    double slope() const;                                            // sum of f J du
    double objective(const std::vector<double>& u) const;            // J: the rows' part of the minimized function at u
    void add_impulses(double factor, std::vector<double>& g) const;  // g += factor J^T f
    void add_estimates(std::vector<double>& g) const;                // g += J^T e
    /// Fastest speed (m/s) that the rigid rows demand of velocities u.
    double demand(const std::vector<double>& u) const;

    /// Takes the impulses as the next estimates; friction follows the load of bearings if `follow`. Returns the largest
    /// change and the largest impulse, N s.
    std::pair<double, double> next_round(bool follow);
    void keep_estimates();
    /// The impulses of the last round, whose velocities are u: soft rows follow them.
    void return_to(const std::vector<double>& u);
    /// From no impulses on, the locks keep their coordinates at the start of the part, and limits take their room.
    void aim_at_start(const JointIsland& island);
    bool any_friction() const;
    /// Makes the rows of friction `factor` times as compliant as rigid rows.
    void soften_friction(double factor);
    /// Moves the targets such that the errors at the end of the step vanish, given the poses there. Returns the largest
    /// error, in sizes of the joint.
    double close(const JointIsland& island, std::span<const JointSide> ends);

    /// Multiplies the compliance of the rigid rows.
    void stiffen(double factor);
    /// Rounding of the impulses (N s) at speeds up to `fastest` (m/s), over the compliance.
    double rounding(double fastest) const;
    /// Rounding of the coordinates, in sizes of the joint.
    double place_rounding() const;
    /// Rounding of the closed errors, in sizes of the joint: that of the coordinates, and that of the impulses on the
    /// lightest body (kg).
    double rounding(const JointIsland& island, double fastest, double lightest) const;

    /// Joints whose load is above their strength: their impulses are set to the strength. Returns whether any is new.
    bool give_way();

    /// Position correction, after the last use of the impulses: errors are moved out by pseudo-velocities, those of
    /// closed joints are kept at zero. Stiffness (kg) of rows whose error is moved out, and of all others.
    struct CorrectionStiffness {
        double apart, closed;
    };
    /// Sets targets that move `share` of each error out in the step. Returns whether there are such errors.
    bool start_correction(const JointIsland& island, double share, CorrectionStiffness stiffness);
    void add_correction(std::vector<double>& correction) const;  // correction += J^T (e + weight b)
    /// H += weight J^T J over all rows; over those without bounds, whose weight is the same in all passes; over the
    /// others.
    enum class Which { all, unbounded, bounded };
    void add_weights(BlockCholesky& matrix, Which which) const;
    /// Moves the targets of closed joints by their errors at `ends`, the poses with the correction. Returns the largest
    /// error, in sizes of the joint.
    double close_correction(const JointIsland& island, std::span<const JointSide> ends,
                            const std::vector<double>& correction);

    /// For account(): the velocities at the start of the step (`first`), or of a later substep.
    void keep_velocities(const JointIsland& island, bool first);
    /// The source of the impulses: the solve of the step, the fit at its end, or the fit where CCD has stopped the
    /// bodies, whose work is lost as in an impact.
    enum class Booking { solve, fit, stop };
    /// Adds the impulses and their work to the joints' accounts, once the bodies have their new velocities.
    void account(const JointIsland& island, Booking booking = Booking::solve);

    /// Prepares the rows for the fit at the present poses. Locks, and motors, friction and limits that held their speed
    /// in the solve, hold it again, within the rest of their bounds; the other rows get no impulse. `ahead` (s): time
    /// by which carriers are placed ahead of their present poses. `solved`: the rows have the impulses of the solve.
    /// `struck`: limits that are met give their rebound.
    void start_fit(const JointIsland& island, double ahead, bool solved, bool struck);
    /// Fastest speed (m/s) that misses a row of the fit; after evaluate_speeds().
    double misfit() const;
    double largest_impulse() const;  // N s
    double request_close(const JointIsland& island);
    /// Joints that break under the loads of the solve and the fit together.
    void break_under_loads(const JointIsland& island);

    /// Gives the impulses to the bodies and keeps them with the joints. Without `apply` all are zero.
    /// `settled`: the impulses are estimates of the next ones.
    void store(const JointIsland& island, bool apply, bool settled);
    /// Adds the impulses of the rows to the momenta of the bodies.
    void give(const JointIsland& island) const;

    /// Fastest rate (rad/s) at which a body would swing about its joints under their forces: sqrt(4 T / (m l)) for a
    /// rod of length l.
    double pendulum_rate(const JointIsland& island);

    /// J u without the prescribed velocities; adds amount J^T; adds weight J^T J.
    static double dot(const Block& block, const Row& row, const std::vector<double>& u);
    static void add(const Block& block, const Row& row, double amount, std::vector<double>& to);
    static void add_square(BlockCholesky& matrix, const Block& block, const Row& row, double weight);

private:
    void add_joint(const JointIsland& island, std::uint32_t index, double compliance);
    Row make_row(const JointIsland& island, const Block& block, const Vec3& direction, std::size_t coordinate) const;
    void add_armature(const JointIsland& island, const Row& row, double value, std::size_t coordinate);
    double rate_before(const Block& block, const Row& row) const;
    void add_laws(const JointIsland& island, const JointGeometry& g, std::size_t coordinate, const Row& row);
    struct LimitRates {
        double speed = 0.0, at_start = 0.0, by_forces = 0.0, gained = 0.0;  // m/s or rad/s
        double by_carriers = 0.0;  // m/s or rad/s: largest change by the motion of carriers
        double mobility = 0.0;     // 1/kg or 1/(kg m^2)
    };
    LimitRates limit_rates(const JointIsland& island, const Row& row, const Vec3& point) const;
    void add_limit(const JointIsland& island, const Row& row, double value, double limit, Joint::Law law);
    const Strike* strike_of(std::uint32_t joint, const Row& row) const;
    void add_ball_laws(const JointIsland& island, const JointGeometry& g, const Block& block);
    void follow_load(const Block& block);
    JointSide end_of(const JointIsland& island, std::uint32_t body, int place, std::span<const JointSide> ends) const;
    struct BallFriction {
        Vec3 wanted = Vec3::Zero();  // N s, without the bound
        double scale = 1.0;          // from that to the impulse
        bool slides = false;
    };
    static BallFriction ball_friction(const Row* row, double along);
    JointGeometry measure_end(const JointIsland& island, const Block& block, std::span<const JointSide> ends) const;
    double value_of(const JointIsland& island, const Block& block, const Row& row, const JointGeometry& g,
                    std::span<const JointSide> ends) const;
    BodyVelocity mean_velocity(const JointIsland& island, std::uint32_t body, int place, const Vec3& point) const;

    bool geared_forest(const JointIsland& island) const;
    void add_gear(const JointIsland& island, std::uint32_t index);
    GearGeometry place_gear(const JointIsland& island, Block& block, Row& row);
    JointSide side_at(const JointIsland& island, std::uint32_t body) const;
    JointReaction reaction_of(const Block& block) const;
    double gear_error(const JointIsland& island, const Block& block, std::span<const JointSide> ends) const;
    JointReaction reaction_of(const Block& block, std::size_t which) const;  // of a gear, on one of its joints
    void give_gear(const JointIsland& island, const Block& block) const;
    void account_gear(const JointIsland& island, const Block& block, bool catches, JointAccount::Span& step);
    void append_row(const Row& row);
    double smallest_size() const;  // m, of the joints
    Joint& joint(const Block& block) const { return (*joints_)[block.joint]; }
    static bool is_limit(const Row& row) {
        return row.law == Joint::lower || row.law == Joint::upper || row.law == Joint::cone;
    }

    std::vector<Joint>* joints_ = nullptr;
    std::vector<Block> blocks_;
    std::vector<Gear> gears_;  // of fixed capacity: blocks point to them
    std::vector<Row> rows_;
    std::vector<BodyVelocity> before_;    // by body of the island
    std::vector<double> pendulum_rates_;  // 1/s^2, by body of the island
    // Errors that a part of the step closes by speed, in sizes of the joint: the speed is no larger in a short part.
    double closed_share() const { return tuning::joint_rounding * std::min(1.0, h_ / step_); }

    double h_ = 0.0, length_ = 1.0, compliance_ = 0.0, total_mass_ = 0.0, from_ = 0.0, to_ = 0.0;
    double ahead_ = 0.0;  // s, of the carriers
    std::vector<Strike> strikes_;
    double step_ = 0.0, part_ = 0.0;  // s: the step; the part of the impulses that the joints keep
    double least_hop_ = 0.0;
    double fastest_ = 0.0;  // m/s, of the bodies at the start of the part
    bool bounce_ = false;
    bool weights_changed_ = true, tree_ = true;
};

}  // namespace tumble

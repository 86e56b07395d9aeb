// JointRows: impacts on limits with restitution, at their own times within a step.
#include "sim/contact/direct/joint_rows.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {

const JointRows::Strike* JointRows::strike_of(std::uint32_t joint, const Row& row) const {
    const auto found = std::find_if(strikes_.begin(), strikes_.end(), [&](const Strike& strike) {
        return strike.joint == joint && strike.coordinate == row.coordinate && strike.law == row.law;
    });
    return found == strikes_.end() ? nullptr : &*found;
}

// The way to the limit in a part of t s is t (v + a t), as the velocities at its end move the bodies.
bool JointRows::find_strikes(const JointIsland& island, std::span<const JointSide> ends, bool kicks) {
    strikes_.clear();
    double first = infinity;
    for (const Block& block : blocks_) {
        if (block.gear || block.breaks) continue;
        std::optional<JointGeometry> g;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            if (!row.bounces) continue;
            if (!g) g = measure_end(island, block, ends);
            const bool cone = row.law == Joint::cone;
            const double value = cone ? g->swing.value : value_of(island, block, row, *g, ends);
            const double limit = cone ? g->swing_limit : row.goal;
            const double left = row.law == Joint::lower ? value - limit : limit - value;
            const double v = row.approach, a = ((row.room - left) / h_ - v) / h_;
            double time = 0.0;
            if (row.room > 0.0 || v < 0.0) {
                if (!(left < 0.0)) continue;
                const double root = std::sqrt(std::max(0.0, v * v + 4.0 * a * row.room));
                time = v > 0.0 ? 2.0 * row.room / (v + root) : 0.5 * (root - v) / a;
                time = std::min(time, h_);
            }
            // Where the rest of the forces acts at the end, the speed there is that of the whole acceleration.
            const double load = (kicks ? 2.0 : 1.0) * a, approach = v + load * time;
            double rebound = std::max(0.0, joint(block).axis(row.coordinate).restitution * approach);
            if (rebound < least_hop_ * step_ * load) rebound = 0.0;
            strikes_.push_back(
                {block.joint, row.coordinate, row.law, time, row.law == Joint::lower ? rebound : -rebound});
            first = std::min(first, time);
        }
    }
    std::erase_if(strikes_, [&](const Strike& strike) { return strike.time > first + tuning::limit_together * step_; });
    return !strikes_.empty();
}

}  // namespace tumble

// Rolling and spinning friction (rotational_friction.h) in the sweeps of the soft solver: after each color of
// manifolds, one lane after the other. Units as in the kernel.
#pragma once

#include "sim/contact/model/rotational_friction.h"
#include "sim/contact/soft/soft_kernel.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

class SoftResistance {
public:
    /// `lanes`: number of all lanes; 0 where no body resists.
    void open(std::size_t lanes) { lanes_.assign(lanes, {}); }
    bool empty() const { return lanes_.empty(); }

    /// A lane with a resistance. `impulse`: the last one on B along both tangents and about the normal.
    void put(std::size_t lane, const RotationalFriction& levers, std::size_t points, const Vec3& impulse);

    /// The lanes of a group, after prepare(). `width`: lanes of a group.
    void warm_start(const soft::Groups& groups, std::size_t group, std::size_t width, const soft::Bodies& bodies) const;
    /// `counts`: adds the impulses to the sums.
    void resist(const soft::Groups& groups, std::size_t group, std::size_t width, const soft::Bodies& bodies,
                bool counts);

    /// The last impulse of a lane as in put(), and the sum over the substeps on B in the world frame.
    Vec3 impulse(std::size_t lane) const {
        return empty() ? Vec3(Vec3::Zero()) : Vec3(lanes_[lane].impulse.cast<double>());
    }
    Vec3 sum(std::size_t lane) const { return empty() ? Vec3(Vec3::Zero()) : Vec3(lanes_[lane].sum.cast<double>()); }

private:
    using Vector = Eigen::Vector3f;
    struct Lane {
        float rolling = 0.0f, spinning = 0.0f;  // m
        std::uint8_t points = 0;                // 0: no resistance
        Vector impulse = Vector::Zero(), sum = Vector::Zero();
    };

    std::vector<Lane> lanes_;
};

}  // namespace tumble

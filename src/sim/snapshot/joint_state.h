// The state of a joint at one time, for tables and pictures.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstddef>
#include <optional>

namespace tumble {

struct JointState {
    Vec3 point = Vec3::Zero();                         // m, world: the second body's anchor
    std::array<bool, 6> free{};                        // by coordinate: free or limited, otherwise locked
    std::array<double, 6> position{}, speed{};         // m and rad, m/s and rad/s, by coordinate; locked: 0
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m, world: on the second body, mean of the last step
    Vec3 mean_force = Vec3::Zero(), mean_torque = Vec3::Zero();  // N, N m: the same, mean of the last frame
    Vec3 mean_moment = Vec3::Zero();  // N m about the world origin: of both, mean of the last frame
    double gap = 0.0;                 // m: largest error of the locked coordinates
    int limit = 0;                    // -1 at a lower limit, 1 at an upper one or a cone
    bool active = true;               // holds
    std::optional<double> broken_at;  // s
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [point, free, position, speed, force, torque, mean_force, mean_torque, mean_moment, gap, limit, active,
               broken_at] = self;
        archive.keep(point, free, position, speed, force, torque, mean_force, mean_torque, mean_moment, gap, active,
                     broken_at);
        archive.between(-1, limit, 1);
    }
};

}  // namespace tumble

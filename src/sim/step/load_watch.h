// Proof that the lasting loads of breakable bodies have changed too little to be examined, without finding them. From a
// step on in which the loads were compared, the changes of contacts and of poses bound the changes of loads.
#pragma once

#include "core/vector.h"
#include "sim/geometry/manifold.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class BreakableBodies;
struct StepContext;

class LoadWatch {
public:
    /// How far the loads of a breakable body may change before they are examined again. `rest` changes by at most a
    /// hundredth of a change of `sum`.
    struct Margin {
        double rest = 0.0;   // N, change that need not be examined
        double sum = 0.0;    // N, of all loads
        double size = 1.0;   // m, arm that turns torques into forces
        double moved = 0.0;  // the largest distance of a load from where it was, over the size
    };

    /// True if the loads cannot have changed beyond their margins.
    bool quiet(std::span<const Manifold> manifolds, const StepContext& step);

    /// The contacts and poses of the step in which the loads had these margins, by entry.
    void note(std::span<const Manifold> manifolds, const StepContext& step, const BreakableBodies& breakables,
              std::span<const Margin> margins);
    /// Bodies have come apart.
    void forget() { noted_ = false; }

private:
    static constexpr std::uint32_t none = UINT32_MAX;

    struct Piece {
        std::uint32_t body, entry;
        bool asleep;
        Vec3 position;
        Mat3 rotation;
        double spin;                         // rad^2/s^2, square of the angular velocity
        double own;                          // N, load by it
        double center;                       // m, distance of the center of mass from the body's origin
        double turned = 0.0, shifted = 0.0;  // bounds of the change of rotation, and of the body's origin, m
    };
    struct Touch {
        std::uint32_t a, b;               // bodies
        std::array<std::uint32_t, 2> on;  // their pieces, or none
        std::array<double, 2> reach;      // m, of the farthest point from the origins of these
        int count;
        Vec3 normal, tangent;
        std::array<Vec3, Manifold::capacity> points;
        std::array<double, Manifold::capacity> impulses;
        double sum, friction0, friction1, torsion;
    };

    bool add(const Manifold& now, const Touch& then, double rate);

    bool noted_ = false;
    double h_ = 0.0;  // s
    std::vector<Piece> pieces_;
    std::vector<Touch> touches_;
    std::vector<Margin> margins_;
    std::vector<double> drift_;          // N, by entry: bound of the change since the note
    std::vector<std::uint32_t> places_;  // by body: in pieces_
};

}  // namespace tumble

// Islands that have come to rest leave the loop until something touches them. A body is at rest when its surface, in one of
// several spans of time, has stayed near to where it was, and its velocity does not change steadily: what slides off ever so slowly
// has more speed at each look, what turns back on a slope is slowed as evenly, at any scale; what trembles or settles does neither. An island sleeps when all its bodies are at rest and it
// leans on something that stands, fixed or kinematic. Bodies in free flight never sleep, however slow.
#pragma once

#include "sim/contact/model/settings.h"
#include "sim/geometry/manifold.h"
#include "sim/contact/model/contact_islands.h"

#include <array>
#include <memory>
#include <vector>

namespace tumble {

class SleepMonitor {
public:
    explicit SleepMonitor(std::size_t bodies) : watches_(bodies) {}

    /// Wakes whatever an awake or kinematically moving body touches, or will before the step of h seconds is over
    /// (speeds change by up to `speed_change`, m/s), and with a body the whole group it fell asleep with. To be called
    /// after the narrow phase. Returns whether anybody woke.
    bool wake_touched(const std::vector<Manifold>& manifolds, std::vector<Body>& bodies, double h, double speed_change);

    /// Wakes one body and its group.
    void wake(std::uint32_t body, std::vector<Body>& bodies);

    /// Follows the awake bodies over a step of h seconds and puts islands at rest to sleep. `speed_change` (m/s): what gravity adds in it.
    void observe(const ContactIslands& islands, const std::vector<Manifold>& manifolds, std::vector<Body>& bodies, double h,
                 double speed_change = 0.0);

    /// Counts up whenever somebody falls asleep or wakes.
    std::uint64_t changes() const { return changes_; }

private:
    struct Span {
        Vec3 position = Vec3::Constant(1e300);   // where it began
        Quat orientation = Quat::Identity();
        double still = 0.0;                      // s
    };
    using Spans = std::array<Span, tuning::sleep_times.size()>;
    struct Trend {
        using Velocity = Eigen::Matrix<double, 6, 1>;                      // m/s, of the center and of the surface against it
        Velocity velocity = Velocity::Zero(), change = Velocity::Zero();   // at the last look; since the one before
        double since = 0.0;                                                // s, the last look
        int steady = 0;                                                    // looks in a row that saw no rest
    };
    struct Watch {
        Spans spans;
        Trend trend;
        std::shared_ptr<const std::vector<std::uint32_t>> group;   // while asleep
    };
    static bool follow(Spans& spans, const Body& body, double h);
    static bool follow(Trend& trend, const Body& body, double h, double speed_change);

    std::vector<Watch> watches_;
    std::uint64_t changes_ = 0;
    std::size_t sleepers_ = 0;
};

}  // namespace tumble

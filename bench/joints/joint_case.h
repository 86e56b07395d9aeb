// A case of the joints benchmark: a scene, its steps, and the figures that a watch takes from its motion.
#pragma once

#include "harness/joints.h"
#include "harness/quantity.h"
#include "harness/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

/// Looks at the bodies at the start, every JointCase::look_every, and at the end.
class Watch {
public:
    virtual ~Watch() = default;
    virtual void see(double time, const Simulator& simulator, const std::vector<Motion>& motions) = 0;
    virtual std::vector<Quantity> tell() const = 0;
};

/// precision: few bodies, several steps, CPU time of many runs. load: rest and heavy loads, several steps. speed: the
/// time of a step alone. settling: the same where sleep is of use.
enum class JointTask { precision, load, speed, settling };

struct JointCase {
    std::string name;
    JointTask task = JointTask::precision;
    Scene scene;
    double seconds = 1.0;        // simulated
    std::vector<double> rates;   // steps per second
    double quick_seconds = 0.0;  // in the smoke test; 0: as long as in the full form
    std::vector<double> quick_rates;
    double look_every = 0.0;  // s; 0: every step
    std::size_t links = 0;    // bodies that share the time of a step; 0: not told
    std::function<std::unique_ptr<Watch>(const Scene&, double seconds)> watch;
};

std::vector<JointCase> joint_cases();

// The parts of joint_cases(), one file each.
void add_pendulums(std::vector<JointCase>& cases);   // J1, J1c, J2, J3, J4 of the note, and a free chain (J13)
void add_mechanisms(std::vector<JointCase>& cases);  // four-bars (J9), squeezer (J10), Bricard's (J11), door (J18)
void add_loads(std::vector<JointCase>& cases);       // hanging chain (J5), bridge (J6), wrecking ball (J7), tower (J22)
void add_chains(std::vector<JointCase>& cases);      // speed of chains and nets
void add_figures(std::vector<JointCase>& cases);     // speed of a humanoid and of ragdolls

}  // namespace tumble::bench

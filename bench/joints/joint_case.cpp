#include "joints/joint_case.h"

namespace tumble::bench {

std::vector<JointCase> joint_cases() {
    std::vector<JointCase> cases;
    add_pendulums(cases);
    add_mechanisms(cases);
    add_loads(cases);
    add_chains(cases);
    add_figures(cases);
    return cases;
}

}  // namespace tumble::bench

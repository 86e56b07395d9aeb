// A scene as a model in MuJoCo's format: nested bodies by the forest of joints, and equality constraints for the rest.
#pragma once

#include "harness/joints.h"

#include <string>

namespace tumble::bench {

struct MujocoSettings {
    std::string integrator = "Euler", solver = "Newton";
    bool stiff = true;     // the shortest stable time constant, two steps; otherwise the default of 20 ms
    int iterations = 100;  // at most, of the solver
};

/// True if there is a model: MuJoCo has no breaking joints, no loops of sliders, and its reader refuses deep nesting.
bool mujoco_can_represent(const Scene& scene, const JointForest& forest);

/// The XML text. Bodies are named by their indices, actuators by those of their joints.
std::string mujoco_model(const Scene& scene, const JointForest& forest, double h, const MujocoSettings& settings);

}  // namespace tumble::bench

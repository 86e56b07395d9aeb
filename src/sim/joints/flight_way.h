// How joined bodies move that touch nothing: the rules, by their joints and integrators.
#pragma once

#include "sim/joints/joint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

bool has_springs(const Joint& joint);
bool has_motors(const Joint& joint);
bool has_friction(const Joint& joint);  // of a constant bound
/// True if each spring, motor and friction of the joint acts along one coordinate of a tree: laws of balls do not.
bool acts_along_coordinates(const Joint& joint);
/// True if a side of the joint is a body with a prescribed motion.
bool on_moving_carrier(const Joint& joint, const std::vector<Body>& bodies);
/// True if the laws of these joints are laws of trees in flight: locks, limits, springs, dampers, friction, and motors
/// with one target or with a speed and a bound. One joint may hang on a body with a prescribed motion, if no other
/// joint is anchored.
bool tree_laws(std::span<const Joint* const> joints, const std::vector<Body>& bodies);

/// The integrator of bodies that are joined: the finest of theirs, and splitting before that of Runge and Kutta.
IntegratorKind joined_integrator(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined);
/// True if the integrator's steps end at the times of events.
inline bool fine_integrator(IntegratorKind kind) {
    return kind == IntegratorKind::exact || kind == IntegratorKind::runge_kutta_4;
}

}  // namespace tumble

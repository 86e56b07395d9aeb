// Constants of the projection of gaps.
#pragma once

namespace tumble::tuning {

/// The passes end when all locked coordinates are closed to this share of the smaller body. There is one in any case, else
/// bodies at rest would drift apart and jump back. Not fitted: below the error of a step.
inline constexpr double projection_closed = 2e-5;

/// Largest number of passes. Each squares the error, in sizes of the body. Not fitted: three close 0.3 sizes.
inline constexpr int projection_passes = 4;

/// Errors below this share of the smaller body are closed with the inertias of the pass before. Not fitted: the next error
/// is at most this share of the last one.
inline constexpr double projection_small = 0.01;

/// Joints that are open by more than this share of the smaller body are pulled in by tuning::joint_push_share of it in a
/// step, as anchors that were placed apart. Not fitted: bodies that turn by a radian in a step open their joints by less.
inline constexpr double projection_wide = 1.0;

}  // namespace tumble::tuning

#include "render/ambient_occlusion/texel_grid.h"

#include "core/cpu_dispatch.h"
#include "render/ambient_occlusion/analytic_occlusion.h"

namespace tumble {
namespace {

constexpr std::size_t group = 8;  // points that are computed together; the last group is filled up

inline float clamped(float value) { return std::min(std::max(value, 0.0f), 1.0f); }

// The grid in the occluder's frame: both samples of the first point, and the steps.
struct Seen {
    float near[3], far[3], across[3], along[3];  // m
    float half[3], radius;                       // m
    float per_near, per_far;                     // 1/m
};

// For points in full groups.
TUMBLE_WIDE void occlude_points(const float* i, const float* j, std::size_t groups, const Seen& s, float* open) {
    const float nx = s.near[0], ny = s.near[1], nz = s.near[2], fx = s.far[0], fy = s.far[1], fz = s.far[2];
    const float ax = s.across[0], ay = s.across[1], az = s.across[2], bx = s.along[0], by = s.along[1], bz = s.along[2];
    const float hx = s.half[0], hy = s.half[1], hz = s.half[2], radius = s.radius;
    const float per_near = s.per_near, per_far = s.per_far;
    for (std::size_t k = 0; k < group * groups; ++k) {
        const float x = i[k] * ax + j[k] * bx, y = i[k] * ay + j[k] * by, z = i[k] * az + j[k] * bz;
        const float near = box_distance(nx + x, ny + y, nz + z, hx, hy, hz) - radius;
        const float far = box_distance(fx + x, fy + y, fz + z, hx, hy, hz) - radius;
        const float closed = 0.5f * (clamped(1.0f - near * per_near) + clamped(1.0f - far * per_far));
        open[k] *= 1.0f - occlusion_strength * closed;
    }
}

// True if a box around the grid is at least this far from the occluder.
bool clear_of(const Seen& s, const float (&first)[3], int columns, int rows, float room) {
    float squared = 0.0f;
    for (int k = 0; k < 3; ++k) {
        const float across = s.across[k] * float(columns - 1), along = s.along[k] * float(rows - 1);
        const float low = first[k] + std::min(across, 0.0f) + std::min(along, 0.0f);
        const float high = first[k] + std::max(across, 0.0f) + std::max(along, 0.0f);
        const float gap = std::max({low, -high, s.half[k]}) - s.half[k];
        squared += gap * gap;
    }
    return squared > room * room;
}

void put(const Eigen::Vector3f& from, float (&to)[3]) { std::copy_n(from.data(), 3, to); }

}  // namespace

void TexelGrid::set(const GridPoints& points) {
    const bool same_size = points.columns == points_.columns && points.rows == points_.rows;
    points_ = points;
    const std::size_t room = (count() + group - 1) / group * group;
    open_.assign(room, 1.0f);
    if (same_size) return;
    i_.assign(room, 0.0f);
    j_.assign(room, 0.0f);
    for (int j = 0, k = 0; j < points.rows; ++j)
        for (int i = 0; i < points.columns; ++i, ++k) {
            i_[std::size_t(k)] = float(i);
            j_[std::size_t(k)] = float(j);
        }
}

void TexelGrid::occlude(const Occluder& occluder, float ao_radius) {
    const float far_step = std::min(ao_radius, occluder.ao_radius), near_step = near_sample * far_step;
    constexpr float spare = 1.0001f;  // for rounding: a skipped occluder would have multiplied by 1
    const Eigen::Vector3f first = occluder.to_local * (points_.corner - occluder.center),
                          outward = occluder.to_local * points_.normal;
    // A body behind the face is farther from the samples than the face is.
    const float top = outward.cwiseAbs().dot(occluder.half_size) + occluder.radius - outward.dot(first);
    if (top < (1.0f - spare) * near_step) return;
    Seen seen{};
    put(first + outward * near_step, seen.near);
    put(first + outward * far_step, seen.far);
    put(occluder.to_local * points_.across, seen.across);
    put(occluder.to_local * points_.along, seen.along);
    put(occluder.half_size, seen.half);
    seen.radius = occluder.radius;
    seen.per_near = 1.0f / near_step;
    seen.per_far = 1.0f / far_step;
    if (clear_of(seen, seen.near, points_.columns, points_.rows, spare * (near_step + seen.radius)) &&
        clear_of(seen, seen.far, points_.columns, points_.rows, spare * (far_step + seen.radius)))
        return;
    occlude_points(i_.data(), j_.data(), open_.size() / group, seen, open_.data());
}

void TexelGrid::occlude(const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius) {
    const float near_step = near_sample * ao_radius, rise = plane_normal.dot(points_.normal);
    const float height = plane_normal.dot(points_.corner) + plane_height;
    const float across = plane_normal.dot(points_.across), along = plane_normal.dot(points_.along);
    const float near = 1.0f - (height + rise * near_step) / near_step,
                far = 1.0f - (height + rise * ao_radius) / ao_radius;
    for (std::size_t k = 0; k < open_.size(); ++k) {
        const float higher = i_[k] * across + j_[k] * along;
        open_[k] *=
            1.0f - occlusion_strength * 0.5f * (clamped(near - higher / near_step) + clamped(far - higher / ao_radius));
    }
}

}  // namespace tumble

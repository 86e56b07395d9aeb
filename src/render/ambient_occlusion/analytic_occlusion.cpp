#include "render/ambient_occlusion/analytic_occlusion.h"

#include "core/cpu_dispatch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

inline float clamped(float value) { return std::min(std::max(value, 0.0f), 1.0f); }

}  // namespace

void SurfacePoints::clear() {
    for (std::vector<float>* values : {&x, &y, &z, &nx, &ny, &nz, &open}) values->clear();
}

void SurfacePoints::add(const Eigen::Vector3f& position, const Eigen::Vector3f& normal) {
    x.push_back(position.x());
    y.push_back(position.y());
    z.push_back(position.z());
    nx.push_back(normal.x());
    ny.push_back(normal.y());
    nz.push_back(normal.z());
    open.push_back(1.0f);
}

void SurfacePoints::add(const SurfacePoints& others, std::size_t first, std::size_t count) {
    const auto append = [&](std::vector<float>& to, const std::vector<float>& from) {
        to.insert(to.end(), from.begin() + std::ptrdiff_t(first), from.begin() + std::ptrdiff_t(first + count));
    };
    append(x, others.x);
    append(y, others.y);
    append(z, others.z);
    append(nx, others.nx);
    append(ny, others.ny);
    append(nz, others.nz);
    open.insert(open.end(), count, 1.0f);
}

TUMBLE_WIDE void occlude(SurfacePoints& points, const Occluder& occluder, float ao_radius) {
    const Eigen::Matrix3f& m = occluder.to_local;
    const Eigen::Vector3f c = occluder.center, half = occluder.half_size;
    const float m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2), m10 = m(1, 0), m11 = m(1, 1), m12 = m(1, 2);
    const float m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2);
    const float hx = half.x(), hy = half.y(), hz = half.z(), radius = occluder.radius;
    const float far_step = std::min(ao_radius, occluder.ao_radius), near_step = near_sample * far_step;
    const float per_near = 1.0f / near_step, per_far = 1.0f / far_step;
    const float *px = points.x.data(), *py = points.y.data(), *pz = points.z.data();
    const float *nx = points.nx.data(), *ny = points.ny.data(), *nz = points.nz.data();
    float* open = points.open.data();
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        const float dx = px[i] - c.x(), dy = py[i] - c.y(), dz = pz[i] - c.z();
        const float lx = m00 * dx + m01 * dy + m02 * dz, ly = m10 * dx + m11 * dy + m12 * dz;
        const float lz = m20 * dx + m21 * dy + m22 * dz;
        const float ax = m00 * nx[i] + m01 * ny[i] + m02 * nz[i], ay = m10 * nx[i] + m11 * ny[i] + m12 * nz[i];
        const float az = m20 * nx[i] + m21 * ny[i] + m22 * nz[i];
        const float near =
            box_distance(lx + ax * near_step, ly + ay * near_step, lz + az * near_step, hx, hy, hz) - radius;
        const float far = box_distance(lx + ax * far_step, ly + ay * far_step, lz + az * far_step, hx, hy, hz) - radius;
        const float closed = 0.5f * (clamped(1.0f - near * per_near) + clamped(1.0f - far * per_far));
        open[i] *= 1.0f - occlusion_strength * closed;
    }
}

float visibility_past(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Occluder& occluder,
                      float ao_radius) {
    const float far_step = std::min(ao_radius, occluder.ao_radius), near_step = near_sample * far_step;
    const Eigen::Vector3f away = position - occluder.center;
    const float room = occluder.bound_radius + 2.0f * far_step;  // beyond it, both samples are unoccluded
    if (away.squaredNorm() > room * room) return 1.0f;
    const Eigen::Vector3f p = occluder.to_local * away, n = occluder.to_local * normal, half = occluder.half_size;
    const auto closed = [&](float step) {
        const float distance = box_distance(p.x() + n.x() * step, p.y() + n.y() * step, p.z() + n.z() * step, half.x(),
                                            half.y(), half.z()) -
                               occluder.radius;
        return clamped(1.0f - distance / step);
    };
    return 1.0f - occlusion_strength * 0.5f * (closed(near_step) + closed(far_step));
}

void occlude(SurfacePoints& points, const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius) {
    const float near_step = near_sample * ao_radius;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float height = plane_normal.x() * points.x[i] + plane_normal.y() * points.y[i] +
                             plane_normal.z() * points.z[i] + plane_height;
        const float rise =
            plane_normal.x() * points.nx[i] + plane_normal.y() * points.ny[i] + plane_normal.z() * points.nz[i];
        const float near = 1.0f - (height + rise * near_step) / near_step,
                    far = 1.0f - (height + rise * ao_radius) / ao_radius;
        points.open[i] *= 1.0f - occlusion_strength * 0.5f * (clamped(near) + clamped(far));
    }
}

float visibility_past(const Eigen::Vector3f& position, const Eigen::Vector3f& normal,
                      const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius) {
    const float height = plane_normal.dot(position) + plane_height, rise = plane_normal.dot(normal);
    const float near_step = near_sample * ao_radius;
    const float near = 1.0f - (height + rise * near_step) / near_step,
                far = 1.0f - (height + rise * ao_radius) / ao_radius;
    return 1.0f - occlusion_strength * 0.5f * (clamped(near) + clamped(far));
}

}  // namespace tumble

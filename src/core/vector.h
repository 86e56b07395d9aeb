// Vectors, matrices and quaternions outside drawing: Eigen's, in double precision. World frame unless a name says
// otherwise; SI units; y is up by convention of the scene files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <limits>

namespace tumble {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  // w first in its constructor and in the files

/// An axis-aligned bounding box (AABB). Empty (min > max) until a point is added.
struct Bounds {
    Vec3 min = Vec3::Constant(infinity);
    Vec3 max = Vec3::Constant(-infinity);

    bool empty() const { return (min.array() > max.array()).any(); }
    Vec3 center() const { return 0.5 * (min + max); }
    Vec3 extent() const { return max - min; }
    void add(const Vec3& p) {
        min = min.cwiseMin(p);
        max = max.cwiseMax(p);
    }
    void add(const Bounds& b) {
        min = min.cwiseMin(b.min);
        max = max.cwiseMax(b.max);
    }
    bool overlaps(const Bounds& b) const {
        return (min.array() <= b.max.array()).all() && (b.min.array() <= max.array()).all();
    }
    Bounds grown(double margin) const {
        Bounds b = *this;
        b.min.array() -= margin;
        b.max.array() += margin;
        return b;
    }
};

// Rotations given by directions.

/// The smallest rotation from the direction `from` to the direction `to` (of nonzero vectors). For opposite ones: half
/// a turn about a perpendicular axis. In its own unit, because Eigen's function compiles a singular value
/// decomposition.
Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace tumble

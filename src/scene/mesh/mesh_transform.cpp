#include "scene/mesh/mesh_transform.h"

namespace tumble {
namespace {

/// Normals are transformed by the cofactors of the matrix: no inverse, and correct for mirrored parts with adapted
/// winding.
Mat3 normal_transform(const Mat3& m) {
    Mat3 cofactors;
    cofactors.col(0) = m.col(1).cross(m.col(2));
    cofactors.col(1) = m.col(2).cross(m.col(0));
    cofactors.col(2) = m.col(0).cross(m.col(1));
    return cofactors;
}

}  // namespace

MeshTransform::MeshTransform(const Mat3& linear, const Vec3& offset)
    : linear_(linear), offset_(offset), mirrored_(linear.determinant() < 0.0) {
    normals_ = (mirrored_ ? -1.0 : 1.0) * normal_transform(linear);
}

MeshTransform MeshTransform::then(const Eigen::Matrix4f& inner) const {
    const auto at = [&](int row, int column) { return as_written(inner(row, column)); };
    Mat3 linear;
    linear << at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2), at(2, 0), at(2, 1), at(2, 2);
    return {linear_ * linear, linear_ * Vec3(at(0, 3), at(1, 3), at(2, 3)) + offset_};
}

Vec3 MeshTransform::point(const std::array<float, 3>& p) const {
    return linear_ * Vec3(as_written(p[0]), as_written(p[1]), as_written(p[2])) + offset_;
}

Vec3 MeshTransform::normal(const std::array<float, 3>& n) const {
    return unit_or_zero(normals_ * Vec3(n[0], n[1], n[2]));
}

}  // namespace tumble

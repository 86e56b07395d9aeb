// Where a part of a mesh file lies in the mesh.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <array>

namespace tumble {

/// Nothing is moved by default; a zero of a file may lose its sign even so.
class MeshTransform {
public:
    MeshTransform() : MeshTransform(Mat3::Identity(), Vec3::Zero()) {}
    MeshTransform(const Mat3& linear, const Vec3& offset);

    /// This transform after an inner one, whose matrix is [linear, offset].
    MeshTransform then(const Eigen::Matrix4f& inner) const;
    Vec3 point(const std::array<float, 3>& p) const;
    /// Unit, or zero.
    Vec3 normal(const std::array<float, 3>& n) const;
    /// Polygons must be turned.
    bool mirrored() const { return mirrored_; }

private:
    Mat3 linear_, normals_;
    Vec3 offset_;
    bool mirrored_;
};

}  // namespace tumble

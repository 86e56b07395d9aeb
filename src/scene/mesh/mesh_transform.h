// Placement of a part of a mesh file in the mesh.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <array>

namespace tumble {

/// The default is the identity, although a zero of a file may lose its sign.
class MeshTransform {
public:
    MeshTransform() : MeshTransform(Mat3::Identity(), Vec3::Zero()) {}
    MeshTransform(const Mat3& linear, const Vec3& offset);

    /// This transform after an inner one, whose matrix is [linear, offset].
    MeshTransform then(const Eigen::Matrix4f& inner) const;
    Vec3 point(const std::array<float, 3>& p) const;
    /// Unit, or zero.
    Vec3 normal(const std::array<float, 3>& n) const;
    /// True if the winding of polygons must be reversed.
    bool mirrored() const { return mirrored_; }

private:
    Mat3 linear_, normals_;
    Vec3 offset_;
    bool mirrored_;
};

}  // namespace tumble

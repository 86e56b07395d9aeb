// A manifold tied to its two bodies: while their relative motion is small, points, separations and normal follow from
// the poses and need no new search.
//
// The normal moves with the body whose face it belongs to, and each point's two ends with their own bodies: the foot
// with the face, the corner above it with the other body. The separation, the corner's height over the face, is then
// exact for faces, and right to second order in the motion for edges: only the positions of the points on the surfaces
// go out of date.
#pragma once

#include "sim/geometry/manifold.h"
#include "sim/geometry/shapes/shape.h"

#include <array>
#include <span>

namespace tumble {

struct PersistentManifold {
    // One end of each point, in the frame of its body: one array per coordinate, for all points side by side.
    struct Ends {
        double coordinate[3][Manifold::capacity] = {};
        Vec3 operator[](std::size_t i) const { return {coordinate[0][i], coordinate[1][i], coordinate[2][i]}; }
        void set(std::size_t i, const Vec3& p) {
            for (int k = 0; k < 3; ++k) coordinate[k][i] = p[k];
        }
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [coordinate] = self;
            archive.keep(coordinate);
        }
    };
    Ends feet, corners;          // feet: in the frame of the body that the normal belongs to
    Vec3 normal = Vec3::Zero();  // unit, in the frame of that body
    bool normal_of_b = false;
    const Ends& on_a() const { return normal_of_b ? corners : feet; }
    const Ends& on_b() const { return normal_of_b ? feet : corners; }

    // Reduced points of the same two faces, stored with the first manifold: the end on the body that the normal does
    // not belong to, and the height of the face there along the normal (m, in the frame of the face's body). Single
    // precision: they only detect whether a point has sunk by more than a fraction of its size.
    struct ReducedPoint {
        float point[3];
        float face;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [point, face] = self;
            archive.keep(point, face);
        }
    };
    static constexpr std::size_t reduced_capacity = 4;  // with the manifold's four, all of two quadrilaterals
    int reduced_count = 0;
    std::array<ReducedPoint, reduced_capacity> reduced;
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [feet, corners, normal, normal_of_b, reduced_count, reduced] = self;
        archive.keep(feet, corners, normal, normal_of_b);
        archive.between(0, reduced_count, reduced_capacity);
        archive.keep_first(std::size_t(reduced_count), reduced);
    }
};

/// `normal_of_b`: the normal is that of a face of B.
PersistentManifold make_persistent_manifold(const Manifold& m, const Pose& pose_a, const Pose& pose_b,
                                            bool normal_of_b);

/// Adds reduced points: of many, those farthest from the kept ones and from each other.
/// `kept`: the manifold, and its second one where there is one.
void keep_reduced_points(std::span<const ContactPoint> reduced, std::span<const Manifold> kept, const Pose& pose_a,
                         const Pose& pose_b, PersistentManifold& persistent);

/// Separation (m) of the deepest reduced point, for a refreshed `m`; infinity without any.
double deepest_reduced_point(const PersistentManifold& persistent, const Pose& pose_a, const Pose& pose_b,
                             const Manifold& m);

/// Refreshes normal, positions and separations of `m` for new poses.
void refresh(const PersistentManifold& persistent, const Pose& pose_a, const Pose& pose_b, Manifold& m);

// Impulse matching: transfers the impulses of the last step to new manifolds, as warm start for the solver.

/// Transfers the impulses of `old` to `m`, the manifold of the same two bodies found later:
/// - each point gets the impulse of the old point with the same feature;
/// - without such a point, that of the nearest old point not yet taken, if nearer than `reach` (m);
/// - remaining impulses go to the nearest points while the normals agree: a load must not be lost where points change.
/// Friction, its tangent and the torsional friction are transferred too.
void match_impulses(const Manifold& old, double reach, Manifold& m);

/// Adds the normal impulses of a removed second manifold to the nearest points of the remaining one.
void transfer_impulses(const Manifold& old, Manifold& m);

}  // namespace tumble

// Visibility of places past fixed bodies, for the default camera: bodies that fall into a bowl or a bin
// should be visible.
#pragma once

#include "scene/description/description.h"

namespace tumble {

class CameraVisibility {
public:
    /// The places are the rest positions of moving bodies.
    explicit CameraVisibility(const SceneDescription& scene);
    /// `places`: m.
    CameraVisibility(const SceneDescription& scene, std::vector<Vec3> places);

    /// Share of the places that are visible from the eye; 1 if the test is skipped.
    double visible_share(const Vec3& eye) const;

private:
    struct Piece {
        Vec3 center;  // m; of the bounding box
        Vec3 half_size;
        Vec3 origin;  // of the body frame
        Quat rotation;
        const Shape* shape;  // a box, ball or mesh
    };
    /// False if there are none, or too many for the test.
    bool find_pieces(const SceneDescription& scene);
    void add(const Shape& shape, const Vec3& position, const Quat& rotation);
    /// Distance to the first fixed body along `direction`, as a multiple of it; infinity without one.
    double first_hit(const Vec3& from, const Vec3& direction) const;
    void find_rest_positions(const SceneDescription& scene);

    std::vector<Piece> pieces_;
    std::vector<Vec3> places_;
};

}  // namespace tumble

// What fixed bodies hide of where the others come to lie, for choosing a camera: what falls into a bowl or a bin is to be seen.
#pragma once

#include "scene/description/description.h"

namespace tumble {

class CameraVisibility {
public:
    explicit CameraVisibility(const SceneDescription& scene);

    /// How many of the places can be seen from the eye; all where nothing is to be asked.
    double visible_share(const Vec3& eye) const;

private:
    struct Piece {
        Vec3 center;            // m; of the box around it
        Vec3 half_size;
        Vec3 origin;            // of its own frame
        Quat rotation;
        const Shape* shape;     // a box, ball or mesh
    };
    void add(const Shape& shape, const Vec3& position, const Quat& rotation);
    /// How far along the way, in its lengths, until it meets a fixed body; infinity where it meets none.
    double first_hit(const Vec3& from, const Vec3& way) const;
    void find_places(const SceneDescription& scene);

    std::vector<Piece> pieces_;
    std::vector<Vec3> places_;   // of some moving bodies, straight below their starts
};

}  // namespace tumble

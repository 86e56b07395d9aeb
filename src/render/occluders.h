// The bodies as boxes and balls that take sky light from each other, and the search for the few near a place.
#pragma once

#include "render/body_looks.h"
#include "render/camera_view.h"
#include "sim/snapshot.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// A ball is a box of no size with a radius. Float: what is darkened is a picture.
struct Occluder {
    Eigen::Vector3f center;     // relative to `reference`, m
    Eigen::Matrix3f to_local;   // world axes -> the occluder's
    Eigen::Vector3f half_size;  // m
    float radius;               // m
    float reach;                // m
    float bound_radius;         // of the ball around it, m
    std::size_t body;
};

/// The boxes and balls of all bodies that may darken something in the picture, in scene order. `reference`: a point by the
/// scene that all positions are relative to, m. It stays where it is when the camera moves, so that what the bodies take
/// from each other is then the same to the bit.
std::vector<Occluder> make_occluders(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view,
                                     const Vec3& reference);

/// Finds what is near: cells of a regular lattice, kept sorted. What spans too many cells is a candidate everywhere.
class OccluderFinder {
public:
    explicit OccluderFinder(const std::vector<Occluder>& occluders);

    /// The occluders whose bounding ball, grown by twice their reach, meets the ball given; in order, each once.
    void find(const Eigen::Vector3f& center, float radius, std::vector<std::size_t>& found) const;

private:
    struct Cell {
        int x, y, z;
        auto operator<=>(const Cell&) const = default;
    };
    struct Entry {
        Cell cell;
        std::size_t occluder;
        auto operator<=>(const Entry&) const = default;
    };
    template <class Visit>
    bool for_each_cell(const Eigen::Vector3f& center, float radius, Visit visit) const;
    bool meets(std::size_t occluder, const Eigen::Vector3f& center, float radius) const;

    const std::vector<Occluder>* occluders_;
    float cell_size_ = 1.0f;  // m
    std::vector<Entry> entries_;
    std::vector<std::size_t> everywhere_;
};

}  // namespace tumble

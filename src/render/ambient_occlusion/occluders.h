// The bodies as boxes and balls that take sky light from each other, and the search for the few near a place.
#pragma once

#include "render/scene/render_scene.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
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

/// The boxes and balls of one body, appended. `reference`: a point by the scene that all positions are relative to, m. It
/// stays where it is when the camera moves, so that what the bodies take from each other is then the same to the bit.
void add_occluders(const RenderScene& looks, std::size_t body, const BodyState& state, const Vec3& reference,
                   std::vector<Occluder>& occluders);

/// Finds what is near a place: a lattice of cells for each power of two of the occluders' sizes, each occluder in the one
/// cell that holds its center. Building takes time in proportion to their number, a search to what is near.
class OccluderFinder {
public:
    explicit OccluderFinder(const std::vector<Occluder>& occluders);

    /// The occluders whose bounding ball, grown by twice their reach, meets the ball given; in order, each once.
    void find(const Eigen::Vector3f& center, float radius, std::vector<std::size_t>& found) const;

    /// Is there any?
    bool any(const Eigen::Vector3f& center, float radius) const;

private:
    struct Entry {
        float x, y, z, influence;   // m
        std::uint32_t occluder;
    };
    struct Level {
        float cell = 1.0f, largest = 0.0f;   // m: of a cell, and the largest influence
        Eigen::Array3f low, high;            // m: of the centers
        std::uint32_t mask = 0;              // of the table's buckets, a power of two of them
        std::vector<std::uint32_t> starts;   // of each bucket, and the end
        std::vector<Entry> entries;          // bucket by bucket
    };
    template <class Visit>
    void visit_near(const Eigen::Vector3f& center, float radius, Visit visit) const;   // until it says false

    std::vector<Level> levels_;
};

}  // namespace tumble

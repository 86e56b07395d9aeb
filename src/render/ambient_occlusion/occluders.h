// Boxes and balls that stand for the bodies as occluders, and the search for those near a place.
#pragma once

#include "render/scene/render_scene.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// A ball is a box of size zero with a radius. Single precision is enough for a frame.
struct Occluder {
    Eigen::Vector3f center;     // relative to `reference`, m
    Eigen::Matrix3f to_local;   // world axes -> the occluder's
    Eigen::Vector3f half_size;  // m
    float radius;               // m
    float ao_radius;            // AO radius, m
    float bound_radius;         // of the bounding ball, m
    std::size_t body;
};

/// Appends the boxes and balls of one body. `reference`: a fixed point near the scene that all positions are relative
/// to, m. It does not move with the camera, so that the occlusion stays the same to the bit.
void add_occluders(const RenderScene& scene, std::size_t body, const BodyState& state, const Vec3& reference,
                   std::vector<Occluder>& occluders);

/// Finds the occluders near a place. Each power of two of the occluders' sizes has a grid; an occluder is in the one
/// cell that contains its center. Building is linear in their number; a search is linear in the number of those nearby.
class OccluderFinder {
public:
    explicit OccluderFinder(const std::vector<Occluder>& occluders);

    /// Indices of the occluders whose bounding ball, grown by twice their AO radius, meets the given ball; sorted,
    /// without repetition.
    void find(const Eigen::Vector3f& center, float radius, std::vector<std::size_t>& found) const;

    /// True if find() would find any.
    bool any(const Eigen::Vector3f& center, float radius) const;

private:
    struct Entry {
        float x, y, z, influence;  // m
        std::uint32_t occluder;
    };
    struct Level {
        float cell = 1.0f, largest = 0.0f;  // m; cell size, and largest influence
        Eigen::Array3f low, high;           // m; bounds of the centers
        std::uint32_t mask = 0;             // number of buckets of the table, a power of two, less 1
        std::vector<std::uint32_t> starts;  // first entry of each bucket, and the end
        std::vector<Entry> entries;         // bucket by bucket
    };
    template <class Visit>
    void visit_near(const Eigen::Vector3f& center, float radius, Visit visit) const;  // until it returns false

    std::vector<Level> levels_;
};

}  // namespace tumble

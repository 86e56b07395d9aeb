#include "sim/geometry/collide.h"

#include <algorithm>
#include <type_traits>

namespace tumble {
namespace {

/// A contact of a part of a compound lies on an internal seam where all points at `seam_probe` (share of the part's
/// size) along its normal lie in other parts, or outside them by at most `seam_tolerance` (same share): far above
/// rounding, below any real edge. Not fitted. Related tests: PairMemory.InternalEdgesAreFlat and
/// Compound.InternalEdgesBetweenPartsAreSmooth.
constexpr double seam_probe = 1e-3;
constexpr double seam_tolerance = 1e-5;

using CompoundRef = std::shared_ptr<const Compound>;

// Finds the parts whose bounds come within the margin of the other shape, in ascending order.
void find_near_parts(const Compound& whole, const Pose& pose, const CollisionShape& other, const Pose& pose_other,
                     double margin, std::vector<std::uint32_t>& parts) {
    const Pose relative = seen_from(pose, pose_other);
    const Bounds bounds = world_bounds(other, relative).grown(margin);
    parts.clear();
    whole.tree.query(bounds, [&](std::uint32_t part) { parts.push_back(part); });
    std::sort(parts.begin(), parts.end());
}

// True if part k would push towards the body's own interior: a contact at an internal edge between parts, which must
// not catch a sliding body.
bool at_seam(const Compound& whole, const Pose& pose, std::uint32_t k, const Manifold& m, const Vec3& outward) {
    const double size = whole.parts[k].reach;
    return m.count > 0 && std::all_of(m.points.begin(), m.points.begin() + m.count, [&](const ContactPoint& point) {
               // Measured from the body's own surface: in a deep overlap, the point halfway between the surfaces is
               // inside it anyway.
               const Vec3 probe = pose.to_body(point.position + (seam_probe * size - 0.5 * point.separation) * outward);
               bool inside = false;
               whole.tree.query(Bounds{probe, probe}.grown(seam_tolerance * size), [&](std::uint32_t other) {
                   const Compound::Part& part = whole.parts[other];
                   inside = inside ||
                            (other != k && contains(part.collider, part.place.to_body(probe), seam_tolerance * size));
               });
               return inside;
           });
}

// Collides each part of a compound with the whole other shape, in the given order.
void collide_parts(const Compound& whole, const CollisionShape& other, bool whole_is_a, const CollisionQuery& query) {
    const Pose &pose = whole_is_a ? query.pose_a : query.pose_b, &pose_other = whole_is_a ? query.pose_b : query.pose_a;
    CollisionScratch& scratch = query.scratch;
    std::vector<Manifold>& out = query.out;
    // Parts and triangles of two shapes are below 2^32 together, by limits::parts and limits::mesh_triangles.
    const std::uint32_t stride = part_count(other);
    std::vector<std::uint32_t>& near = scratch.near_parts[std::holds_alternative<CompoundRef>(other) ? 1 : 0];
    find_near_parts(whole, pose, other, pose_other, query.margin, near);
    for (const std::uint32_t k : near) {
        const std::size_t first = out.size();
        const Compound::Part& part = whole.parts[k];
        const Pose pose_part = part_pose(pose, part);
        scratch.part += k * stride;
        if (whole_is_a)
            collide(part.collider, other, {pose_part, pose_other, query.margin, scratch, out});
        else
            collide(other, part.collider, {pose_other, pose_part, query.margin, scratch, out});
        const auto seam = [&](const Manifold& m) {
            return at_seam(whole, pose, k, m, whole_is_a ? m.normal : Vec3(-m.normal));
        };
        out.erase(std::remove_if(out.begin() + std::ptrdiff_t(first), out.end(), seam), out.end());
        for (std::size_t i = first; i < out.size(); ++i) out[i].part += k * stride;
        scratch.part -= k * stride;
    }
    scratch.gap = 0.0;  // the gap of one part does not bound that of the others
}

}  // namespace

bool CollisionScratch::was_on_b() const {
    const auto found = std::find_if(before.begin(), before.end(), [&](const Manifold& m) { return m.part == part; });
    return found != before.end() && found->on_b();
}

void collide(const CollisionShape& a, const CollisionShape& b, const CollisionQuery& query) {
    if (const auto* whole = std::get_if<CompoundRef>(&a)) return collide_parts(**whole, b, true, query);
    if (const auto* whole = std::get_if<CompoundRef>(&b)) return collide_parts(**whole, a, false, query);
    std::visit(
        [&](const auto& held_a, const auto& held_b) {
            const auto& shape_a = collider_in(held_a);
            const auto& shape_b = collider_in(held_b);
            using A = std::decay_t<decltype(shape_a)>;
            using B = std::decay_t<decltype(shape_b)>;
            const std::size_t first = query.out.size();
            if constexpr ((!A::can_move && !B::can_move) || std::is_same_v<A, Compound> ||
                          std::is_same_v<B, Compound>) {
                return;  // a compound has been split
            } else if constexpr (requires { collide_pair(shape_a, shape_b, query); }) {
                collide_pair(shape_a, shape_b, query);
            } else {  // the same pair in the other order: swap, collide, turn the normals
                collide_pair(shape_b, shape_a, query.swapped());
                for (std::size_t i = first; i < query.out.size(); ++i) query.out[i].swap();
            }
            if constexpr (A::contact_surface == ContactSurface::curved || B::contact_surface == ContactSurface::curved)
                query.scratch.on_ball = query.scratch.on_ball || query.out.size() > first;
        },
        a, b);
}

}  // namespace tumble

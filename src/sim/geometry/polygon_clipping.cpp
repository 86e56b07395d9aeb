#include "sim/geometry/polygon_clipping.h"

namespace tumble {

void label_polygon(const std::vector<Vec3>& corners, const std::vector<std::uint32_t>& vertex_labels,
                   std::vector<ClipVertex>& polygon) {
    polygon.clear();
    for (std::size_t i = 0; i < corners.size(); ++i)
        polygon.push_back({corners[i], vertex_labels[i], std::uint32_t(i)});
}

void clip_to_prism(const std::vector<Vec3>& reference, const Vec3& normal, std::vector<ClipVertex>& polygon,
                   std::vector<ClipVertex>& spare) {
    for (std::size_t side = 0; side < reference.size() && !polygon.empty(); ++side) {
        const Vec3& from = reference[side];
        const Vec3 out = (reference[(side + 1) % reference.size()] - from).cross(normal);
        spare.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const ClipVertex &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            const double dp = out.dot(p.position - from), dq = out.dot(q.position - from);
            if (dp <= 0.0) spare.push_back(p);
            if ((dp <= 0.0) == (dq <= 0.0)) continue;
            ClipVertex cut;
            cut.position = p.position + dp / (dp - dq) * (q.position - p.position);
            cut.feature = (std::uint64_t(1) << 40) | (std::uint64_t(p.edge) << 20) | side_label(std::uint32_t(side));
            // Leaving: the following edge runs along the side. Entering: it continues the cut edge.
            cut.edge = dp <= 0.0 ? side_label(std::uint32_t(side)) : p.edge;
            spare.push_back(cut);
        }
        polygon.swap(spare);
    }
}

}  // namespace tumble

#include "render/occluders.h"

#include "render/draw_list.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// A body or a search that would span more cells than this is compared with all instead.
constexpr float most_cells = 256.0f;

float influence(const Occluder& o) { return o.bound_radius + 2.0f * o.reach; }

}  // namespace

std::vector<Occluder> make_occluders(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view,
                                     const Vec3& reference) {
    std::vector<Occluder> all;
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const BodyLook& look = looks.bodies[i];
        if (look.kind == DrawKind::hidden || look.kind == DrawKind::plane) continue;
        const BodyState& state = snapshot.bodies[i];
        const BoundingBall ball = bounding_ball(look, state, view);
        if (!view.sees(ball.center, ball.radius + 2.0 * look.reach)) continue;
        const Eigen::Matrix3f to_local = state.orientation.toRotationMatrix().transpose().cast<float>();
        const auto add = [&](const Vec3& center, const Vec3& half_size, double radius) {
            all.push_back({Vec3(state.origin + state.orientation * center - reference).cast<float>(), to_local,
                           half_size.cast<float>(), float(radius), float(look.reach), float(half_size.norm() + radius),
                           i});
        };
        if (look.kind == DrawKind::box) add(Vec3::Zero(), look.half_size, 0.0);
        if (look.kind == DrawKind::ball) add(Vec3::Zero(), Vec3::Zero(), look.half_size.x());
        if (look.kind == DrawKind::mesh)
            for (const OccluderBox& box : looks.meshes[look.mesh].occluders) add(box.center, box.half_size, 0.0);
    }
    return all;
}

OccluderFinder::OccluderFinder(const std::vector<Occluder>& occluders) : occluders_(&occluders) {
    if (occluders.empty()) return;
    std::vector<float> sizes;
    for (const Occluder& o : occluders) sizes.push_back(influence(o));
    const auto middle = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    cell_size_ = 2.0f * *middle;
    for (std::size_t i = 0; i < occluders.size(); ++i) {
        const auto enter = [&](const Cell& cell) { entries_.push_back({cell, i}); };
        if (!for_each_cell(occluders[i].center, influence(occluders[i]), enter)) everywhere_.push_back(i);
    }
    std::sort(entries_.begin(), entries_.end());
}

// Visits the cells that a ball meets; false, visiting none, when they are too many.
template <class Visit>
bool OccluderFinder::for_each_cell(const Eigen::Vector3f& center, float radius, Visit visit) const {
    const Eigen::Array3f low = ((center.array() - radius) / cell_size_).floor();
    const Eigen::Array3f high = ((center.array() + radius) / cell_size_).floor();
    if (!((high - low + 1.0f).prod() <= most_cells) || !(low.abs().maxCoeff() < 1e9f)) return false;
    for (int x = int(low.x()); x <= int(high.x()); ++x)
        for (int y = int(low.y()); y <= int(high.y()); ++y)
            for (int z = int(low.z()); z <= int(high.z()); ++z) visit(Cell{x, y, z});
    return true;
}

bool OccluderFinder::meets(std::size_t occluder, const Eigen::Vector3f& center, float radius) const {
    const Occluder& o = (*occluders_)[occluder];
    const float near = influence(o) + radius;
    return (o.center - center).squaredNorm() < near * near;
}

void OccluderFinder::find(const Eigen::Vector3f& center, float radius, std::vector<std::size_t>& found) const {
    found.clear();
    const auto collect = [&](const Cell& cell) {
        for (auto at = std::lower_bound(entries_.begin(), entries_.end(), Entry{cell, 0});
             at != entries_.end() && at->cell == cell; ++at)
            if (meets(at->occluder, center, radius)) found.push_back(at->occluder);
    };
    if (for_each_cell(center, radius, collect)) {
        for (const std::size_t i : everywhere_)
            if (meets(i, center, radius)) found.push_back(i);
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
    } else {
        for (std::size_t i = 0; i < occluders_->size(); ++i)
            if (meets(i, center, radius)) found.push_back(i);
    }
}

}  // namespace tumble

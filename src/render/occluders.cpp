#include "render/occluders.h"

#include "render/glm_conversion.h"
#include "render/plane_patch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// A cell's edge over the median occluder's reach: smaller cells have shorter lists, but there are more of them.
constexpr double cell_of_reach = 1.0;

// An occluder that would lie in more cells than this is tested everywhere instead.
constexpr double most_cells = 4096.0;

std::vector<Occluder> gather(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view) {
    std::vector<Occluder> all;
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const BodyLook& look = looks.bodies[i];
        const BodyState& state = snapshot.bodies[i];
        const BoundingBall ball = bounding_ball(look, state, view);
        if (!view.sees(ball.center, ball.radius + look.reach)) continue;
        const auto add = [&](const Vec3& center, const Vec3& half_size) {
            all.push_back({to_glm(view.relative(state.origin + state.orientation * center), double(i)),
                           to_glm(state.orientation), to_glm(half_size, look.reach)});
        };
        if (look.kind == DrawKind::box) add(Vec3::Zero(), look.half_size);
        if (look.kind == DrawKind::ball) add(Vec3::Zero(), Vec3(-look.half_size.x(), 0.0, 0.0));
        if (look.kind == DrawKind::mesh)
            for (const OccluderBox& box : looks.mesh_occluders[look.mesh]) add(box.center, box.half_size);
    }
    return all;
}

// Calls visit(x, y, z) for each cell within reach of an occluder. Returns false, visiting none, when they are too many.
template <class Visit>
bool for_each_cell(const Occluder& occluder, double cell_size, Visit visit) {
    const Vec3 center(occluder.center.x, occluder.center.y, occluder.center.z);
    const Quat turn(occluder.orientation.w, occluder.orientation.x, occluder.orientation.y, occluder.orientation.z);
    const double radius = std::max(0.0, -double(occluder.half_size.x));
    const Vec3 half = Vec3(occluder.half_size.x, occluder.half_size.y, occluder.half_size.z).cwiseMax(0.0);
    const double margin = radius + double(occluder.half_size.w);
    const Mat3 axes = turn.toRotationMatrix();
    const Vec3 extent = axes.cwiseAbs() * half + Vec3::Constant(margin);
    const Vec3 low = ((center - extent) / cell_size).array().floor(), high = ((center + extent) / cell_size).array().floor();
    if (!((high - low + Vec3::Ones()).prod() <= most_cells) || !(low.cwiseAbs().maxCoeff() < 1e9)) return false;
    const double near = margin + 0.5 * std::sqrt(3.0) * cell_size;   // a cell's corner is this much closer than its centre
    for (int z = int(low.z()); z <= int(high.z()); ++z)
        for (int y = int(low.y()); y <= int(high.y()); ++y)
            for (int x = int(low.x()); x <= int(high.x()); ++x) {
                const Vec3 middle = (Vec3(x, y, z) + Vec3::Constant(0.5)) * cell_size;
                const Vec3 local = axes.transpose() * (middle - center);
                if ((local.cwiseAbs() - half).cwiseMax(0.0).squaredNorm() <= near * near) visit(x, y, z);
            }
    return true;
}

// The same as in shaders/occlusion.glsl.
std::uint32_t hash_of(int x, int y, int z) {
    return std::uint32_t(x) * 73856093u ^ std::uint32_t(y) * 19349663u ^ std::uint32_t(z) * 83492791u;
}

void fill_cells(OccluderGrid& grid) {
    std::vector<std::vector<std::int32_t>> lists(grid.table_size);
    std::vector<std::int32_t> everywhere;
    for (std::size_t i = 0; i < grid.occluders.size(); ++i) {
        const bool fits = for_each_cell(grid.occluders[i], grid.cell_size, [&](int x, int y, int z) {
            auto& list = lists[hash_of(x, y, z) & (grid.table_size - 1)];
            if (list.empty() || list.back() != std::int32_t(i)) list.push_back(std::int32_t(i));   // two cells, one list
        });
        if (!fits) everywhere.push_back(std::int32_t(i));
    }
    grid.cells.assign(grid.table_size, 0);
    for (std::size_t slot = 0; slot < lists.size(); ++slot) {
        grid.cells[slot] = std::int32_t(grid.cells.size());
        grid.cells.insert(grid.cells.end(), lists[slot].begin(), lists[slot].end());
        grid.cells.insert(grid.cells.end(), everywhere.begin(), everywhere.end());
        grid.cells.push_back(-1);
    }
}

}  // namespace

OccluderGrid make_occluder_grid(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view) {
    OccluderGrid grid;
    grid.occluders = gather(looks, snapshot, view);
    if (!grid.occluders.empty()) {
        std::vector<float> reaches;
        for (const Occluder& o : grid.occluders) reaches.push_back(o.half_size.w);
        std::nth_element(reaches.begin(), reaches.begin() + std::ptrdiff_t(reaches.size() / 2), reaches.end());
        grid.cell_size = cell_of_reach * double(reaches[reaches.size() / 2]);
    }
    while (grid.table_size < 16 * grid.occluders.size()) grid.table_size *= 2;
    fill_cells(grid);

    for (std::size_t i = 0; i < looks.bodies.size() && grid.planes.size() < most_occluding_planes; ++i) {
        if (looks.bodies[i].kind != DrawKind::plane) continue;
        const PlaneShape plane = plane_in_world(looks.bodies[i], snapshot.bodies[i]);
        const double height = plane.normal.dot(view.eye()) - plane.offset;
        if (height > 0.0) grid.planes.push_back(to_glm(plane.normal, height));
    }
    return grid;
}

}  // namespace tumble

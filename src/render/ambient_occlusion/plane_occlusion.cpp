#include "render/ambient_occlusion/plane_occlusion.h"

#include "render/scene/distance_outliers.h"
#include "render/scene/plane_patch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int tile_step = 16;     // texels; a tile that moves redraws the whole plane
constexpr int update_block = 16;  // texels; about the size that one moved body affects

}  // namespace

PlaneOcclusion::Texels PlaneOcclusion::touched(const Foot& foot, const PlaneOcclusionTile& tile) {
    const auto first = [&](double at, double low) {
        return std::max(1.0, std::floor((at - foot.radius) / tile.cell - low));
    };
    const auto last = [&](double at, double low, int count) {
        return std::min(double(count - 2), std::ceil((at + foot.radius) / tile.cell - low));
    };
    // Outside the tile the numbers can be large, but then the range is empty.
    const double i0 = first(foot.a, tile.low_a), i1 = last(foot.a, tile.low_a, tile.width);
    const double j0 = first(foot.b, tile.low_b), j1 = last(foot.b, tile.low_b, tile.height);
    if (i0 > i1 || j0 > j1) return {0, -1, 0, -1};
    return {int(i0), int(i1), int(j0), int(j1)};
}

// Places the tile around all footprints. If they do not fit: around those without outliers, or where most of them are.
bool PlaneOcclusion::place(PlaneOcclusionTile& tile, ShelfPacker& shelves) const {
    constexpr int largest = OcclusionAtlas::largest_plane_tile;
    // distance from the first eye position
    const auto distance = [](const Foot& foot) { return double(foot.occluder->center.norm()); };
    const auto limit_of_near = [&] {
        std::vector<double> distances;
        for (const Foot& foot : feet_) distances.push_back(distance(foot));
        return far_limit(distances);
    };
    const auto range = [&](auto coordinate, double& low, int& count) {
        double least = 0.0, most = 0.0;
        const auto fit = [&](double farthest) {
            least = std::numeric_limits<double>::infinity(), most = -least;
            for (const Foot& foot : feet_) {
                if (std::isfinite(farthest) && distance(foot) > farthest) continue;
                least = std::min(least, coordinate(foot) - foot.radius);
                most = std::max(most, coordinate(foot) + foot.radius);
            }
            return (most - least) / tile.cell <= largest - 4;
        };
        double limit = std::numeric_limits<double>::infinity();
        if (!fit(limit) && !fit(limit = limit_of_near())) {
            std::vector<double> middles;
            for (const Foot& foot : feet_)
                if (distance(foot) <= limit) middles.push_back(coordinate(foot));
            const auto middle = middles.begin() + std::ptrdiff_t(middles.size() / 2);
            std::nth_element(middles.begin(), middle, middles.end());
            least = *middle - 0.5 * (largest - 4) * tile.cell;
            most = *middle + 0.5 * (largest - 4) * tile.cell;
        }
        // Whole steps, so that it seldom moves, with an unoccluded texel on either side.
        low = tile_step * std::floor((least / tile.cell - 1.0) / tile_step);
        count = std::min(largest, tile_step * int(std::ceil((std::ceil(most / tile.cell) - low + 2.0) / tile_step)));
    };
    range([](const Foot& foot) { return foot.a; }, tile.low_a, tile.width);
    range([](const Foot& foot) { return foot.b; }, tile.low_b, tile.height);
    return shelves.take(tile.width, tile.height, tile.x, tile.y);
}

std::optional<PlaneOcclusionTile> PlaneOcclusion::update(const PlaneInView& plane, const FrameOccluders& occluders,
                                                         const PlaneOcclusionTile* known, ShelfPacker& shelves,
                                                         const Store& store) {
    const RenderScene& scene = occluders.frame.scene;
    const Snapshot& snapshot = occluders.frame.snapshot;
    const Vec3& reference = occluders.reference;
    const RenderBody& proxy = scene.bodies[plane.body];
    const BodyState& state = snapshot.bodies[plane.body];
    const PlaneAxes axes = plane_axes(proxy.plane.normal);
    const Vec3 u = state.orientation * axes.u, v = state.orientation * axes.v;
    const Vec3 origin = state.origin - reference;  // the plane's coordinates are relative to this point
    const auto add_foot = [&](const Occluder& o, std::vector<Foot>& feet) {
        const double height = double(plane.normal.dot(o.center)) + double(plane.height);
        if (height > double(o.bound_radius) + 2.0 * double(o.ao_radius) || height < -double(o.bound_radius)) return;
        const Vec3 from_origin = o.center.cast<double>() - origin;
        feet.push_back(
            {&o, u.dot(from_origin), v.dot(from_origin), double(o.bound_radius) + double(o.ao_radius), height});
    };
    feet_.clear();
    for (const Occluder& o : occluders.all) add_foot(o, feet_);
    if (feet_.empty()) return std::nullopt;
    PlaneOcclusionTile tile;
    tile.body = plane.body;
    // A power of two, with the tile on whole cells: texels keep their places while bodies move.
    const double cell = tile.cell = scene.plane_cell;
    if (!place(tile, shelves)) return std::nullopt;

    const int columns = (tile.width + update_block - 1) / update_block,
              rows = (tile.height + update_block - 1) / update_block;
    const bool all = occluders.anew || known == nullptr || *known != tile;
    dirty_.assign(std::size_t(columns) * std::size_t(rows), all ? 1 : 0);
    const auto for_blocks = [&](const Texels& t, const auto& see) {
        for (int row = t.j0 / update_block; row <= t.j1 / update_block; ++row)
            for (int column = t.i0 / update_block; column <= t.i1 / update_block; ++column)
                see(dirty_[std::size_t(row * columns + column)]);
    };
    if (!all) {
        std::vector<Foot> moved_feet;
        for (const Occluder& o : occluders.moved) add_foot(o, moved_feet);
        if (moved_feet.empty()) return tile;
        for (const Foot& foot : moved_feet)
            if (const Texels t = touched(foot, tile); !t.empty()) for_blocks(t, [](char& dirty) { dirty = 1; });
    }
    open_.assign(std::size_t(tile.width) * std::size_t(tile.height), 1.0f);
    const Vec3 on_plane = origin + proxy.plane.offset * plane.normal.cast<double>();
    OverhangHeights& overhangs = overhangs_[plane.body];
    overhangs.update({reference + on_plane + u * (tile.low_a * cell) + v * (tile.low_b * cell), u, v,
                      plane.normal.cast<double>(), cell, tile.width, tile.height},
                     scene, snapshot);
    for (const Foot& foot : feet_) {
        const Texels t = touched(foot, tile);
        if (t.empty()) continue;
        bool needed = all;
        if (!all) for_blocks(t, [&](const char& dirty) { needed = needed || dirty != 0; });
        if (!needed) continue;
        const Occluder& o = *foot.occluder;
        const float exposed =
            scene.bodies[o.body].fixed
                ? 1.0f
                : overhangs.open_share(foot.a / cell - tile.low_a, foot.b / cell - tile.low_b,
                                       double(o.half_size.minCoeff()) + double(o.radius), foot.height);
        if (exposed <= 0.0f) continue;
        const Vec3 corner = on_plane + u * ((tile.low_a + t.i0) * cell) + v * ((tile.low_b + t.j0) * cell);
        around_foot_.set({corner.cast<float>(), (u * cell).cast<float>(), (v * cell).cast<float>(), plane.normal,
                          t.i1 - t.i0 + 1, t.j1 - t.j0 + 1});
        around_foot_.occlude(o, o.ao_radius);
        const float* share = around_foot_.open().data();
        for (int j = t.j0; j <= t.j1; ++j)
            for (int i = t.i0; i <= t.i1; ++i, ++share)
                open_[std::size_t(j * tile.width + i)] *= exposed < 1.0f ? 1.0f - exposed * (1.0f - *share) : *share;
    }
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (dirty_[std::size_t(row * columns + column)] != 0)
                store(tile.x + column * update_block, tile.y + row * update_block,
                      std::min(update_block, tile.width - column * update_block),
                      std::min(update_block, tile.height - row * update_block), tile.width,
                      &open_[std::size_t(row * update_block * tile.width + column * update_block)]);
    return tile;
}

}  // namespace tumble

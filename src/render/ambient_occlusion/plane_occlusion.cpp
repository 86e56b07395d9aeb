#include "render/ambient_occlusion/plane_occlusion.h"

#include "render/scene/distance_outliers.h"
#include "render/scene/plane_axes.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int window_step = 16;   // texels; a tile that moves redraws the whole plane
constexpr int update_block = 16;  // texels; about the size that one moved body affects

}  // namespace

PlaneOcclusion::Texels PlaneOcclusion::touched(const Foot& foot, const PlaneOcclusionTile& window) {
    const auto first = [&](double at, double low) {
        return std::max(1.0, std::floor((at - foot.radius) / window.cell - low));
    };
    const auto last = [&](double at, double low, int count) {
        return std::min(double(count - 2), std::ceil((at + foot.radius) / window.cell - low));
    };
    // Outside the tile the numbers can be large, but then the range is empty.
    const double i0 = first(foot.a, window.low_a), i1 = last(foot.a, window.low_a, window.width);
    const double j0 = first(foot.b, window.low_b), j1 = last(foot.b, window.low_b, window.height);
    if (i0 > i1 || j0 > j1) return {0, -1, 0, -1};
    return {int(i0), int(i1), int(j0), int(j1)};
}

// Places the tile around all footprints. If they do not fit: around those without outliers, or where most of them are.
bool PlaneOcclusion::place(PlaneOcclusionTile& window, ShelfPacker& shelves) const {
    constexpr int largest = OcclusionAtlas::largest_window;
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
            return (most - least) / window.cell <= largest - 4;
        };
        double limit = std::numeric_limits<double>::infinity();
        if (!fit(limit) && !fit(limit = limit_of_near())) {
            std::vector<double> middles;
            for (const Foot& foot : feet_)
                if (distance(foot) <= limit) middles.push_back(coordinate(foot));
            const auto middle = middles.begin() + std::ptrdiff_t(middles.size() / 2);
            std::nth_element(middles.begin(), middle, middles.end());
            least = *middle - 0.5 * (largest - 4) * window.cell;
            most = *middle + 0.5 * (largest - 4) * window.cell;
        }
        // Whole steps, so that it seldom moves, with an unoccluded texel on either side.
        low = window_step * std::floor((least / window.cell - 1.0) / window_step);
        count =
            std::min(largest, window_step * int(std::ceil((std::ceil(most / window.cell) - low + 2.0) / window_step)));
    };
    range([](const Foot& foot) { return foot.a; }, window.low_a, window.width);
    range([](const Foot& foot) { return foot.b; }, window.low_b, window.height);
    return shelves.take(window.width, window.height, window.x, window.y);
}

bool PlaneOcclusion::update(const PlaneInView& plane, const RenderScene& looks, const Snapshot& snapshot,
                            const Vec3& reference, const std::vector<Occluder>& occluders,
                            const std::vector<Occluder>& moved, bool everything, const PlaneOcclusionTile* known,
                            ShelfPacker& shelves, PlaneOcclusionTile& window, const Store& store) {
    const RenderBody& look = looks.bodies[plane.body];
    const BodyState& state = snapshot.bodies[plane.body];
    const PlaneAxes axes = plane_axes(look.plane.normal);
    const Vec3 u = state.orientation * axes.u, v = state.orientation * axes.v;
    const Vec3 origin = state.origin - reference;  // the plane's coordinates are relative to this point
    const auto add_foot = [&](const Occluder& o, std::vector<Foot>& feet) {
        const double height = double(plane.normal.dot(o.center)) + double(plane.height);
        if (height > double(o.bound_radius) + 2.0 * double(o.reach) || height < -double(o.bound_radius)) return;
        const Vec3 from_origin = o.center.cast<double>() - origin;
        feet.push_back({&o, u.dot(from_origin), v.dot(from_origin), double(o.bound_radius) + double(o.reach), height});
    };
    feet_.clear();
    for (const Occluder& o : occluders) add_foot(o, feet_);
    if (feet_.empty()) return false;
    window = {};
    window.body = plane.body;
    // A power of two, with the tile on whole cells: texels keep their places while bodies move.
    const double cell = window.cell = looks.window_cell;
    if (!place(window, shelves)) return false;

    const int columns = (window.width + update_block - 1) / update_block,
              rows = (window.height + update_block - 1) / update_block;
    const bool all = everything || known == nullptr || *known != window;
    dirty_.assign(std::size_t(columns) * std::size_t(rows), all ? 1 : 0);
    const auto for_blocks = [&](const Texels& t, const auto& see) {
        for (int row = t.j0 / update_block; row <= t.j1 / update_block; ++row)
            for (int column = t.i0 / update_block; column <= t.i1 / update_block; ++column)
                see(dirty_[std::size_t(row * columns + column)]);
    };
    if (!all) {
        std::vector<Foot> moved_feet;
        for (const Occluder& o : moved) add_foot(o, moved_feet);
        if (moved_feet.empty()) return true;
        for (const Foot& foot : moved_feet)
            if (const Texels t = touched(foot, window); !t.empty()) for_blocks(t, [](char& dirty) { dirty = 1; });
    }
    open_.assign(std::size_t(window.width) * std::size_t(window.height), 1.0f);
    const Vec3 on_plane = origin + look.plane.offset * plane.normal.cast<double>();
    OverhangHeights& roof = roofs_[plane.body];
    roof.update({reference + on_plane + u * (window.low_a * cell) + v * (window.low_b * cell), u, v,
                 plane.normal.cast<double>(), cell, window.width, window.height},
                looks, snapshot);
    for (const Foot& foot : feet_) {
        const Texels t = touched(foot, window);
        if (t.empty()) continue;
        bool needed = all;
        if (!all) for_blocks(t, [&](const char& dirty) { needed = needed || dirty != 0; });
        if (!needed) continue;
        const Occluder& o = *foot.occluder;
        const float unroofed = looks.bodies[o.body].fixed
                                   ? 1.0f
                                   : roof.open_share(foot.a / cell - window.low_a, foot.b / cell - window.low_b,
                                                     double(o.half_size.minCoeff()) + double(o.radius), foot.height);
        if (unroofed <= 0.0f) continue;
        const Vec3 corner = on_plane + u * ((window.low_a + t.i0) * cell) + v * ((window.low_b + t.j0) * cell);
        around_foot_.set(corner.cast<float>(), (u * cell).cast<float>(), (v * cell).cast<float>(), plane.normal,
                         t.i1 - t.i0 + 1, t.j1 - t.j0 + 1);
        around_foot_.darken(o, o.reach);
        const float* share = around_foot_.open().data();
        for (int j = t.j0; j <= t.j1; ++j)
            for (int i = t.i0; i <= t.i1; ++i, ++share)
                open_[std::size_t(j * window.width + i)] *=
                    unroofed < 1.0f ? 1.0f - unroofed * (1.0f - *share) : *share;
    }
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (dirty_[std::size_t(row * columns + column)] != 0)
                store(window.x + column * update_block, window.y + row * update_block,
                      std::min(update_block, window.width - column * update_block),
                      std::min(update_block, window.height - row * update_block), window.width,
                      &open_[std::size_t(row * update_block * window.width + column * update_block)]);
    return true;
}

}  // namespace tumble

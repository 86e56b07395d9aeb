#include "render/shadow/caster_culling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

constexpr int cell = 4;                // texels: boxes of a large heap are some thirty across
constexpr double texel_margin = 0.5;   // texels; rasterization rounds to 1/256, a far texel is at most a quarter
constexpr double depth_margin = 5e-4;  // of the depth range; interpolation on steep faces has smaller errors
constexpr std::size_t fewest = 200;    // casters: in a heap of a hundred none is hidden

Vec3 to_map(const ShadowCascades& cascades, const Vec3& v) {
    const auto dot = [&](const glm::vec4& row) { return row.x * v.x() + row.y * v.y() + row.z * v.z(); };
    return {cascades.texels * dot(cascades.x), cascades.texels * dot(cascades.y), dot(cascades.z)};
}

}  // namespace

CasterCulling::CasterCulling(const ShadowCascades& cascades)
    : cascades_(&cascades),
      count_((cascades.texels + cell - 1) / cell),
      depths_(std::size_t(count_) * std::size_t(count_), infinity) {}

Vec3 CasterCulling::place(const Vec3& point) const {
    return to_map(*cascades_, point) + Vec3(cascades_->texels * double(cascades_->x.w),
                                            cascades_->texels * double(cascades_->y.w), double(cascades_->z.w));
}

CasterCulling::Outline CasterCulling::outline(const DrawableBounds& item) const {
    std::array<Vec3, 3> axes;
    for (int k = 0; k < 3; ++k) axes[std::size_t(k)] = to_map(*cascades_, item.half_axes.col(k));
    const Vec3 center = place(item.center);
    const Vec3 half_extent = axes[0].cwiseAbs() + axes[1].cwiseAbs() + axes[2].cwiseAbs();
    Outline o{center.x(), center.y(), half_extent.y(), center.z() - half_extent.z(), center.z() + half_extent.z(),
              {},         {}};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = axes[(k + 1) % 3], &b = axes[(k + 2) % 3];
        const double length = std::hypot(axes[k].x(), axes[k].y());
        o.strips[k] = {0.0, 0.0, infinity};  // of an edge parallel to the light
        if (length > 0.0) {
            const double u = -axes[k].y() / length, v = axes[k].x() / length;
            o.strips[k] = {u, v, std::abs(u * a.x() + v * a.y()) + std::abs(u * b.x() + v * b.y())};
        }
        const Vec3 normal = a.cross(b);
        o.fronts[k] = {-infinity, 0.0, 0.0};  // of a face seen edge-on
        if (normal.z() != 0.0)
            o.fronts[k] = {center.z() - std::abs(normal.dot(axes[k]) / normal.z()), -normal.x() / normal.z(),
                           -normal.y() / normal.z()};
    }
    return o;
}

template <class See>
bool CasterCulling::for_each_row(const Outline& o, bool wholly, See see) {
    const int first_row = int(std::floor((o.v - o.half_v - texel_margin) / cell)),
              last_row = int(std::floor((o.v + o.half_v + texel_margin) / cell));
    for (int row = first_row; row <= last_row; ++row) {
        const double y = (row + 0.5) * cell - o.v;
        double low = -infinity, high = infinity;  // range of cell centers, texels from the center of the hexagon
        for (const Outline::Strip& s : o.strips) {
            const double rim = 0.5 * cell * (std::abs(s.u) + std::abs(s.v)) + texel_margin;
            const double half = wholly ? s.half - rim : s.half + rim;
            const double shift = s.v * y;
            if (s.u == 0.0) {
                if (!(std::abs(shift) < half)) high = -infinity;
                continue;
            }
            const double middle = -shift / s.u, width = half / std::abs(s.u);
            low = std::max(low, middle - width);
            high = std::min(high, middle + width);
        }
        if (!(low < high)) continue;
        if (!see(row, int(std::ceil((o.u + low) / cell - 0.5)), int(std::floor((o.u + high) / cell - 0.5))))
            return false;
    }
    return true;
}

void CasterCulling::add(const DrawableBounds& box) {
    const Outline o = outline(box);
    for_each_row(o, true, [&](int row, int first, int last) {
        if (row < 0 || row >= count_) return true;
        for (int column = std::max(first, 0); column <= std::min(last, count_ - 1); ++column) {
            const double x = (column + 0.5) * cell - o.u, y = (row + 0.5) * cell - o.v;
            double deepest = o.nearest;
            for (const Outline::Front& f : o.fronts)
                deepest =
                    std::max(deepest, f.depth + f.du * x + f.dv * y + 0.5 * cell * (std::abs(f.du) + std::abs(f.dv)));
            double& depth = depths_[std::size_t(row * count_ + column)];
            depth = std::min(depth, std::min(deepest, o.furthest));
        }
        return true;
    });
}

bool CasterCulling::hides(const DrawableBounds& item) const {
    // Most casters are visible at their center.
    const Vec3 middle = place(item.center) / cell;
    if (!(middle.x() >= 0.0 && middle.x() < count_ && middle.y() >= 0.0 && middle.y() < count_)) return false;
    if (!(depths_[std::size_t(int(middle.y()) * count_ + int(middle.x()))] < cell * middle.z())) return false;
    const Outline o = outline(item);
    return for_each_row(o, false, [&](int row, int first, int last) {
        if (row < 0 || row >= count_ || first < 0 || last >= count_) return false;
        for (int column = first; column <= last; ++column) {
            const double x = (column + 0.5) * cell - o.u, y = (row + 0.5) * cell - o.v;
            double nearest = o.nearest;
            for (const Outline::Front& f : o.fronts)
                nearest =
                    std::max(nearest, f.depth + f.du * x + f.dv * y - 0.5 * cell * (std::abs(f.du) + std::abs(f.dv)));
            if (!(depths_[std::size_t(row * count_ + column)] + depth_margin < nearest)) return false;
        }
        return true;
    });
}

void drop_hidden_casters(const RenderScene& scene, const PerDrawable<DrawableBounds>& drawables,
                         const ShadowCascades& cascades, DrawableMask& casters) {
    struct Caster {
        double depth;
        const DrawableBounds* bounds;
        char* mask;
        bool box;
    };
    std::vector<Caster> sorted;
    const auto add = [&](const DrawableBounds& bounds, char& mask, bool box) {
        if (mask != 0) sorted.push_back({to_map(cascades, bounds.center).z(), &bounds, &mask, box});
    };
    for (std::size_t i = 0; i < drawables.bodies.size(); ++i)
        add(drawables.bodies[i], casters.bodies[i], scene.bodies[i].kind == DrawKind::box);
    for (std::size_t i = 0; i < drawables.cords.size(); ++i) add(drawables.cords[i], casters.cords[i], false);
    if (sorted.size() < fewest) return;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Caster& a, const Caster& b) { return a.depth < b.depth; });
    CasterCulling cover(cascades);
    for (const Caster& caster : sorted) {
        if (cover.hides(*caster.bounds))
            *caster.mask = 0;
        else if (caster.box)
            cover.add(*caster.bounds);
    }
}

}  // namespace tumble

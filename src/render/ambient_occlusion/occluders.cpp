#include "render/ambient_occlusion/occluders.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tumble {
namespace {

// Cell size over the largest influence in it: a search then visits about 13 cells.
constexpr float cell_of_influence = 2.0f;

float influence(const Occluder& o) { return o.bound_radius + 2.0f * o.ao_radius; }

// The factors are primes. Cells along x are adjacent in the table; cells in one bucket cost a comparison.
std::uint32_t bucket(std::int32_t x, std::int32_t y, std::int32_t z) {
    return std::uint32_t(x) + std::uint32_t(y) * 73856093u + std::uint32_t(z) * 83492791u;
}

// Coordinates are clamped to one thousand million cells.
Eigen::Array3i cell_of(const Eigen::Array3f& at, float cell) {
    return (at / cell).floor().max(-1e9f).min(1e9f).cast<int>();
}

}  // namespace

void add_occluders(const RenderScene& scene, std::size_t body, const BodyState& state, const Vec3& reference,
                   std::vector<Occluder>& occluders) {
    const RenderBody& proxy = scene.bodies[body];
    if (!proxy.solid()) return;
    const Eigen::Matrix3f to_local = state.orientation.toRotationMatrix().transpose().cast<float>();
    const auto add = [&](const Vec3& center, const Vec3& half_size, double radius) {
        if (state.absent)  // keeps its place in the list
            return void(occluders.push_back(
                {Eigen::Vector3f::Zero(), to_local, Eigen::Vector3f::Zero(), 0.0f, 0.0f, 0.0f, body}));
        occluders.push_back({Vec3(state.origin + state.orientation * center - reference).cast<float>(), to_local,
                             half_size.cast<float>(), float(radius), float(proxy.ao_radius),
                             float(half_size.norm() + radius), body});
    };
    if (proxy.kind == DrawKind::box) add(Vec3::Zero(), proxy.half_size, 0.0);
    if (proxy.kind == DrawKind::ball) add(Vec3::Zero(), Vec3::Zero(), proxy.half_size.x());
    if (proxy.kind == DrawKind::mesh)
        for (const OccluderBox& box : scene.meshes[proxy.mesh].occluders) add(box.center, box.half_size, 0.0);
}

OccluderFinder::OccluderFinder(const std::vector<Occluder>& occluders) {
    std::map<int, std::vector<std::uint32_t>> by_size;
    for (std::size_t i = 0; i < occluders.size(); ++i)
        if (influence(occluders[i]) > 0.0f)  // others are of absent bodies
            by_size[std::ilogb(influence(occluders[i]))].push_back(std::uint32_t(i));
    for (const auto& [exponent, members] : by_size) {
        Level& level = levels_.emplace_back();
        level.cell = cell_of_influence * std::ldexp(2.0f, exponent);
        level.low.setConstant(std::numeric_limits<float>::infinity());
        level.high = -level.low;
        std::size_t buckets = 16;
        while (buckets < members.size()) buckets *= 2;
        level.mask = std::uint32_t(buckets - 1);
        level.starts.assign(buckets + 1, 0);
        const auto place = [&](std::uint32_t i) {
            const Eigen::Array3i cell = cell_of(occluders[i].center.array(), level.cell);
            return bucket(cell.x(), cell.y(), cell.z()) & level.mask;
        };
        std::vector<std::uint32_t> places;
        places.reserve(members.size());
        for (const std::uint32_t i : members) ++level.starts[places.emplace_back(place(i)) + 1];
        for (std::size_t b = 0; b < buckets; ++b) level.starts[b + 1] += level.starts[b];
        std::vector<std::uint32_t> next(level.starts.begin(), level.starts.end() - 1);
        level.entries.resize(members.size());
        for (std::size_t m = 0; m < members.size(); ++m) {
            const Occluder& o = occluders[members[m]];
            level.entries[next[places[m]]++] = {o.center.x(), o.center.y(), o.center.z(), influence(o), members[m]};
            level.largest = std::max(level.largest, influence(o));
            level.low = level.low.min(o.center.array());
            level.high = level.high.max(o.center.array());
        }
    }
}

template <class Visit>
void OccluderFinder::visit_near(const Eigen::Vector3f& center, float radius, Visit visit) const {
    const auto look_at = [&](const Entry& e) {
        const float dx = e.x - center.x(), dy = e.y - center.y(), dz = e.z - center.z(), near = e.influence + radius;
        return dx * dx + dy * dy + dz * dz < near * near ? visit(e.occluder) : true;
    };
    for (const Level& level : levels_) {
        const Eigen::Array3f at = center.array();
        const float within = radius + level.largest;
        if ((at + within < level.low).any() || (at - within > level.high).any()) continue;
        const Eigen::Array3i low = cell_of((at - within).max(level.low), level.cell);
        const Eigen::Array3i high = cell_of((at + within).min(level.high), level.cell);
        const Eigen::Array3d count = (high - low).cast<double>() + 1.0;
        if (count.prod() > double(level.entries.size())) {  // looking at all entries costs less
            for (const Entry& entry : level.entries)
                if (!look_at(entry)) return;
            continue;
        }
        for (int z = low.z(); z <= high.z(); ++z)
            for (int y = low.y(); y <= high.y(); ++y)
                for (int x = low.x(); x <= high.x(); ++x) {
                    const std::uint32_t b = bucket(x, y, z) & level.mask;
                    for (std::uint32_t i = level.starts[b]; i < level.starts[b + 1]; ++i)
                        if (!look_at(level.entries[i])) return;
                }
    }
}

void OccluderFinder::find(const Eigen::Vector3f& center, float radius, std::vector<std::size_t>& found) const {
    found.clear();
    visit_near(center, radius, [&](std::uint32_t occluder) {
        found.push_back(occluder);
        return true;
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());  // two cells may share a bucket
}

bool OccluderFinder::any(const Eigen::Vector3f& center, float radius) const {
    bool found = false;
    visit_near(center, radius, [&](std::uint32_t) { return !(found = true); });
    return found;
}

}  // namespace tumble

#include "sim/contact/soft/soft_areas.h"

#include <algorithm>

namespace tumble {
namespace {

using AreaRows = soft::ManifoldRows<float>;
using LoadPoint = soft::PointRows<float>;

Vec3 widened(const soft::Vector3<float>& v) { return {v.x, v.y, v.z}; }

// From the lane's view of an impulse along both tangents and about the normal to a manifold's, or back: seen from the
// other body the second tangent is reversed, and so is an impulse along the first.
Vec3 turned(bool swapped, const Vec3& friction) {
    return {swapped ? -friction.x() : friction.x(), friction.y(), friction.z()};
}

}  // namespace

template <class Visit>
void SoftAreas::each_area(std::size_t group, Visit&& visit) const {
    for (std::size_t l = 0; l < lanes_.width; ++l)
        if (const std::uint32_t place = layout_.joint(group * lanes_.width + l); place != JointLayout::none)
            visit(l, areas_->areas()[found_[place]]);
}

template <class Visit>
void SoftAreas::each_member(const SharedArea& area, Visit&& visit) const {
    for (std::uint32_t k = area.first; k < area.first + area.count; ++k)
        if (members_[k].lane != none) visit(members_[k], areas_->members(area)[k - area.first]);
}

void SoftAreas::open(const ContactProblem& problem, const IslandBatch& batch, const SoftLayout& layout,
                     const std::vector<std::uint32_t>& slot, const Lanes& lanes) {
    places_.clear();
    found_.clear();
    areas_ = problem.areas;
    if (!areas_) return;
    for (const std::uint32_t m : batch.manifolds) {
        if (!areas_->holds(m)) continue;
        const std::uint32_t k = areas_->area_of(m);
        if (areas_->members(areas_->areas()[k]).front() != m) continue;
        found_.push_back(k);
        const auto slot_of = [&](std::uint32_t body) { return problem.bodies[body].dynamic() ? slot[body] : 0u; };
        const std::uint32_t a = slot_of(problem.manifolds[m].a), b = slot_of(problem.manifolds[m].b);
        places_.push_back({a, b, std::uint32_t(layout.home(a, b)), soft::JointKind::point});
    }
    if (places_.empty()) return;
    lanes_ = lanes;
    layout_.color(places_, 1 + layout.blocks().order().size(), layout.blocks().size() + 1, lanes.width);
    members_.assign(areas_->size(), {});
    const std::size_t groups = layout_.groups();
    rows_.resize(groups * soft::group_rows * lanes.width);
    bodies_.resize(2 * groups * lanes.width);
    moved_.resize(2 * groups);
    one_point_.assign(groups, 1);
    no_points_.assign(groups, 0);
}

void SoftAreas::put(const ContactProblem& problem, std::uint32_t manifold, std::size_t lane, std::size_t points,
                    bool swapped) {
    const SharedArea& area = areas_->areas()[areas_->area_of(manifold)];
    const auto members = areas_->members(area);
    const auto place = std::size_t(std::lower_bound(members.begin(), members.end(), manifold) - members.begin());
    const Manifold& m = problem.manifolds[manifold];
    members_[area.first + place] = {std::uint32_t(lane), std::uint8_t(points), swapped,
                                    float(pair_friction(problem.bodies[m.a], problem.bodies[m.b]))};
}

void SoftAreas::pack(const ContactProblem& problem, std::size_t group) {
    const std::size_t width = lanes_.width;
    std::fill_n(rows_.data() + group * soft::group_rows * width, soft::group_rows * width, 0.0f);
    std::fill_n(bodies_.begin() + std::ptrdiff_t(2 * width * group), 2 * width, 0u);
    moved_[2 * group] = moved_[2 * group + 1] = 0;
    each_area(group, [&](std::size_t l, const SharedArea& area) {
        const soft::ManifoldLane lane = area_lane(group, l);
        const double share = 1.0 / lanes_.impulse_unit;
        bool first = true;
        Vec3 tangent = Vec3::Zero(), other_tangent = Vec3::Zero(), friction = Vec3::Zero();
        each_member(area, [&](const Member& member, std::uint32_t k) {
            const Manifold& m = problem.manifolds[k];
            const Vec3 normal = member.swapped ? Vec3(-m.normal) : m.normal;
            const Vec3 last = turned(member.swapped, Vec3(m.friction[0], m.friction[1], m.torsion));
            if (first) {  // bodies, normal and directions of the first manifold
                first = false;
                const std::size_t g = member.lane / width, its = member.lane % width;
                bodies_[2 * width * group + l] = lanes_.bodies[2 * width * g + its];
                bodies_[2 * width * group + width + l] = lanes_.bodies[2 * width * g + width + its];
                moved_[2 * group] |= std::uint16_t((lanes_.moved[2 * g] >> its & 1u) << l);
                moved_[2 * group + 1] |= std::uint16_t((lanes_.moved[2 * g + 1] >> its & 1u) << l);
                const Vec3 &a = problem.bodies[member.swapped ? m.b : m.a].position,
                           &b = problem.bodies[member.swapped ? m.a : m.b].position;
                const soft::PointLane point = lane.point(0);
                point.set(&LoadPoint::arm, area.centroid - a);
                point[&LoadPoint::present] = point[&LoadPoint::load_share] = 1.0f;
                lane.set(&AreaRows::normal, normal);
                lane.set(&AreaRows::tangent, m.tangent);
                lane.set(&AreaRows::between, a - b);
                lane[&AreaRows::friction_coefficient] = lane[&AreaRows::size] =
                    1.0f;  // the loads have their coefficients
                lane[&AreaRows::spread] = float(area.mean_distance / area.radius);
                tangent = m.tangent;
                other_tangent = normal.cross(tangent);
                friction = last;
                return;
            }
            const Vec3 force = last.x() * m.tangent + last.y() * normal.cross(m.tangent);
            friction += Vec3(force.dot(tangent), force.dot(other_tangent), last.z());
        });
        lane.set(&AreaRows::friction, Vec3(share * friction));
    });
}

void SoftAreas::finish(const ContactProblem&, std::size_t group) {
    each_area(group, [&](std::size_t l, const SharedArea& area) {
        area_lane(group, l).point(0)[&LoadPoint::lever] = float(area.mean_distance);
    });
}

void SoftAreas::gather(std::size_t group) {
    each_area(group, [&](std::size_t l, const SharedArea& area) {
        float load = 0.0f;
        soft::Vector3<float> turning{};
        each_member(area, [&](const Member& member, std::uint32_t) {
            const soft::ManifoldLane lane = lane_of(member);
            for (std::size_t i = 0; i < member.points; ++i) {
                const soft::PointLane point = lane.point(i);
                const float rubbed = member.friction * point[&LoadPoint::impulse];
                const soft::Vector3<float> arm = point.vector(&LoadPoint::moment_arm);
                load += rubbed;
                turning = {turning.x + rubbed * arm.x, turning.y + rubbed * arm.y, turning.z + rubbed * arm.z};
            }
        });
        const soft::PointLane point = area_lane(group, l).point(0);
        const float share = load > 0.0f ? 1.0f / load : 0.0f;
        point[&LoadPoint::impulse] = load;
        point.set(&LoadPoint::moment_arm, Eigen::Vector3f(share * turning.x, share * turning.y, share * turning.z));
    });
}

void SoftAreas::unpack(const ContactProblem& problem, std::size_t group, std::vector<std::uint8_t>& reached) {
    const std::size_t width = lanes_.width;
    each_area(group, [&](std::size_t l, const SharedArea& area) {
        const soft::ManifoldLane lane = area_lane(group, l);
        const auto total = lane.total_impulse();
        const Vec3 force = lanes_.mass_unit * widened(total.linear), moment = lanes_.mass_unit * widened(total.angular);
        const Vec3 friction = lanes_.impulse_unit * widened(lane.vector(&AreaRows::friction));
        const Vec3 tangent = widened(lane.vector(&AreaRows::tangent));
        double all = 0.0;
        std::uint32_t body_a = none, body_b = none;
        const auto load = [&](const Member& member, std::uint32_t k) {
            return double(member.friction) * normal_impulse(problem.manifolds[k]);
        };
        each_member(area, [&](const Member& member, std::uint32_t k) {
            all += load(member, k);
            const Manifold& m = problem.manifolds[k];
            body_a = member.swapped ? m.b : m.a;
            body_b = member.swapped ? m.a : m.b;
        });
        if (body_a == none) return;
        const bool none_presses = !(all > 0.0);
        bool first = true;
        each_member(area, [&](const Member& member, std::uint32_t k) {
            const double share = none_presses ? double(first) : load(member, k) / all;
            first = false;
            Manifold& m = problem.manifolds[k];
            const Vec3 own = share * turned(member.swapped, friction);
            m.friction[0] = own.x();
            m.friction[1] = own.y();
            m.torsion = own.z();
            m.tangent = tangent;
            if (!problem.totals) return;
            const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
            ManifoldImpulse& sum = (*problem.totals)[k];
            if (member.swapped)
                sum.add(-share * force, -share * (moment + (b.position - a.position).cross(force)), a, b);
            else
                sum.add(share * force, share * moment, a, b);
        });
        if (force.isZero(0.0) && moment.isZero(0.0)) return;
        Body &a = problem.bodies[body_a], &b = problem.bodies[body_b];
        if (moved_[2 * group] >> l & 1) {
            reached[bodies_[2 * width * group + l] / soft::body_floats] = 1;
            a.momentum -= force;
            a.angular_momentum -= moment;
        }
        if (moved_[2 * group + 1] >> l & 1) {
            reached[bodies_[2 * width * group + width + l] / soft::body_floats] = 1;
            b.momentum += force;
            b.angular_momentum += moment + (a.position - b.position).cross(force);
        }
    });
}

}  // namespace tumble

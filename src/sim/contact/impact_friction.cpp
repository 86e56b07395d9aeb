#include "sim/contact/impact_friction.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Minimises k0 f0^2 / 2 + k1 f1^2 / 2 + g0 f0 + g1 f1 over the disc |f| <= radius. On the edge f_i = -g_i / (k_i + nu),
// with nu >= 0 the root of 1/|f(nu)| = 1/radius, which Newton's steps approach from the left (More and Sorensen 1983,
// "Computing a trust region step").
std::pair<double, double> least_in_disc(double k0, double k1, double g0, double g1, double radius,
                                        double tolerance) {
    double f0 = -g0 / k0, f1 = -g1 / k1;
    double length = std::sqrt(f0 * f0 + f1 * f1);
    if (length <= radius) return {f0, f1};
    if (!(radius > 0.0)) return {0.0, 0.0};
    double nu = 0.0;
    for (int i = 0; i < tuning::friction_newton && length - radius > tolerance * radius; ++i) {
        const double slope = f0 * f0 / (k0 + nu) + f1 * f1 / (k1 + nu);
        nu += length * length / slope * (length - radius) / radius;
        f0 = -g0 / (k0 + nu);
        f1 = -g1 / (k1 + nu);
        length = std::sqrt(f0 * f0 + f1 * f1);
    }
    const double back = std::min(1.0, radius / length);
    return {back * f0, back * f1};
}

}  // namespace

ImpactFriction::Block ImpactFriction::make_block(const ContactCluster& cluster, std::size_t contact) {
    const Contact& c = cluster.contact(contact);
    Block block;
    block.contact = contact;
    const Vec3 t = c.normal.unitOrthogonal(), s = c.normal.cross(t);
    const VelocityRow along_t = cluster.relative_row(c, t), along_s = cluster.relative_row(c, s);
    const double tt = along_t.squared_norm(), ss = along_s.squared_norm(), ts = along_t.dot(along_s);
    // Eigenvectors of the two-by-two compliance.
    const double half = 0.5 * (tt - ss), root = std::sqrt(half * half + ts * ts);
    double cosine = 1.0, sine = 0.0;
    if (root > 0.0) {
        const double x = half >= 0.0 ? half + root : std::abs(ts), y = half >= 0.0 ? ts : std::copysign(root - half, ts);
        const double norm = std::sqrt(x * x + y * y);
        cosine = x / norm;
        sine = y / norm;
    }
    block.first = cosine * t + sine * s;
    block.second = cosine * s - sine * t;
    block.first_row = cluster.relative_row(c, block.first);
    block.second_row = cluster.relative_row(c, block.second);
    block.first_offset = cluster.offset(c, block.first);
    block.second_offset = cluster.offset(c, block.second);
    block.first_compliance = block.first_row.squared_norm();
    block.second_compliance = block.second_row.squared_norm();
    return block;
}

// Where there is no normal impulse there is no friction: most contacts of a heap have none in an impact.
void ImpactFriction::add_blocks(const ContactCluster& cluster) {
    const std::size_t before = blocks_.size();
    for (std::size_t i = 0; i < cluster.size(); ++i) {
        if (has_block_[i] || !(cluster.impulse(i) > 0.0) || cluster.contact(i).friction <= 0.0) continue;
        has_block_[i] = 1;
        blocks_.push_back(make_block(cluster, i));
    }
    if (blocks_.size() == before) return;
    std::sort(blocks_.begin(), blocks_.end(), [](const Block& l, const Block& r) { return l.contact < r.contact; });
}

double ImpactFriction::tolerance() const {
    return blocks_.size() <= tuning::friction_few ? tuning::friction_tolerance : tuning::friction_tolerance_many;
}

// Returns the change of speed made, m/s.
double ImpactFriction::relax(ContactCluster& cluster, Block& block) const {
    const double radius = cluster.contact(block.contact).friction * cluster.impulse(block.contact);
    if (radius == 0.0 && block.f0 == 0.0 && block.f1 == 0.0) return 0.0;
    const double k0 = block.first_compliance, k1 = block.second_compliance;
    const double slip0 = block.first_row.dot(cluster.velocity()) + block.first_offset;
    const double slip1 = block.second_row.dot(cluster.velocity()) + block.second_offset;
    const auto [f0, f1] = least_in_disc(k0, k1, slip0 - k0 * block.f0, slip1 - k1 * block.f1, radius, tolerance());
    const double step0 = f0 - block.f0, step1 = f1 - block.f1;
    cluster.push_along(block.first_row, step0);
    cluster.push_along(block.second_row, step1);
    block.f0 = f0;
    block.f1 = f1;
    return std::max(std::abs(step0) * k0, std::abs(step1) * k1);
}

bool ImpactFriction::apply(ContactCluster& cluster) {
    add_blocks(cluster);
    double most = 0.0;
    const int sweeps = blocks_.size() <= tuning::friction_few
                           ? tuning::friction_sweeps
                           : std::max(tuning::friction_least_sweeps, tuning::friction_work / int(blocks_.size()));
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0.0;
        for (Block& block : blocks_) change = std::max(change, relax(cluster, block));
        most = std::max(most, change);
        if (blocks_.size() < 2 || change <= tolerance() * most) break;
    }
    return most > cluster.rounding();
}

void ImpactFriction::store(const ContactCluster& cluster, std::vector<Contact>& contacts) const {
    for (const Block& block : blocks_)
        contacts[cluster.contact_index(block.contact)].impact_friction = block.f0 * block.first + block.f1 * block.second;
}

}  // namespace tumble

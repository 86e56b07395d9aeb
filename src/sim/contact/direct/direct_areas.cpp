// DirectSolver: friction of contact areas that several manifolds share (contact_areas.h). The rows of the first
// constraint act at the centroid of the area, within the limits of all loads; the others have normal rows alone.
#include "sim/contact/direct/direct_solver.h"

#include <algorithm>

namespace tumble {

using namespace contact_rows;

// Before the friction rows of `constraint` are made. A manifold with points that bounce keeps friction of its own.
void DirectSolver::join_area(ConstraintRows& constraint, const ContactProblem& problem) {
    const Manifold& m = problem.manifolds[constraint.manifold];
    if (constraint.count < m.count) return;
    const SharedArea& area = problem.areas->areas()[problem.areas->area_of(constraint.manifold)];
    ContactConstraint& geometry = constraint.geometry;
    geometry.friction_arm_a = area.centroid - problem.bodies[m.a].position;
    geometry.friction_arm_b = area.centroid - problem.bodies[m.b].position;
    const int own = int(constraints_.size());
    const auto found = std::find_if(area_firsts_.rbegin(), area_firsts_.rend(),
                                    [&](int k) { return constraints_[std::size_t(k)].area == &area; });
    if (found == area_firsts_.rend()) {
        area_firsts_.push_back(own);
        constraint.area = &area;
        constraint.first = own;
        return;
    }
    ConstraintRows& first = constraints_[std::size_t(*found)];
    constraint.rubs = false;
    constraint.first = *found;
    constraint.next = std::exchange(first.next, own);
    // The impulses of the last step, in the directions of the first; the common body may be A of one and B of the
    // other.
    const double side = geometry.normal.dot(first.geometry.normal) < 0.0 ? -1.0 : 1.0;
    const Vec3 friction = side * (m.friction[0] * geometry.tangent_1 + m.friction[1] * geometry.tangent_2);
    first.friction[0].estimate += friction.dot(first.geometry.tangent_1);
    first.friction[1].estimate += friction.dot(first.geometry.tangent_2);
    first.torsion.estimate += m.torsion;
    geometry.tangent_1 = first.geometry.tangent_1;
    geometry.tangent_2 = geometry.normal.cross(geometry.tangent_1);
}

// Shared load of all constraints of an area, from their estimates or impulses: load (N s) and its levers (N s m), both
// times the coefficients of friction.
std::pair<double, double> DirectSolver::shared_load(const ConstraintRows& first, double Row::*impulse) const {
    double load = 0.0;
    Vec3 aside = Vec3::Zero();
    const auto add_constraint = [&](const ConstraintRows& constraint) {
        for (int i = 0; i < constraint.count; ++i) {
            const double rubbed = constraint.coefficient * (constraint.normal[i].*impulse);
            load += rubbed;
            aside += rubbed * (constraint.geometry.points[std::size_t(i)].arm_a - constraint.geometry.friction_arm_a);
        }
    };
    add_constraint(first);
    for (int k = first.next; k != none; k = constraints_[std::size_t(k)].next)
        add_constraint(constraints_[std::size_t(k)]);
    return {load, first.area->levers(load, aside.norm())};
}

void DirectSolver::sum_area_loads() {
    for (const int k : area_firsts_) {
        ConstraintRows& first = constraints_[std::size_t(k)];
        first.area_load = shared_load(first, &Row::impulse).first;
    }
}

// Friction of a constraint; of a shared area, its part in proportion to the loads. Precondition: sum_area_loads().
DirectSolver::Rubbing DirectSolver::rubbing(const ConstraintRows& constraint) const {
    if (constraint.first == none)
        return {constraint.friction[0].impulse, constraint.friction[1].impulse,
                constraint.count > 1 ? constraint.torsion.impulse : 0.0};
    const ConstraintRows& first = constraints_[std::size_t(constraint.first)];
    double load = 0.0;
    for (int i = 0; i < constraint.count; ++i) load += constraint.coefficient * constraint.normal[i].impulse;
    const double share = first.area_load > 0.0 ? load / first.area_load : constraint.rubs ? 1.0 : 0.0;
    // Seen from the other body the second tangent is reversed too, and so is an impulse along the first.
    const double side = constraint.geometry.normal.dot(first.geometry.normal) < 0.0 ? -1.0 : 1.0;
    return {side * share * first.friction[0].impulse, share * first.friction[1].impulse, share * first.torsion.impulse};
}

}  // namespace tumble

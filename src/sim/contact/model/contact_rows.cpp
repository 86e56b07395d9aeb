#include "sim/contact/model/contact_rows.h"

namespace tumble::contact_rows {

void set_row(Row& row, const Vec3& direction, const Vec3& arm_a, const Vec3& arm_b, const RowBodies& bodies) {
    const auto& [patch, a, b, length] = bodies;
    if (patch.a != none)
        put(row.on_a, -direction, -arm_a.cross(direction) / length);
    else if (a.moves())
        row.offset -= direction.dot(a.point_velocity(arm_a));
    if (patch.b != none)
        put(row.on_b, direction, arm_b.cross(direction) / length);
    else if (b.moves())
        row.offset += direction.dot(b.point_velocity(arm_b));
}

void set_twist(Row& row, const Vec3& normal, const RowBodies& bodies) {
    const auto& [patch, a, b, length] = bodies;
    if (patch.a != none)
        put(row.on_a, Vec3::Zero(), -normal / length);
    else if (a.moves())
        row.offset -= normal.dot(a.angular_velocity);
    if (patch.b != none)
        put(row.on_b, Vec3::Zero(), normal / length);
    else if (b.moves())
        row.offset += normal.dot(b.angular_velocity);
}

}  // namespace tumble::contact_rows

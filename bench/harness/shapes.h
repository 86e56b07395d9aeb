// Short constructors of the scenes' bodies.
#pragma once

#include "harness/scene.h"

namespace tumble::bench {

Body box(const Vector& size, double mass, const Vector& position);
Body sphere(double radius, double mass, const Vector& position);
Body plane(const Vector& normal, double offset);
Body fixed_box(const Vector& size, const Vector& position);
/// A floor with its top at z = 0.
Body floor_box(double side = 100.0);
/// A floor and four walls of fixed boxes, 2 m thick; the inside is 2 half_width wide.
void add_pit(Scene& scene, double half_width, double height);
void set_materials(Scene& scene, double friction, double restitution);

}  // namespace tumble::bench

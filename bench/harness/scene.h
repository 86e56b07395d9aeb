// The scenes of the benchmarks as plain numbers, for Tumble and its peers alike. SI units, world frame, z up.
// Independent of any simulation library, and without Eigen: DART includes its own with another alignment.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace tumble::bench {

struct Vector {
    double x = 0.0, y = 0.0, z = 0.0;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr double g = 9.81;  // m/s^2, standard gravity, rounded

/// A unit quaternion, body to world.
struct Orientation {
    double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};
Orientation turn(const Vector& axis, double radians);
Orientation operator*(const Orientation& a, const Orientation& b);  // first b, then a
Vector rotate(const Orientation& q, const Vector& v);
Vector rotate_back(const Orientation& q, const Vector& v);

/// hexahedron: a box with moved corners and flat faces; used for the stones of arches. compound: several boxes.
enum class Kind { plane, box, sphere, hexahedron, compound };

/// Corner i of a box or hexahedron lies at the + end of x, y, z where bit 0, 1, 2 of i is set.
using Corners = std::array<Vector, 8>;
/// The corners of its six sides, -x +x -y +y -z +z, each counterclockwise from outside; and of its twelve edges.
inline constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
inline constexpr int edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                     {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

struct BoxPart {
    Vector size, position;  // m; body frame
    Orientation orientation;
};

/// A body of cells that part where a load is above the strength of the bonds between them.
struct Breakage {
    int cells = 0;
    double strength = 0.0, stiffness = 0.0;  // Pa
    double toughness = 0.0;                  // J/m^2 of new surface
    double blow_time = 0.0;                  // s, in which an impulse acts
};

struct Body {
    Kind kind = Kind::sphere;
    Vector size;                   // box: edge lengths, m
    Corners corners{};             // hexahedron, m, from its center of mass, along its principal axes
    std::vector<BoxPart> parts;    // compound, about its center of mass, along its principal axes
    double radius = 0.0;           // sphere, m
    Vector normal{0.0, 0.0, 1.0};  // plane: unit; the solid is the set of points p with normal . p < offset
    double offset = 0.0;           // m
    bool fixed = false;            // planes are always fixed
    double mass = 1.0;             // kg, uniform density
    double restitution = 1.0;      // a pair uses the larger value of its moving bodies
    double friction = 0.0;         // of its material; a pair uses sqrt(a b)
    Vector position;               // m, of the center of mass
    Orientation orientation;
    Vector velocity;          // m/s
    Vector angular_velocity;  // rad/s, world frame
    std::optional<Breakage> breakage;

    bool moves() const { return !fixed && kind != Kind::plane; }
    Vector principal_inertia() const;  // kg m^2, about the body's own axes
    Corners outline() const;           // the corners of a box or hexahedron, body frame
    double reach() const;              // m, distance of the farthest point from the center; infinite for planes
};

/// F = 1/2 density drag A |w - v| (w - v) at the center of mass, A a quarter of the surface (Cauchy's mean projection).
struct Air {
    Vector velocity;  // m/s
    double density = 1.2, drag = 1.0;
};
/// A force fixed in the body, at a point of it.
struct PointForce {
    Vector point, force;  // m and N, body frame
};

/// Deep water below z = 0, at rest but for one wave that travels along x (Airy 1845). Drag of an element of the wet
/// surface that shows the area A to the flow: 1/2 density drag A v^2; and 6 pi viscosity r v, with r of a ball of the
/// wet volume.
struct Water {
    double density = 1000.0;                      // kg/m^3
    double drag = 1.0, viscosity = 0.0;           // -, Pa s
    double wave_height = 0.0;                     // m, from trough to crest; 0: still water
    double wave_length = 1.0;                     // m
    double surface(double x, double time) const;  // m, z
};

/// A torque that is fixed in the body.
struct Torque {
    std::size_t body = 0;
    Vector torque;  // N m, body frame
};
/// A massless spring without damping between a point of the world and one of a body.
struct Spring {
    std::size_t body = 0;
    Vector from, point;                    // m: world frame, and body frame from the center of mass
    double stiffness = 0.0, length = 0.0;  // N/m; m, at rest
};

/// distance: a massless rod between two anchors. The rod's length is their distance at the start.
enum class JointKind { ball, hinge, fixed, slider, distance };
inline constexpr std::size_t the_world = std::size_t(-1);  // in place of a body's index

/// Joins two bodies as they lie at the start, where the coordinate of a hinge or slider is 0. The coordinate grows when
/// the second body turns about the axis, or moves along it, relative to the first.
struct Joint {
    JointKind kind = JointKind::ball;
    std::size_t first = the_world, second = the_world;
    Vector anchor;                                // m, world frame, at the start; of a distance: of the first body
    Vector second_anchor;                         // m, of a distance: of the second body
    Vector axis{0.0, 0.0, 1.0};                   // world frame, at the start; of a ball: the axis of its cone
    std::optional<std::array<double, 2>> limits;  // rad or m, of a hinge or slider
    std::optional<double> cone;                   // rad, of a ball: half angle within which the axis stays
    std::optional<double> speed;                  // rad/s or m/s, of the motor of a hinge or slider
    double strength = 0.0;                        // N m or N, the largest of the motor
    double break_force = 0.0;                     // N; 0: never breaks
    bool collide = false;                         // true if the two bodies collide with each other
};

struct Scene {
    double gravity = g;  // m/s^2, downwards
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    bool contacts = true;    // false: no bodies touch each other, and a program may leave out its search for contacts
    std::optional<Air> air;  // acts on all moving bodies
    std::optional<PointForce> push;  // acts on body 0
    std::vector<Torque> torques;
    std::vector<Spring> springs;
    std::optional<Water> water;   // in scenes without joints and forces
    bool breaks_watched = false;  // joints may stay whole where they should break: a watch looks at their forces

    /// True if bodies swim, or break.
    bool has_water_or_breakage() const;
    bool has_forces() const { return air || push || !torques.empty() || !springs.empty(); }
};

/// Pose and velocities of a body; world frame.
struct Motion {
    Vector position;
    Orientation orientation;
    Vector velocity, angular_velocity;
};

struct Wrench {
    Vector force, torque;
};
/// Force of air, push, torques and springs on a body, for the peers, which get external forces from the harness.
Wrench wrench(const Scene& scene, std::size_t body, const Motion& motion);
double mean_projected_area(const Body& body);

/// Friction for engines that use the smaller friction of a pair or, for fixed bodies first, that body's own: for a
/// fixed body the friction of its pair with the first moving body, for a moving body its own.
double told_friction(const Scene& scene, const Body& body);

/// Kinetic energy and that of the weights, J.
double energy(const Scene& scene, const std::vector<Motion>& motions);
Vector angular_momentum(const Body& body, const Motion& motion);  // about its center of mass, kg m^2/s

}  // namespace tumble::bench

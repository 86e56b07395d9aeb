// Fracture: a body that moves as one until bonds between its cells fail. Frame: the body's.
#pragma once

#include "core/color.h"
#include "core/error.h"
#include "core/vector.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// voronoi: each cell is the part that is nearest to its site. radial: rings and spokes. slabs: parallel cuts. bricks:
/// rows of a wall with staggered joints.
enum class FracturePattern { voronoi, radial, slabs, bricks };

/// How a body is cut into cells.
struct FractureRequest {
    int cells = 20;  // about; exact for voronoi and slabs without a `smallest`
    FracturePattern pattern = FracturePattern::voronoi;
    std::uint64_t seed = 1;
    std::optional<Vec3> focus;  // m, body frame: cells are smaller near it; empty: the center of the bounds
    /// The focus is the place of the blow that breaks the body; empty until it is known (presimulation/impact_focus.h).
    bool focus_at_impact = false;
    std::optional<Vec3> axis;        // unit, of slabs; empty: the longest one of the bounds
    std::optional<int> depth;        // how many times pieces may break again; empty: until single cells are left
    std::optional<double> smallest;  // m: cells of less than its cube are merged into neighbors
    /// Sides of the bounds that hold to the world, of fixed and kinematic bodies: -x, +x, -y, +y, -z, +z.
    std::array<bool, 6> held{false, false, true, false, false, false};
};

/// A face that two cells share, or that holds a cell to the world.
struct Bond {
    static constexpr std::uint32_t world = ~std::uint32_t(0);

    std::uint32_t a = 0, b = 0;   // cells, a < b; b may be `world`
    double area = 0.0;            // m^2
    Vec3 center = Vec3::Zero();   // m, of the face
    Vec3 normal = Vec3::UnitX();  // unit, from a to b
    /// Principal axes of the face, unit; axis1 x axis2 = normal.
    Vec3 axis1 = Vec3::UnitY(), axis2 = Vec3::UnitZ();
    double moment1 = 0.0, moment2 = 0.0;                         // m^4, second moments of area about axis1 and axis2
    double modulus1 = 0.0, modulus2 = 0.0, polar_modulus = 0.0;  // m^3: moment over the largest distance
    double length = 0.0;  // m, along the normal between the centers of the cells; to the world from the center of `a`
};

/// The cut and its material. Bonds and pieces are there when the scene is loaded.
struct FractureDescription : FractureRequest {
    double strength = 0.0;              // Pa, in tension
    double shear_strength = 0.0;        // Pa
    double compressive_strength = 0.0;  // Pa; 0: never fails by compression
    double stiffness = 0.0;             // Pa, Young's modulus
    double toughness = 0.0;             // J/m^2 of new crack
    double blow_time = 0.0;             // s, duration of a blow
    std::optional<Color> inner_color;   // of new faces; empty: a paler color than the body's
    SourceLocation where;               // of the key, for messages
    std::size_t first_piece = 0;        // index into SceneDescription::bodies: piece i is cell i
    std::size_t pieces = 0;             // number of cells
    std::vector<Bond> bonds;            // by a, then by b
};

}  // namespace tumble

// The limits of a scene file, each with its unit and its reason. They are far beyond any sensible scene and keep every
// later product, square and sum within the ranges of double and int.
#pragma once

#include "scene/toml/range.h"

#include <cstdint>
#include <limits>

namespace tumble::limits {

// -- Files
inline constexpr std::int64_t scene_bytes = 256 << 20;  // a file of a million bodies is about 100 MB
inline constexpr std::int64_t key_parts = 16;  // a.b.c has three, and a scene needs no more; each is a table in the one
                                               // before, and tables are destroyed by recursion
inline constexpr std::int64_t mesh_bytes =
    256 << 20;  // up to ten times the file in memory while it is read; also the limit of
                // the sum of all other files that contain a glTF's buffers
inline constexpr std::int64_t texture_side = 8192;         // pixels: 256 MiB with the float values of its mip maps
inline constexpr std::int64_t texture_texels = 128 << 20;  // of one mesh file: 680 MiB with mip maps
inline constexpr std::int64_t environment_side = 4096;     // pixels: 100 MB of light, and 64 MB in the renderer
inline constexpr std::int64_t json_values = 10'000'000;    // of a glTF file: 16 to 100 bytes of memory each
inline constexpr std::int64_t mesh_triangles = 5'000'000;  // 32-bit indices and about a gigabyte when welded

inline constexpr std::int64_t heights = 2'000'000;      // of a height field: two triangles each
inline constexpr std::int64_t hull_points = 1'000'000;  // of a hull shape: seconds of Qhull

inline constexpr std::int64_t polygon_corners =
    2000;  // cutting one takes time proportional to their square in the worst case

// -- Time
inline constexpr Range duration{0.0, 1e9, "s"};              // thirty years
inline constexpr Range fps{1e-9, 1e6, "frames per second"};  // 1e6: the format's; below: 1/fps is a valid time
inline constexpr std::int64_t frames = 10'000'000;           // two days of film at 60 fps, 7 digits of frame number
inline constexpr std::int64_t steps_per_frame = 1'000'000;
inline constexpr Range step{0.0, 1e9, "s", true};
inline constexpr double step_tolerance = 1e-9;     // s: tolerance for the division of a frame into steps (the format's)
inline constexpr Range time{0.0, 1e9, "s"};        // of keyframes and forces
inline constexpr Range clip_speed{1e-3, 1e3, ""};  // a thousandth to a thousandfold of the scene's own

// -- Output
inline constexpr std::int64_t image_side = 16'384;  // pixels: the largest texture of common OpenGL drivers

// -- Amounts
inline constexpr std::int64_t bodies = 1'000'000;       // about half a gigabyte of description
inline constexpr std::int64_t parts = 512;              // of one body: a part and a triangle (mesh_triangles) together
                                                        // number a contact in 32 bits
inline constexpr std::int64_t scatter_attempts = 1000;  // number of draws of a place for a copy:
                                                        // at the densest random packing (38 % of the volume,
                                                        // Renyi 1958, Torquato 2006) about this number is needed

inline constexpr std::int64_t joints = 1'000'000;  // about 1.5 gigabytes of description
inline constexpr std::int64_t links = 1'000'000;   // of one chain: as many as bodies

// -- Lengths. A meter has an error of 1e-7 m at 1e9 m, already too large for a simulation.
inline constexpr Range coordinate{-1e9, 1e9, "m"};
inline constexpr Range size{1e-9, 1e9, "m"};
inline constexpr Range size_or_zero{0.0, 1e9, "m"};
inline constexpr Range mesh_scale{1e-9, 1e9, ""};
inline constexpr Range copy_scale{1e-3, 1e3, ""};  // a thousandth to a thousandfold

// -- Motion: a million km/s is faster than light; the others keep energies finite.
inline constexpr Range velocity{-1e9, 1e9, "m/s"};
inline constexpr Range angular_velocity{-1e9, 1e9, "rad/s"};
inline constexpr Range acceleration{-1e9, 1e9, "m/s^2"};
inline constexpr Range force{-1e15, 1e15, "N"};

// -- Joints. Products with coordinates and speeds of the ranges above stay finite.
inline constexpr Range hinge_angle{-36'000.0, 36'000.0, "degrees"};  // a hundred turns: more is a spool or a mistake
inline constexpr Range half_turn{-180.0, 180.0, "degrees"};          // a pose shows an angle only up to whole turns
inline constexpr Range stiffness{0.0, 1e18, "N/m (N m/rad for angles)"};  // diamond, a meter thick, has 1e12
inline constexpr Range damping{0.0, 1e18, "N s/m (N m s/rad for angles)"};
inline constexpr Range frequency{0.0, 1e9, "Hz", true};  // sound in a crystal's cell
inline constexpr Range damping_ratio{0.0, 1e3, ""};      // 1 is critical; a thousandfold creeps
inline constexpr Range gear_ratio{-1e9, 1e9, ""};
inline constexpr double least_gear_ratio = 1e-9;     // in size
inline constexpr Range joint_force{0.0, 1e15, "N"};  // as of forces
inline constexpr Range joint_torque{0.0, 1e15, "N m"};
inline constexpr Range strength_force{0.0, 1e15, "N", true};  // 0 would break, or stand still, at once
inline constexpr Range strength_torque{0.0, 1e15, "N m", true};
inline constexpr Range strength_impulse{0.0, 1e15, "N s", true};
inline constexpr Range armature{0.0, 1e18, "kg m^2 or kg", true};
inline constexpr double anchor_tolerance = 1e-6;  // of the smaller body's size: rounding of hand-written numbers
inline constexpr double axis_tolerance = 1e-6;    // rad, the same
inline constexpr double start_tolerance = 1e-9;   // m or rad: a start at a limit is forgiven its rounding

// -- Fields and forces between bodies
inline constexpr Range field_strength{-1e30, 1e30, "m^3/s^2, or m^2/s^2 of a vortex"};
inline constexpr Range explosion_impulse{-1e15, 1e15, "N s"};
inline constexpr Range drag_linear{0.0, 1e15, "N s/m"};
inline constexpr Range drag_quadratic{0.0, 1e15, "N s^2/m^2"};
inline constexpr Range charge{-1e9, 1e9, "C"};
inline constexpr Range magnetic_moment{-1e9, 1e9, "A m^2"};
inline constexpr std::size_t pair_force_bodies = 1000;  // half a million pairs

// -- Water
inline constexpr Range viscosity{0.0, 1e12, "Pa s"};  // glass
inline constexpr std::size_t waves = 16;              // each has its sine at every point of the surface

// -- Matter
inline constexpr Range mass{0.0, 1e30, "kg", true};         // half a sun
inline constexpr Range density{0.0, 1e20, "kg/m^3", true};  // beyond a neutron star's 1e18
inline constexpr Range air_density{0.0, 1e6, "kg/m^3"};
inline constexpr Range drag{0.0, 1e3, ""};
inline constexpr Range restitution{0.0, 1.0, ""};
inline constexpr Range friction{0.0, 1e6, ""};          // a coefficient of 1e6 never slips
inline constexpr Range rolling_friction{0.0, 1e3, ""};  // 1: a cube that tips over its edges
inline constexpr Range gravity_scale{-1e6, 1e6, ""};
inline constexpr Range inertia{0.0, 1e30, "kg m^2", true};
inline constexpr Range inertia_product{-1e30, 1e30, "kg m^2"};
inline constexpr double inertia_tolerance = 1e-9;  // of the largest moment: rounding of the triangle inequality
inline constexpr std::int64_t layers = 63;         // of a scene: bits of a word, one of them for bodies without a layer
inline constexpr Range fraction{0.0, 1.0, ""};     // roughness, metallic, opacity

// -- Fracture
inline constexpr std::int64_t fracture_cells = 4096;     // of one body: a break solves a system of six rows for each
inline constexpr std::size_t fracture_pieces = 100'000;  // of all bodies: each is a body of the scene from the start
inline constexpr double least_cell = 1e-6;               // of the body's longest extent: hulls weld at 1e-9 of it
inline constexpr Range stress{0.0, 1e15, "Pa", true};    // a thousand times diamond
inline constexpr Range stress_or_zero{0.0, 1e15, "Pa"};
inline constexpr Range elasticity{0.0, 1e18, "Pa", true};
inline constexpr Range toughness{0.0, 1e12, "J/m^2"};
inline constexpr Range blow_time{0.0, 1e3, "s"};

// -- Light
inline constexpr std::int64_t lamps = 4;                 // each has its values at every vertex, of which OpenGL has few
inline constexpr Range light{0.0, 1e6, ""};              // a point of 1e6 is as bright as the sun at a distance of 1 km
inline constexpr Range environment_light{0.0, 1e4, ""};  // factor on light: the sun has 1
inline constexpr Range cone_angle{1.0, 170.0, "degrees"};
inline constexpr Range aperture{0.0, 1e9, "m", true};  // of a lens; 0 is a pinhole
inline constexpr Range focus{0.0, 1e9, "m", true};
inline constexpr std::int64_t lens_samples = 256;  // images a frame: at least 4, and sums of transparent ones fit
inline constexpr Range exposure{-20.0, 20.0, "stops"};

// -- Overlays
inline constexpr Range arrow_scale{0.0, 1e15, "m per SI unit",
                                   true};  // an arrow of 1 m for the weakest force of interest

inline constexpr Range label_size{4.0, 200.0, "pixels of a picture 720 pixels high"};
inline constexpr Range frame_share{0.01, 1.0, ""};  // of a picture in the frame
inline constexpr Range frame_margin{0.0, 0.5, ""};
inline constexpr std::int64_t insets = 4;  // each draws the scene once more
inline constexpr Range border{0.0, 50.0, "pixels of a picture 720 pixels high"};

// -- Angles and directions
inline constexpr Range angle{-1e6, 1e6, "degrees"};    // the reduction of sincos keeps all its digits far beyond
inline constexpr Range orbit{-1e6, 1e6, "degrees/s"};  // three thousand turns per second: more is a mistake
inline constexpr Range follow_time{0.0, 100.0, "s"};
inline constexpr Range tilt{0.0, 180.0, "degrees"};
inline constexpr Range field_of_view{1.0, 170.0, "degrees"};  // outside, the image is a dot or strongly distorted
inline constexpr Range direction{-1e30, 1e30, ""};            // only the ratio of its components counts
inline constexpr double quaternion_tolerance = 1e-3;  // of the norm: rounding of a hand-written one, not a mistake

}  // namespace tumble::limits

// The overlays of a clip: quantities that are drawn over its frames, captions, plots and a logo.
#pragma once

#include "core/color.h"
#include "core/vector.h"
#include "scene/description/label.h"
#include "scene/description/mesh_paint.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Places in a frame for pictures that are laid over it.
enum class FrameCorner : std::uint8_t { top_left, top_right, bottom_left, bottom_right };

/// A picture over all frames of a clip, in one of their corners.
struct LogoDescription {
    std::shared_ptr<const Texture> image;  // never null
    FrameCorner corner = FrameCorner::top_right;
    double width = 0.15;   // share of the width of the frame
    double margin = 0.03;  // to the edges of the frame, share of its height
    double opacity = 1.0;
};

enum class Overlay : std::uint8_t {
    contacts,          // contact points, marked by the features that meet
    normals,           // contact normals, from A to B
    impulses,          // impulses of impacts, shown for a while
    forces,            // contact forces on B, mean over the frame
    loads,             // weight, and forces at points ([[force]])
    velocity,          // of the center of mass
    omega,             // angular velocity
    momentum,          // linear
    angular_momentum,  // about the center of mass
    trails,            // the path of the center of mass or of body points (notes eq. 5)
    ghosts,            // the body's earlier poses
    aabb,              // axis-aligned bounding boxes
    axes,              // the body's own axes
    com,               // centers of mass
    joints,            // anchors, axes, limits, forces and torques of joints
    islands,           // bodies in contact with each other, by color
    sleep,             // sleeping bodies
    names,             // names of bodies
    damage,            // dirty regions: drawn anew since the previous frame
    title,             // the scene's title
    clock,             // the frame's time
    mode,              // integrator, impacts and step
    cracks,            // faces between the cells of bodies with `fracture`
};
inline constexpr std::size_t overlay_count = 23;

struct OverlayName {
    std::string_view name;
    Overlay overlay;
};
/// All overlays with their names in scenes and on the command line.
inline constexpr std::array<OverlayName, overlay_count> overlay_names{{
    {"contacts", Overlay::contacts}, {"normals", Overlay::normals},   {"impulses", Overlay::impulses},
    {"forces", Overlay::forces},     {"loads", Overlay::loads},       {"velocity", Overlay::velocity},
    {"omega", Overlay::omega},       {"momentum", Overlay::momentum}, {"angular-momentum", Overlay::angular_momentum},
    {"trails", Overlay::trails},     {"ghosts", Overlay::ghosts},     {"aabb", Overlay::aabb},
    {"axes", Overlay::axes},         {"com", Overlay::com},           {"islands", Overlay::islands},
    {"joints", Overlay::joints},     {"sleep", Overlay::sleep},       {"names", Overlay::names},
    {"damage", Overlay::damage},     {"title", Overlay::title},       {"clock", Overlay::clock},
    {"mode", Overlay::mode},         {"cracks", Overlay::cracks},
}};

class OverlaySet {
public:
    bool has(Overlay overlay) const { return (bits_ >> unsigned(overlay) & 1u) != 0; }
    void add(Overlay overlay) { bits_ |= 1u << unsigned(overlay); }
    void remove(Overlay overlay) { bits_ &= ~(1u << unsigned(overlay)); }
    bool empty() const { return bits_ == 0; }

private:
    std::uint32_t bits_ = 0;
};

/// The quantities that arrows show; each has a scale of its own.
enum class ArrowQuantity : std::uint8_t { force, impulse, velocity, omega, momentum, angular_momentum, torque };
inline constexpr std::size_t arrow_quantity_count = 7;

/// A point of a body whose path is drawn.
struct TrailPoint {
    std::size_t body = 0;
    Vec3 point = Vec3::Zero();     // body frame, from the body's origin, m
    std::optional<Color> color{};  // of the path; empty: a light one of the body's
};

enum class PlotPlace : std::uint8_t { inset, beside, below };

/// Text over the frames in the time span [start, end), s.
struct Caption {
    std::string text;
    double start = 0.0;
    double end = std::numeric_limits<double>::infinity();
};

struct OverlayDescription {
    OverlaySet show;
    std::vector<std::size_t> bodies;  // that overlays show; empty: all visible ones that move
    double start = 0.0;               // s: overlays are shown in [start, end); title, clock and captions always
    double end = std::numeric_limits<double>::infinity();
    double impulse_time = 0.25;                                   // s that an impulse stays visible
    double trail_time = std::numeric_limits<double>::infinity();  // s of the path that stay visible
    std::vector<TrailPoint> trail_points;                         // empty: centers of mass
    int ghost_every = 10;                                         // frames between two ghosts
    bool legend = true;
    std::array<std::optional<double>, arrow_quantity_count> scale;  // m per SI unit; empty: found from the clip
    std::array<std::optional<Color>, arrow_quantity_count> color;
    std::string plot;  // quantities, separated by commas; empty: no plot
    PlotPlace plot_place = PlotPlace::inset;
    std::vector<Caption> captions;
    std::optional<double> fade_in, fade_out;  // s of the clip, from black at its start and to black at its end
    std::vector<LabelDescription> labels;
    std::optional<LogoDescription> logo;
};

}  // namespace tumble

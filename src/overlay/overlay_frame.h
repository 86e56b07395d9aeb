// The shapes that overlays draw in one frame, without pixels. Positions are in the world frame, m; sizes on the screen
// are in units of a picture `style::unit_height` pixels high.
#pragma once

#include "core/color.h"
#include "core/vector.h"
#include "overlay/overlay_style.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// Pixels of a unit of sizes on the screen. In small pictures shapes stay thick and text stays readable.
inline double overlay_unit(int height) { return std::max(height / style::unit_height, style::least_unit); }

/// How a shape is seen: its color, its opacity (0 to 1), and whether bodies in front of it make it faint.
struct OverlayPaint {
    Color color;
    float opacity = 1.0f;
    bool depth_tested = true;
    float allowance = 0.0f;  // m: surfaces that are nearer by less, such as those of its own body, do not hide it
};

struct OverlayArrow {
    Vec3 from, to;
    OverlayPaint paint;
    float width = 3.0f;        // of the shaft
    bool double_head = false;  // of axial vectors
};

/// A line through points with round joints.
struct OverlayLine {
    std::vector<Vec3> points;
    OverlayPaint paint;
    float width = 2.0f;
};

enum class MarkerShape : std::uint8_t { disc, ring, square, diamond, cross, center_of_mass };

struct OverlayMarker {
    Vec3 at;
    OverlayPaint paint;
    MarkerShape shape = MarkerShape::disc;
    float radius = 4.0f;
};

/// The surface of a body at a pose: a ghost, shaded, or a tint over the body itself.
struct OverlaySurface {
    std::size_t body = 0;
    Vec3 origin;
    Quat orientation;
    OverlayPaint paint;
    bool shaded = false;
};

struct OverlayLabel {
    Vec3 at;  // below the middle of the text
    OverlayPaint paint;
    std::string text;
    float size = 15.0f;
};

/// Text in a box beside a point, with a line to it. It is moved so that it stays in the picture and off others before
/// it.
struct OverlayCallout {
    Vec3 of;            // the point
    Vec3 at;            // below the middle of the text
    float lift = 0.0f;  // of the text above that
    std::string text;   // lines
    float size = 20.0f;
    Color color;
    bool leader = true;
};

/// In the order of drawing.
struct OverlayFrame {
    std::vector<OverlaySurface> surfaces;
    std::vector<OverlayLine> lines;
    std::vector<OverlayArrow> arrows;
    std::vector<OverlayMarker> markers;
    std::vector<OverlayLabel> labels;
    std::vector<OverlayCallout> callouts;
    bool legend = false;                 // the legend is shown
    std::optional<std::int64_t> damage;  // the dirty regions are outlined; the frame's number: they differ each time

    void clear() { *this = {}; }
};

/// The frame as bytes, for another process of this program; equal frames have equal bytes.
void write_bytes(const OverlayFrame& frame, std::vector<std::byte>& bytes);
/// Precondition: bytes of write_bytes().
void read_bytes(std::span<const std::byte> bytes, OverlayFrame& frame);

}  // namespace tumble

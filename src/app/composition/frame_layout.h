// The places of panels, labels, text and plot in a frame.
#pragma once

#include "core/image.h"
#include "scene/description/overlay.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// automatic: a row of up to three panels, a grid of more.
enum class PanelArrangement : std::uint8_t { automatic, row, grid };

struct LayoutRequest {
    int width = 0, height = 0;  // of the frame, pixels
    std::size_t panels = 1;
    PanelArrangement arrangement = PanelArrangement::automatic;
    bool header = false;            // title or clock above several panels
    bool captions = false;          // below several panels
    bool footer = false;            // mode below several panels
    bool clock = false;             // in the corner of an inset plot
    std::optional<PlotPlace> plot;  // empty: no plot; an inset would hide a panel of several: it is below them
    std::size_t plot_panels = 1;    // axes in the plot
};

struct FrameLayout {
    std::vector<Rectangle> panels, labels;  // labels: above each panel; empty for a single one
    Rectangle header, captions, footer;     // above and below several panels and their plots; empty without one
    Rectangle area;                         // of all panels
    bool plots_on_picture = false;          // as an inset
    std::vector<Rectangle> plots;           // below the panels one for each panel of the plot, otherwise a single one
};

/// Sizes of text, gaps and margins are fractions of this length, pixels.
double text_unit(int width, int height);

/// Divides the frame. Several panels have even sizes at even places and gaps between and around them. Throws InputError
/// if the frame is too small.
FrameLayout lay_out(const LayoutRequest& request);

}  // namespace tumble

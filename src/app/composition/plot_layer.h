// The plot of a clip: drawn once, but for the cursor at the frame's time.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/stamp.h"

#include <optional>
#include <vector>

namespace tumble {

class PlotLayer {
public:
    explicit PlotLayer(const ClipPlot& plot);

    /// Moves the cursor to that time (s), and appends the regions that differ from those of the previous call.
    void update(double time, std::vector<Rectangle>& changed);

    /// Appends the stamps to draw, from back to front.
    void add_stamps(std::vector<const Stamp*>& stamps) const;

private:
    ClipPlot plot_;
    FigurePlaces places_;
    Stamp curves_, cursor_;
    std::optional<double> time_;  // s, of the cursor
};

}  // namespace tumble

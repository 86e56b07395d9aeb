#include "app/composition/frame_composer.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tumble {
namespace {

void copy(const Image& panel, const Rectangle& place, const Rectangle& region, Image& frame) {
    const Rectangle part = intersection(place, region);
    for (int y = part.y; y < part.y + part.height; ++y)
        std::memcpy(frame.at(part.x, y), panel.at(part.x - place.x, y - place.y), 4 * std::size_t(part.width));
}

}  // namespace

FrameComposer::FrameComposer(const Composition& composition, bool transparent)
    : background_(transparent ? 0 : 255), text_(composition), frame_(composition.width, composition.height) {
    for (const ClipPanel& panel : composition.panels) places_.push_back(panel.place);
    for (const ClipPlot& plot : composition.plots) plots_.emplace_back(plot);
}

void FrameComposer::compose(std::span<const PanelImage> panels, double time) {
    changed_.clear();
    for (std::size_t i = 0; i < panels.size(); ++i)
        for (const Rectangle& r : panels[i].changed)
            changed_.push_back({places_[i].x + r.x, places_[i].y + r.y, r.width, r.height});
    text_.update(time, changed_);
    for (PlotLayer& plot : plots_) plot.update(time, changed_);
    if (std::exchange(first_, false)) changed_.assign(1, {0, 0, frame_.width, frame_.height});

    std::vector<const Stamp*> stamps;
    for (const PlotLayer& plot : plots_) plot.add_stamps(stamps);
    text_.add_stamps(stamps);
    // Each region is made completely, so that regions may overlap.
    for (const Rectangle& region : changed_) {
        restore(panels, region);
        for (const Stamp* stamp : stamps) stamp->blend(frame_, region);
    }
}

/// The region without text and plot.
void FrameComposer::restore(std::span<const PanelImage> panels, const Rectangle& region) {
    const auto holds = [&](const Rectangle& place) { return intersection(place, region) == region; };
    if (std::ranges::none_of(places_, holds))
        for (int y = region.y; y < region.y + region.height; ++y)
            std::memset(frame_.at(region.x, y), background_, 4 * std::size_t(region.width));
    for (std::size_t i = 0; i < panels.size(); ++i) copy(panels[i].image, places_[i], region, frame_);
}

}  // namespace tumble

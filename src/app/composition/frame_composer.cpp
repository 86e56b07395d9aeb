#include "app/composition/frame_composer.h"

#include "app/composition/stamp.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace tumble {
namespace {

void copy(const Image& panel, const Rectangle& place, const Rectangle& region, Image& frame) {
    const Rectangle part = intersection(place, region);
    for (int y = part.y; y < part.y + part.height; ++y)
        std::memcpy(frame.at(part.x, y), panel.at(part.x - place.x, y - place.y), 4 * std::size_t(part.width));
}

/// A line inside the edges of the place.
Stamp border_of(const ClipInset& inset) {
    Stamp stamp{inset.place, Image(inset.place.width, inset.place.height)};
    const int width = stamp.box.width, height = stamp.box.height;
    const Color color = inset.border_color;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool line = std::min({x, y, width - 1 - x, height - 1 - y}) < inset.border;
            const std::uint8_t pixel[4] = {color.r, color.g, color.b, std::uint8_t(line ? 255 : 0)};
            std::memcpy(stamp.pixels.at(x, y), pixel, 4);
        }
    return stamp;
}

}  // namespace

PlotLayer::PlotLayer(const ClipPlot& plot) : plot_(plot) {
    const double width = plot.place.width, height = plot.place.height;
    Canvas canvas(plot.place.width, plot.place.height, 1.0);
    places_ = draw(plot.figure, canvas, {0.0, 0.0, width, height});
    curves_ = {plot.place, canvas.image()};
}

void PlotLayer::update(double time, std::vector<Rectangle>& changed) {
    if (time_ == time) return;
    if (time_) changed.push_back(cursor_.box);
    time_ = time;
    const double reach = cursor_dot * plot_.figure.text_size + 1.0;
    const double left = std::floor(places_.x_of(time) - reach);
    const Rectangle strip{plot_.place.x + int(left), plot_.place.y, int(std::ceil(2.0 * reach)) + 1,
                          plot_.place.height};
    cursor_.box = intersection(strip, plot_.place);
    if (cursor_.box.width == 0) return;
    Canvas canvas(cursor_.box.width, cursor_.box.height, 1.0);
    draw_cursor(plot_.figure, places_, time, canvas, {double(cursor_.box.x - plot_.place.x), 0.0});
    cursor_.pixels = canvas.image();
    changed.push_back(cursor_.box);
}

void PlotLayer::add_stamps(std::vector<const Stamp*>& stamps) const {
    stamps.push_back(&curves_);
    stamps.push_back(&cursor_);
}

FrameComposer::FrameComposer(const Composition& composition, bool transparent)
    : background_(transparent ? 0 : 255),
      text_(composition),
      frame_(composition.width, composition.height),
      transparent_(transparent),
      fade_(composition.fade) {
    if (!fade_.empty()) faded_ = frame_;
    for (const ClipPanel& panel : composition.panels) places_.push_back(panel.place);
    for (const ClipInset& inset : composition.insets) insets_.push_back({inset.place, border_of(inset)});
    for (const ClipPlot& plot : composition.plots) plots_.emplace_back(plot);
    if (const auto& logo = composition.logo)
        logo_ = {logo->place, scaled_image(logo->logo.image->levels.front(), logo->place.width, logo->place.height,
                                           logo->logo.opacity)};
}

void FrameComposer::change_insets(std::span<const std::optional<PanelImage>> insets) {
    for (std::size_t i = 0; i < insets.size(); ++i) {
        Inset& inset = insets_[i];
        const bool shown = insets[i].has_value();
        if (std::exchange(inset.shown, shown) != shown) {
            changed_.push_back(inset.place);
            continue;
        }
        if (!shown) continue;
        for (const Rectangle& r : insets[i]->changed)
            changed_.push_back({inset.place.x + r.x, inset.place.y + r.y, r.width, r.height});
    }
}

void FrameComposer::compose(std::span<const PanelImage> panels, std::span<const std::optional<PanelImage>> insets,
                            double time) {
    changed_.clear();
    for (std::size_t i = 0; i < panels.size(); ++i)
        for (const Rectangle& r : panels[i].changed)
            changed_.push_back({places_[i].x + r.x, places_[i].y + r.y, r.width, r.height});
    change_insets(insets);
    text_.update(time, changed_);
    for (PlotLayer& plot : plots_) plot.update(time, changed_);
    if (std::exchange(first_, false)) changed_.assign(1, {0, 0, frame_.width, frame_.height});

    std::vector<const Stamp*> stamps;
    for (const Inset& inset : insets_)
        if (inset.shown) stamps.push_back(&inset.border);
    for (const PlotLayer& plot : plots_) plot.add_stamps(stamps);
    text_.add_stamps(stamps);
    if (logo_) stamps.push_back(&*logo_);
    // Each region is made completely, so that regions may overlap.
    for (const Rectangle& region : changed_) {
        restore(panels, insets, region);
        for (const Stamp* stamp : stamps) stamp->blend(frame_, region);
    }
    if (!fade_.empty()) fade(time);
}

/// Darkens the whole frame, or makes a transparent one more so.
void FrameComposer::fade(double time) {
    const int before = std::exchange(share_, fade_.share_at(time));
    if (share_ != before) changed_.assign(1, {0, 0, frame_.width, frame_.height});
    if (share_ == 256) return;
    for (const Rectangle& region : changed_)
        for (int y = region.y; y < region.y + region.height; ++y) {
            const std::uint8_t* from = frame_.at(region.x, y);
            std::uint8_t* to = faded_.at(region.x, y);
            for (int i = 0; i < 4 * region.width; ++i)
                to[i] = (i % 4 == 3) == transparent_ ? std::uint8_t((from[i] * share_ + 128) >> 8) : from[i];
        }
}

/// The region without text and plot.
void FrameComposer::restore(std::span<const PanelImage> panels, std::span<const std::optional<PanelImage>> insets,
                            const Rectangle& region) {
    const auto holds = [&](const Rectangle& place) { return intersection(place, region) == region; };
    if (std::ranges::none_of(places_, holds))
        for (int y = region.y; y < region.y + region.height; ++y)
            std::memset(frame_.at(region.x, y), background_, 4 * std::size_t(region.width));
    for (std::size_t i = 0; i < panels.size(); ++i) copy(panels[i].image, places_[i], region, frame_);
    for (std::size_t i = 0; i < insets.size(); ++i)
        if (insets[i]) copy(insets[i]->image, insets_[i].place, region, frame_);
}

}  // namespace tumble

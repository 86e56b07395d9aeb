// Makes frames from the images of their panels, with text and plot. Only changed regions are made anew: a frame is the
// same to the last byte whichever frame was composed before it.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/stamp.h"
#include "app/composition/text_layer.h"
#include "core/image.h"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

struct PanelImage {
    const Image& image;
    const std::vector<Rectangle>& changed;  // where it may differ from the image of the previous frame
};

/// The plot of a clip: drawn once, but for the cursor at the frame's time.
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

class FrameComposer {
public:
    /// `transparent`: the space around panels is; otherwise it is white.
    FrameComposer(const Composition& composition, bool transparent);

    /// Composes the frame of that time (s). `insets`: one for each of the composition, empty where it is not shown.
    void compose(std::span<const PanelImage> panels, std::span<const std::optional<PanelImage>> insets, double time);
    void compose(std::span<const PanelImage> panels, double time) { compose(panels, {}, time); }

    /// The image of the last compose().
    const Image& image() const { return share_ < 256 ? faded_ : frame_; }
    /// The regions in which the image may differ from the previous one.
    const std::vector<Rectangle>& changed() const { return changed_; }

private:
    /// An inset over its panel.
    struct Inset {
        Rectangle place;
        Stamp border;
        bool shown = false;  // in the frame before
    };
    void change_insets(std::span<const std::optional<PanelImage>> insets);
    void restore(std::span<const PanelImage> panels, std::span<const std::optional<PanelImage>> insets,
                 const Rectangle& region);
    void fade(double time);

    std::uint8_t background_;        // around panels, of all four channels
    std::vector<Rectangle> places_;  // of the panels
    std::vector<Inset> insets_;
    std::optional<Stamp> logo_;
    TextLayer text_;
    std::vector<PlotLayer> plots_;
    Image frame_;
    bool transparent_;
    ClipFade fade_;
    int share_ = 256;    // of the frame that is left, in parts of 256
    Image faded_;        // empty where the clip does not fade
    bool first_ = true;  // no frame yet
    std::vector<Rectangle> changed_;
};

}  // namespace tumble

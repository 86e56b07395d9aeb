// Composition of a clip's frames: the panels with their scenes, and the text and plot over and around them. Plain
// values, made once before drawing; the frame composer (frame_composer.h) draws by them in each render process.
#pragma once

#include "core/image.h"
#include "overlay/overlay_painter.h"
#include "plot/figure.h"
#include "scene/description/description.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A region of the frame that shows one scene.
struct ClipPanel {
    std::shared_ptr<const SceneDescription> scene;  // its output size is that of the place
    Rectangle place;
    std::optional<PanelOverlay> overlay{};  // empty: nothing is drawn over the scene
};

/// A picture of the motion of a panel by another camera, over it.
struct ClipInset {
    std::size_t panel = 0;
    std::shared_ptr<const SceneDescription> scene;  // with that camera alone; its output size is that of the place
    Rectangle place;
    int border = 0;  // pixels, inside the place
    Color border_color;
    double start = 0.0, end = 0.0;  // s

    bool shown(double time) const { return start <= time && time < end; }
    ClipPanel as_panel() const { return {scene, place}; }
};

/// A picture over the frame.
struct ClipLogo {
    LogoDescription logo;
    Rectangle place;
};

/// A line of text above a panel.
struct ClipLabel {
    std::string text;
    Rectangle place;
};

/// The text of the whole clip. Empty strings and lists are not shown.
struct ClipText {
    std::string title, mode;
    bool clock = false;
    double last_time = 0.0;  // s, of the last frame: the clock has space for it
    std::vector<Caption> captions;
    Rectangle area;    // of the panels: title and clock stand at its top, captions and mode at its bottom
    Rectangle header;  // for title and clock, if not empty
    Rectangle band;    // for captions, if not empty
    Rectangle footer;  // for the mode, if not empty

    std::optional<int> title_end;  // pixels from the left: a plot is to the right of it

    bool empty() const { return title.empty() && mode.empty() && !clock && captions.empty(); }
};

/// Curves of the whole run, with a cursor at the frame's time.
struct ClipPlot {
    Figure figure;
    Rectangle place;
};

/// From black at the start of the clip, and to black at its end.
struct ClipFade {
    double in = 0.0, out = 0.0;  // s; 0: none
    double last_time = 0.0;      // s, of the last frame

    bool empty() const { return in <= 0.0 && out <= 0.0; }
    /// Share of the frame that is left at the time (s), in parts of 256.
    int share_at(double time) const;
};

struct Composition {
    Composition() = default;
    /// One panel, which is the whole frame. The scene must outlive it.
    Composition(const SceneDescription& scene);  // NOLINT: a scene is the simplest composition

    /// True if each frame is the image of the only panel.
    bool plain() const {
        return panels.size() == 1 && insets.empty() && text.empty() && plots.empty() && !logo && fade.empty();
    }
    /// True if the text, the plot or the shown insets may differ between two times, s.
    bool changes(double from, double to) const;

    int width = 0, height = 0;  // of the frame, pixels
    std::vector<ClipPanel> panels;
    std::vector<ClipInset> insets;
    std::vector<ClipLabel> labels;
    ClipText text;
    std::vector<ClipPlot> plots;
    std::optional<ClipLogo> logo;
    ClipFade fade;
    std::shared_ptr<const SceneDescription> aov_scene;  // the scene at the size of the AOVs
};

/// "t = 1.234 s".
std::string clock_text_at(double time);

/// Captions that are shown at the time (s), in order.
std::vector<const Caption*> captions_at(const std::vector<Caption>& captions, double time);

}  // namespace tumble

// The text of a clip: labels, title, clock, mode and captions. Each piece is set once while it stays the same.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/stamp.h"

#include <string>
#include <vector>

namespace tumble {

class TextLayer {
public:
    explicit TextLayer(const Composition& composition);

    /// Sets the text of that time (s), and appends the regions where it differs from that of the previous call.
    void update(double time, std::vector<Rectangle>& changed);

    /// Appends the stamps to draw, from back to front.
    void add_stamps(std::vector<const Stamp*>& stamps) const;

private:
    void set_title(const Rectangle& head);
    void set_mode(const Rectangle& area);
    void set_clock(double time, std::vector<Rectangle>& changed);
    void set_captions(double time, std::vector<Rectangle>& changed);

    ClipText text_;
    double unit_;
    std::vector<Stamp> fixed_;  // labels, title, mode
    TextBox clock_box_, caption_box_;
    std::string clock_text_;
    std::vector<const Caption*> shown_captions_;
    std::vector<Stamp> clock_, captions_;  // at most one clock
};

}  // namespace tumble

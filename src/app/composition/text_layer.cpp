#include "app/composition/text_layer.h"

#include "app/composition/frame_layout.h"

#include <algorithm>

namespace tumble {
namespace {

// Fractions of the text unit.
constexpr double title_size = 0.046, clock_size = 0.036, mode_size = 0.022, caption_size = 0.04, label_size = 0.034;
constexpr double text_margin = 0.03, stack_gap = 0.012;
// Fractions of the area.
constexpr double most_title = 0.3, most_captions = 0.45, caption_width = 0.86, most_clock = 0.4;
constexpr Color on_margin{34, 38, 46}, faint{104, 110, 122};

Rectangle inset_by(const Rectangle& area, int margin) {
    const int across = std::min(margin, (area.width - 1) / 2), down = std::min(margin, (area.height - 1) / 2);
    return {area.x + across, area.y + down, area.width - 2 * across, area.height - 2 * down};
}

}  // namespace

TextLayer::TextLayer(const Composition& composition)
    : text_(composition.text), unit_(text_unit(composition.width, composition.height)) {
    for (const ClipLabel& label : composition.labels)
        fixed_.push_back(set_text(label.text, {label.place, 0.0, 0.5, label_size * unit_, on_margin, true, false, {}}));
    const Rectangle area = inset_by(text_.area, int(text_margin * unit_));
    const bool on_picture = text_.header.width == 0;
    Rectangle head = on_picture ? area : text_.header;
    if (on_picture) head.height = std::max(1, int(most_title * area.height));
    const Color color = on_picture ? TextBox{}.color : on_margin;
    clock_box_ = {head, 1.0, on_picture ? 0.0 : 0.5, clock_size * unit_, color, false, on_picture, {}};
    if (text_.clock) {
        clock_box_.widest = clock_text_at(text_.last_time);
        clock_box_.area.width = std::max(1, int(most_clock * head.width));
        clock_box_.area.x = head.x + head.width - clock_box_.area.width;
    }
    if (!text_.title.empty()) set_title(head);
    caption_box_ = {area, 0.5, 1.0, caption_size * unit_, TextBox{}.color, false, true, {}};
    if (!text_.mode.empty()) set_mode(area);
    if (text_.band.width > 0) {
        caption_box_ = {text_.band, 0.5, 0.5, caption_size * unit_, on_margin, false, false, {}};
        return;
    }
    const int width = std::max(1, int(caption_width * area.width));
    const int height = std::min(std::max(1, int(most_captions * area.height)), caption_box_.area.height);
    Rectangle& box = caption_box_.area;
    box = {area.x + (area.width - width) / 2, box.y + box.height - height, width, height};
}

/// Left of the clock.
void TextLayer::set_title(const Rectangle& head) {
    TextBox box = clock_box_;
    box.across = 0.0;
    box.size = title_size * unit_;
    box.bold = true;
    box.widest.clear();
    box.area = head;
    if (text_.clock) {
        const int clock = set_text(clock_box_.widest, clock_box_).box.width + int(2.0 * stack_gap * unit_);
        box.area.width = std::max(1, head.width - clock);
    }
    if (text_.title_end) {
        const int end = *text_.title_end - int(stack_gap * unit_);
        box.area.width = std::clamp(end - head.x, 1, box.area.width);
    }
    fixed_.push_back(set_text(text_.title, box));
}

/// Below everything, or at the bottom of the area, where captions stand above it.
void TextLayer::set_mode(const Rectangle& area) {
    if (text_.footer.width > 0) {
        fixed_.push_back(set_text(text_.mode, {text_.footer, 0.0, 0.5, mode_size * unit_, faint, false, false, {}}));
        return;
    }
    TextBox box = caption_box_;
    box.across = 0.0;
    box.size = mode_size * unit_;
    fixed_.push_back(set_text(text_.mode, box));
    caption_box_.area.height = std::max(1, fixed_.back().box.y - int(stack_gap * unit_) - area.y);
}

void TextLayer::update(double time, std::vector<Rectangle>& changed) {
    if (text_.clock) set_clock(time, changed);
    set_captions(time, changed);
}

void TextLayer::set_clock(double time, std::vector<Rectangle>& changed) {
    std::string text = clock_text_at(time);
    if (text == clock_text_) return;
    clock_text_ = std::move(text);
    for (const Stamp& old : clock_) changed.push_back(old.box);
    clock_.assign(1, set_text(clock_text_, clock_box_));
    changed.push_back(clock_.front().box);
}

/// From the bottom up, the last one lowest.
void TextLayer::set_captions(double time, std::vector<Rectangle>& changed) {
    std::vector<const Caption*> shown = captions_at(text_.captions, time);
    if (shown == shown_captions_) return;
    shown_captions_ = std::move(shown);
    for (const Stamp& old : captions_) changed.push_back(old.box);
    captions_.clear();
    TextBox box = caption_box_;
    int bottom = box.area.y + box.area.height;
    box.area.height = std::max(1, box.area.height / int(std::max<std::size_t>(1, shown_captions_.size())));
    for (std::size_t i = shown_captions_.size(); i-- > 0;) {
        box.area.y = bottom - box.area.height;
        captions_.push_back(set_text(shown_captions_[i]->text, box));
        changed.push_back(captions_.back().box);
        bottom = captions_.back().box.y - int(stack_gap * unit_);
    }
}

void TextLayer::add_stamps(std::vector<const Stamp*>& stamps) const {
    for (const auto* pieces : {&fixed_, &captions_, &clock_})
        for (const Stamp& stamp : *pieces) stamps.push_back(&stamp);
}

}  // namespace tumble

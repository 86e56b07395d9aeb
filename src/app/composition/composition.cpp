#include "app/composition/composition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {

Composition::Composition(const SceneDescription& scene)
    : width(scene.output.width),
      height(scene.output.height),
      panels{{std::shared_ptr<const SceneDescription>(std::shared_ptr<void>(), &scene), {0, 0, width, height}}},
      aov_scene(panels[0].scene) {}

bool Composition::changes(double from, double to) const {
    if (from == to) return false;
    const auto comes_or_goes = [&](const ClipInset& inset) { return inset.shown(from) != inset.shown(to); };
    return !plots.empty() || std::ranges::any_of(insets, comes_or_goes) || fade.share_at(from) != fade.share_at(to) ||
           (text.clock && clock_text_at(from) != clock_text_at(to)) ||
           captions_at(text.captions, from) != captions_at(text.captions, to);
}

int ClipFade::share_at(double time) const {
    double share = 1.0;
    if (in > 0.0) share = std::min(share, time / in);
    if (out > 0.0) share = std::min(share, (last_time - time) / out);
    return int(std::lround(256.0 * std::clamp(share, 0.0, 1.0)));
}

std::string clock_text_at(double time) { return fmt::format("t = {:.3f} s", time); }

std::vector<const Caption*> captions_at(const std::vector<Caption>& captions, double time) {
    std::vector<const Caption*> shown;
    for (const Caption& caption : captions)
        if (caption.start <= time && time < caption.end) shown.push_back(&caption);
    return shown;
}

}  // namespace tumble

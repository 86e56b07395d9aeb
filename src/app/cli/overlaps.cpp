#include "app/cli/overlaps.h"

#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

constexpr double named_share = 0.01;   // of the smaller body's thickness: more than hand-written numbers round
constexpr std::size_t most_lines = 6;  // the others are counted

}  // namespace

std::string overlap_warning(const SceneDescription& scene, const World& world) {
    std::vector<Overlap> overlaps = world.overlaps();
    std::erase_if(overlaps, [](const Overlap& overlap) { return overlap.share <= named_share; });
    if (overlaps.empty()) return "";
    std::string lines;
    for (std::size_t i = 0; i < std::min(overlaps.size(), most_lines); ++i) {
        const Overlap& o = overlaps[i];
        lines += fmt::format(
            "warning: bodies '{}' and '{}' overlap by {:.3g} m at the start, {:.3g} % of the smaller one's thickness\n",
            safe_text(scene.bodies[o.a].name), safe_text(scene.bodies[o.b].name), o.depth, 100.0 * o.share);
    }
    if (overlaps.size() > most_lines)
        lines += fmt::format("warning: {} more pairs of bodies overlap at the start\n", overlaps.size() - most_lines);
    return lines + "         contact pushes them apart, which gives them energy: move them, or join them\n";
}

}  // namespace tumble

#include "render/aov/aov_kind.h"

namespace tumble {
namespace {

constexpr std::array<std::string_view, all_aovs.size()> names = {"depth", "normal", "segmentation", "motion", "albedo"};

}  // namespace

std::string_view name_of(Aov aov) { return names[static_cast<std::size_t>(aov)]; }

std::optional<Aov> aov_named(std::string_view name) {
    for (const Aov aov : all_aovs)
        if (name == name_of(aov)) return aov;
    return std::nullopt;
}

std::string names_of(const AovSet& aovs) {
    std::string text;
    for (const Aov aov : all_aovs) {
        if (!aovs.has(aov)) continue;
        if (!text.empty()) text += ", ";
        text += name_of(aov);
    }
    return text;
}

}  // namespace tumble

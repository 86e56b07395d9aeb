#include "app/clip/drawing_settings.h"

#include <fmt/format.h>

#include <string>

namespace tumble {

NamedValues drawing_settings(const ClipRequest& request, const DrawingChoices& choices,
                             const Composition& composition) {
    const auto yes = [](bool value) { return std::string(value ? "yes" : "no"); };
    NamedValues settings{{"size", fmt::format("{}x{}", composition.width, composition.height)},
                         {"speed", fmt::format("{}", request.speed)},
                         {"shutter", fmt::format("{}", choices.shutter)},
                         {"transparent", yes(choices.transparent)},
                         {"gl", choices.backend == GlBackend::egl ? "egl" : "osmesa"}};
    if (choices.shutter > 0.0) settings.emplace_back("blur samples", fmt::format("{}", choices.blur_samples));
    if (request.scenes.size() > 1 || !request.vary.empty())
        settings.emplace_back("layout", request.arrangement == PanelArrangement::row    ? "row"
                                        : request.arrangement == PanelArrangement::grid ? "grid"
                                                                                        : "automatic");
    return settings;
}

FrameIdentity identity_of_aovs(FrameIdentity pictures, const AovSet& aovs) {
    pictures.settings.emplace_back("AOVs", names_of(aovs));
    return pictures;
}

}  // namespace tumble

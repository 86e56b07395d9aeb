#include "page/environment_data.h"

#include "page/prediction.h"
#include "scene/environment/irradiance.h"
#include "scene/environment/mirror_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

using Json = ArrayStore::Json;

constexpr double light_steps = 2047.0;  // of the square root of light: less than a level on the screen
constexpr int most_background = 512;    // texels around
constexpr float brightest = 16.0f;      // more is white on the screen, and would leave dark colors few steps

/// Texels with at least three channels.
template <class Texel>
Json light_json(int width, int height, const std::vector<Texel>& texels, ArrayStore& arrays) {
    float most = 1e-6f;
    for (const Texel& texel : texels) most = std::max({most, texel[0], texel[1], texel[2]});
    most = std::min(most, brightest);
    Json channels = Json::array();
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<std::int64_t> values;
        values.reserve(texels.size());
        for (const Texel& texel : texels)
            values.push_back(std::llround(light_steps * std::sqrt(std::clamp(double(texel[c]) / most, 0.0, 1.0))));
        const int order = predict(values);
        channels.push_back({order, arrays.add(values)});
    }
    return {{"width", width},
            {"height", height},
            {"most", most},
            {"steps", light_steps},
            {"channels", std::move(channels)}};
}

EnvironmentImage halved(const EnvironmentImage& image) {
    EnvironmentImage half{image.width / 2, std::max(image.height / 2, 1), {}};
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            auto& texel = half.texels.emplace_back();
            const int lower = std::min(2 * y + 1, image.height - 1);
            for (std::size_t c = 0; c < 3; ++c)
                texel[c] = 0.25f * (image.at(2 * x, 2 * y)[c] + image.at(2 * x + 1, 2 * y)[c] +
                                    image.at(2 * x, lower)[c] + image.at(2 * x + 1, lower)[c]);
        }
    return half;
}

}  // namespace

Json make_environment(const EnvironmentDescription& environment, ArrayStore& arrays) {
    constexpr const char* names[] = {"sky", "colors", "image"};
    Json json{{"background", names[std::size_t(environment.background)]},
              {"low", to_linear(environment.low)},
              {"high", to_linear(environment.high)},
              {"sun", environment.sun},
              {"shift", environment.rotation / 360.0},
              {"ground_shadow", environment.ground_shadow}};
    if (!environment.image) return json;
    json["around"] = irradiance_of(environment);
    json["mirror"] = light_json(MirrorMap::width, MirrorMap::height, make_mirror_map(environment).texels, arrays);
    if (environment.background != BackgroundKind::image) return json;
    EnvironmentImage image = blurred_background(environment);
    while (image.width > most_background) image = halved(image);
    json["image"] = light_json(image.width, image.height, image.texels, arrays);
    return json;
}

}  // namespace tumble

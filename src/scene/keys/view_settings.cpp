#include "scene/keys/view_settings.h"

#include "scene/toml/limits.h"

namespace tumble {

LightDescription read_light(const TomlTable& root) {
    LightDescription light;
    if (const auto table = root.find_table("light")) {
        table->expect_keys({"direction", "shadows"});
        if (const auto value = table->find("direction")) light.direction = value->direction();
        table->read("shadows", light.shadows);
    }
    return light;
}

std::optional<WindDescription> read_wind(const TomlTable& root) {
    const auto table = root.find_table("wind");
    if (!table) return std::nullopt;
    WindDescription wind;
    table->expect_keys({"velocity", "density", "drag"});
    table->read("velocity", wind.velocity, limits::velocity);
    table->read("density", wind.density, limits::air_density);
    table->read("drag", wind.drag, limits::drag);
    return wind;
}

}  // namespace tumble

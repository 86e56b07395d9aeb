#include "scene/mesh/mtl_file.h"

#include "core/color.h"
#include "scene/mesh/mesh_text.h"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

constexpr float hole = 0.5f;  // less alpha of an image is a hole

std::array<float, 3> color_of(TextTokens& tokens) {
    std::array<float, 3> color{};
    const std::size_t line = tokens.line();
    const std::string_view first = tokens.token();
    if (first == "spectral" || first == "xyz") return {0.5f, 0.5f, 0.5f};
    color.fill(linear_channel(mesh_number(first, line)));
    for (std::size_t c = 1; c < 3; ++c)
        if (const std::string_view token = tokens.token(); !token.empty())
            color[c] = linear_channel(mesh_number(token, line));
    return color;
}

/// The name of the file of a map, behind its options, each of which has numbers or one word.
std::string map_file(TextTokens& tokens, MeshMaterial& material) {
    std::string name;
    for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token()) {
        if (name.empty() && token.size() > 1 && token[0] == '-') {
            const std::string_view option = token;
            const int values = option == "-mm" ? 2 : option == "-o" || option == "-s" || option == "-t" ? 3 : 1;
            for (int i = 0; i < values; ++i) {
                const std::string_view value = tokens.token();
                if (option == "-clamp" && value == "on") material.wrap_u = material.wrap_v = TextureWrap::clamp;
            }
            continue;
        }
        if (!name.empty()) name += ' ';
        name += token;
    }
    return name;
}

}  // namespace

float linear_channel(float srgb) { return float(srgb_to_linear(std::clamp(double(srgb), 0.0, 1.0))); }

void read_mtl(std::string_view text, MeshImages& images, std::map<std::string, MeshMaterial, std::less<>>& materials) {
    TextTokens tokens(text);
    MeshMaterial* material = nullptr;
    do {
        const std::string_view keyword = tokens.token();
        if (keyword == "newmtl") material = &(materials[rest_of_line(tokens)] = {});
        if (material == nullptr) continue;
        const std::size_t line = tokens.line();
        if (keyword == "Kd") material->color = color_of(tokens);
        if (keyword == "Ke") material->emission = color_of(tokens);
        if (keyword == "Pr") material->roughness = std::clamp(mesh_number(tokens.token(), line), 0.0f, 1.0f);
        if (keyword == "Pm") material->metallic = std::clamp(mesh_number(tokens.token(), line), 0.0f, 1.0f);
        if (keyword == "map_Kd") {
            material->texture = images.texture(map_file(tokens, *material));
            if (material->texture) material->cutoff = hole;
        }
    } while (tokens.next_line());
    for (auto& [name, one] : materials)
        if (one.texture && one.color == std::array<float, 3>{})
            one.color = {1.0f, 1.0f, 1.0f};  // a black Kd is no factor
}

}  // namespace tumble

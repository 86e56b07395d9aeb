#include "scene/mesh/mesh_readers.h"

#include "core/color.h"
#include "scene/mesh/mesh_text.h"
#include "scene/mesh/texture_image.h"

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
std::string map_file(TextTokens& tokens, MeshMaterial& material, float* bump_strength = nullptr) {
    std::string name;
    for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token()) {
        if (name.empty() && token.size() > 1 && token[0] == '-') {
            const std::string_view option = token;
            const int values = option == "-mm" ? 2 : option == "-o" || option == "-s" || option == "-t" ? 3 : 1;
            for (int i = 0; i < values; ++i) {
                const std::string_view value = tokens.token();
                if (option == "-bm" && bump_strength) *bump_strength = mesh_number(value, tokens.line());
                if (option == "-clamp" && value == "on") material.wrap_u = material.wrap_v = TextureWrap::clamp;
            }
            continue;
        }
        if (!name.empty()) name += ' ';
        name += token;
    }
    return name;
}

bool is_bump(std::string_view keyword) { return keyword == "map_Bump" || keyword == "map_bump" || keyword == "bump"; }

/// `d -halo 0.5` too.
float opacity_of(TextTokens& tokens) {
    const std::size_t line = tokens.line();
    std::string_view token = tokens.token();
    if (token == "-halo") token = tokens.token();
    return mesh_number(token, line);
}

/// A map of heights, or of normals, which many programs write as a bump.
void read_relief(TextTokens& tokens, MeshImages& images, bool normals, MeshMaterial& material) {
    constexpr float strength_of_one = 4.0f;  // texels that white is above black
    float strength = 1.0f;
    const auto map = images.map(map_file(tokens, material, &strength));
    if (!map || (material.maps.normal && !normals)) return;
    material.maps.normal = is_gray(*map) ? normals_of_heights(*map, strength_of_one * strength) : map;
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
        if (keyword == "d") material->opacity = std::clamp(opacity_of(tokens), 0.0f, 1.0f);
        if (keyword == "Tr") material->opacity = 1.0f - std::clamp(opacity_of(tokens), 0.0f, 1.0f);
        if (keyword == "norm" || is_bump(keyword)) read_relief(tokens, images, keyword == "norm", *material);
        if (keyword == "map_Ke") material->maps.emission = images.texture(map_file(tokens, *material));
        if (keyword == "map_Kd") {
            material->texture = images.texture(map_file(tokens, *material));
            if (material->texture) material->cutoff = hole;
        }
    } while (tokens.next_line());
    for (auto& [name, one] : materials)
        if (one.texture && one.color == std::array<float, 3>{})
            one.color = {1.0f, 1.0f, 1.0f};  // a black Kd is no factor
    for (auto& [name, one] : materials)
        if (one.opacity == 0.0f) one.opacity = 1.0f;  // programs disagree about the sense of Tr; nothing is no body
    for (auto& [name, one] : materials)
        if (one.maps.emission && one.emission == std::array<float, 3>{}) one.emission = {1.0f, 1.0f, 1.0f};
}

}  // namespace tumble

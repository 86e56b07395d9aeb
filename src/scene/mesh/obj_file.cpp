#include "scene/mesh/mesh_readers.h"

#include "scene/mesh/mesh_images.h"
#include "scene/mesh/mesh_text.h"
#include "scene/mesh/mesh_transform.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace tumble {
namespace {

/// Calls visit(keyword, tokens) for every line that is not part of a curve or surface. A curve without an end is a
/// single line: some programs write no more.
template <class Visit>
void visit_lines(std::string_view bytes, const Visit& visit) {
    TextTokens tokens(bytes);
    bool in_curve = false;
    const std::size_t last_end = bytes.rfind("\nend");
    do {
        const std::string_view keyword = tokens.token();
        if (keyword.empty()) continue;
        if (in_curve)
            in_curve = keyword != "end";
        else if (keyword == "cstype")
            in_curve = last_end != bytes.npos && std::size_t(keyword.data() - bytes.data()) < last_end;
        else
            visit(keyword, tokens);
    } while (tokens.next_line());
}

struct Points {
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::array<float, 3>> colors;  // of positions, linear light; shorter if later ones have none
    std::vector<std::array<float, 2>> places;  // in the texture
};

/// Values behind the coordinates of a position: none, a divisor, a color, or a divisor and a color.
void finish_position(TextTokens& tokens, std::array<float, 3>& point, Points& points) {
    const std::size_t line = tokens.line();
    std::array<std::string_view, 4> more;
    std::size_t count = 0;
    for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token())
        if (count < more.size()) more[count++] = token;
    if (count == 1) {
        const float w = mesh_number(more[0], line);
        for (float& coordinate : point) coordinate /= w;
    }
    if (count >= 3) {
        points.colors.resize(points.positions.size(), {1.0f, 1.0f, 1.0f});
        std::array<float, 3> color{};
        for (std::size_t c = 0; c < 3; ++c) color[c] = linear_channel(mesh_number(more[count - 3 + c], line));
        points.colors.push_back(color);
    }
    points.positions.push_back(point);
}

Points read_points(std::string_view bytes) {
    Points points;
    visit_lines(bytes, [&](std::string_view keyword, TextTokens& tokens) {
        const std::size_t line = tokens.line();
        if (keyword == "vt") {
            const float u = mesh_number(tokens.token(), line);
            const std::string_view second = tokens.token();
            points.places.push_back({u, 1.0f - (second.empty() ? 0.0f : mesh_number(second, line))});
        }
        if (keyword != "v" && keyword != "vn") return;
        std::array<float, 3> point{};
        for (float& coordinate : point) coordinate = mesh_number(tokens.token(), line);
        if (keyword == "vn") {
            points.normals.push_back(point);
            return;
        }
        finish_position(tokens, point, points);
    });
    return points;
}

class FaceReader {
public:
    FaceReader(const Points& points, const std::filesystem::path& folder)
        : points_(points), number_(points.positions.size(), none), images_(folder) {
        mesh_.colored = !points.colors.empty();
    }

    void read_line(std::string_view keyword, TextTokens& tokens) {
        if (keyword == "v")
            ++positions_seen_;
        else if (keyword == "vn")
            ++normals_seen_;
        else if (keyword == "vt")
            ++places_seen_;
        else if (keyword == "mtllib")
            read_libraries(tokens);
        else if (keyword == "usemtl")
            use_material(rest_of_line(tokens));
        else if (keyword == "f")
            read_face(tokens);
        else if (keyword == "l" || keyword == "p")
            read_points_or_line(tokens);
        else if (keyword == "o" || keyword == "g")
            read_name(keyword, tokens.token());
    }
    MeshFile take() {
        mesh_.take(images_);
        return std::move(mesh_);
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);

    void read_name(std::string_view keyword, std::string_view name) {
        if (name.empty() || (keyword == last_keyword_ && name == last_name_)) return;
        last_keyword_ = keyword;
        last_name_ = name;
        mesh_.begin_object();
    }

    /// The line names one file, whose name may hold spaces, or several.
    void read_libraries(TextTokens& tokens) {
        const std::string line = rest_of_line(tokens);
        if (read_library(line) || line.find(' ') == line.npos) return;
        TextTokens names(line);
        for (std::string_view name = names.token(); !name.empty(); name = names.token()) read_library(name);
    }

    bool read_library(std::string_view name) {
        const std::optional<std::string> text = images_.read(name);
        if (text) read_mtl(*text, images_, materials_);
        return text.has_value();
    }

    /// Materials that the libraries do not have are none.
    void use_material(const std::string& name) {
        material_ = MeshFile::no_material;
        const auto known = materials_.find(name);
        if (known == materials_.end()) return;
        const auto [entry, is_new] = material_number_.try_emplace(name, std::uint32_t(mesh_.materials.size()));
        if (is_new) mesh_.materials.push_back(known->second);
        material_ = entry->second;
    }

    void read_face(TextTokens& tokens) {
        polygon_.clear();
        for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token()) {
            MeshFile::check_corners(polygon_.size() + 1);
            polygon_.push_back(corner(token));
        }
        mesh_.add_polygon(polygon_);
    }

    /// Points and lines count for the size of the mesh only.
    void read_points_or_line(TextTokens& tokens) {
        for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token()) corner(token);
    }

    /// POSITION, POSITION/TEXTURE, POSITION//NORMAL or POSITION/TEXTURE/NORMAL.
    MeshFile::Corner corner(std::string_view token) {
        const std::size_t first = token.find('/'), second = token.find('/', first == token.npos ? first : first + 1);
        const std::size_t v = index(token.substr(0, first), positions_seen_, points_.positions.size(), "vertex");
        MeshFile::Corner result;
        result.material = material_;
        if (v < points_.colors.size()) result.color = points_.colors[v];
        if (number_[v] == none) {  // numbered by their first use
            number_[v] = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.add_position(transform_.point(points_.positions[v]));
        }
        result.position = number_[v];
        const std::string_view place =
            first == token.npos ? std::string_view() : token.substr(first + 1, second - first - 1);
        if (!place.empty() && !points_.places.empty())
            result.uv = points_.places[index(place, places_seen_, points_.places.size(), "texture coordinate")];
        const bool names_normal = second != token.npos && second + 1 < token.size();
        if (names_normal && !points_.normals.empty()) {  // some programs name normals that they do not write
            const std::size_t n = index(token.substr(second + 1), normals_seen_, points_.normals.size(), "normal");
            result.normal = transform_.normal(points_.normals[n]);
        }
        return result;
    }

    /// Counted from 1, or from -1 backward from those read so far.
    static std::size_t index(std::string_view text, std::size_t seen, std::size_t count, const char* what) {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::int64_t from_zero = value > 0 ? value - 1 : static_cast<std::int64_t>(seen) + value;
        if (error != std::errc() || end != text.data() + text.size() || value == 0 || from_zero < 0 ||
            from_zero >= static_cast<std::int64_t>(count)) {
            throw MeshError(fmt::format("has a face with {} {} of {}", what, readable(text, 20), count));
        }
        return static_cast<std::size_t>(from_zero);
    }

    const Points& points_;
    const MeshTransform transform_;      // identity
    std::vector<std::uint32_t> number_;  // index of a position in the mesh, or none
    MeshFile mesh_;
    std::vector<MeshFile::Corner> polygon_;
    std::size_t positions_seen_ = 0, normals_seen_ = 0, places_seen_ = 0;
    MeshImages images_;
    std::map<std::string, MeshMaterial, std::less<>> materials_;
    std::map<std::string, std::uint32_t, std::less<>> material_number_;  // of those in use
    std::uint32_t material_ = MeshFile::no_material;
    std::string_view last_keyword_, last_name_;
};

}  // namespace

MeshFile read_obj(std::string_view bytes, const std::filesystem::path& folder) {
    const Points points = read_points(bytes);  // first, because a face may name a point that comes after it
    FaceReader reader(points, folder);
    visit_lines(bytes, [&](std::string_view keyword, TextTokens& tokens) { reader.read_line(keyword, tokens); });
    return reader.take();
}

}  // namespace tumble

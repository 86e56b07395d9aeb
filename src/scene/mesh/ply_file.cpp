
#include "scene/mesh/mesh_images.h"
#include "scene/mesh/mesh_readers.h"
#include "scene/toml/limits.h"
#include "scene/toml/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {
namespace {

enum class Encoding { text, little_endian, big_endian };
constexpr Choice<Encoding> encodings[] = {
    {"ascii", Encoding::text},
    {"binary_little_endian", Encoding::little_endian},
    {"binary_big_endian", Encoding::big_endian},
};

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr Choice<Type> types[] = {
    {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
    {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
    {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
    {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64},
};

constexpr std::size_t header_bytes = 64 << 10;  // a hundred elements; a longer header would only take time

struct Property {
    std::string_view name;
    Type type;
    std::optional<Type> list_count;  // type of a list's length
};
struct Element {
    std::string_view name;
    std::uint64_t count;
    std::vector<Property> properties;
};
struct Header {
    Encoding encoding = Encoding::text;
    std::vector<Element> elements;
    std::string_view texture;  // name of an image; empty: none
};

template <class Value>
Value named(std::string_view name, std::span<const Choice<Value>> choices, const char* what) {
    for (const auto& choice : choices)
        if (choice.name == name) return choice.value;
    throw MeshError(fmt::format("has a header with an unknown {}", what));
}

/// Removes the text up to the next separator from the front of `text` and returns it.
std::string_view take_until(char separator, std::string_view& text) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return taken;
}

std::string_view take_token(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const std::string_view token = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(token.size());
    return token;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

Element read_element(std::string_view tokens) {
    Element element{};
    element.name = take_token(tokens);
    const std::string_view count = take_token(tokens);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size())
        throw MeshError("has a header with an element without a count");
    return element;
}

Property read_property(std::string_view tokens) {
    Property property{};
    std::string_view type = take_token(tokens);
    if (type == "list") {
        property.list_count = named<Type>(take_token(tokens), types, "type");
        type = take_token(tokens);
    }
    property.type = named<Type>(type, types, "type");
    property.name = take_token(tokens);
    return property;
}

/// Reads the header and removes it from the front of `bytes`.
Header read_header(std::string_view& bytes) {
    const std::string_view whole = bytes;
    const auto next_line = [&] {
        if (bytes.empty()) throw MeshError("ends within its header");
        if (whole.size() - bytes.size() > header_bytes)
            throw MeshError(fmt::format("has a header of more than {} KiB", header_bytes >> 10));
        std::string_view line = take_until('\n', bytes);
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    };
    if (next_line() != "ply") throw MeshError("does not begin with \"ply\"");
    Header header;
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
        const std::string_view token = take_token(line);
        if (token == "comment") {
            if (take_token(line) == "TextureFile") header.texture = trimmed(line);
        } else if (token == "format") {
            header.encoding = named<Encoding>(take_token(line), encodings, "format");
        } else if (token == "element") {
            header.elements.push_back(read_element(line));
        } else if (token == "property") {
            const Property property = read_property(line);
            if (property.name.empty() || header.elements.empty())
                throw MeshError("has a header with a misplaced property");
            header.elements.back().properties.push_back(property);
        }
    }
    return header;
}

/// The sequence of numbers after the header.
class Body {
public:
    Body(std::string_view data, Encoding encoding) : data_(data), encoding_(encoding) {}

    std::size_t bytes_left() const { return data_.size() - at_; }

    double next(Type type) { return encoding_ == Encoding::text ? next_token() : next_binary(type); }

    /// Lines of text with anything on them that are left.
    std::uint64_t lines_left() const {
        std::uint64_t lines = 0;
        bool blank = true;
        for (const char c : data_.substr(at_)) {
            if (c == '\n') blank = true;
            if (!blank || std::strchr(" \t\r\n", c)) continue;
            blank = false;
            ++lines;
        }
        return lines;
    }
    void skip_line() { at_ = std::min(data_.find('\n', at_), data_.size()); }

private:
    double next_token() {
        while (at_ < data_.size() && std::strchr(" \t\r\n", data_[at_])) ++at_;
        if (at_ < data_.size() && data_[at_] == '+') ++at_;  // from_chars accepts no plus
        if (at_ == data_.size()) throw MeshError("ends early");
        const char* first = data_.data() + at_;
        double value = 0.0;
        const auto [end, error] = std::from_chars(first, data_.data() + data_.size(), value);
        if (error != std::errc())
            throw MeshError(fmt::format("holds something that is not a number, at byte {} after its header", at_));
        at_ += static_cast<std::size_t>(end - first);
        return value;
    }

    template <class Number>
    Number take() {
        if (bytes_left() < sizeof(Number)) throw MeshError("ends early");
        char bytes[sizeof(Number)];
        std::memcpy(bytes, data_.data() + at_, sizeof bytes);
        if (encoding_ == Encoding::big_endian) std::reverse(bytes, bytes + sizeof bytes);  // x86-64 is little-endian
        at_ += sizeof bytes;
        Number value;
        std::memcpy(&value, bytes, sizeof bytes);
        return value;
    }

    double next_binary(Type type) {
        switch (type) {
            case Type::int8:
                return take<std::int8_t>();
            case Type::uint8:
                return take<std::uint8_t>();
            case Type::int16:
                return take<std::int16_t>();
            case Type::uint16:
                return take<std::uint16_t>();
            case Type::int32:
                return take<std::int32_t>();
            case Type::uint32:
                return take<std::uint32_t>();
            case Type::float32:
                return as_written(take<float>());
            case Type::float64:
                break;
        }
        return take<double>();
    }

    std::string_view data_;
    Encoding encoding_;
    std::size_t at_ = 0;
};

/// An integer below `limit`, or an error.
std::size_t whole(double value, double limit, const char* what) {
    if (!(value >= 0.0 && value < limit) || value != std::trunc(value)) {
        throw MeshError(fmt::format("has {} of {}", what, number_text(value)));
    }
    return static_cast<std::size_t>(value);
}

/// Reads one row of an element: single numbers to `scalars`, the numbers of its lists to `lists`, by property.
void read_row(Body& body, const Element& element, std::vector<double>& scalars,
              std::vector<std::vector<double>>& lists) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (!property.list_count) {
            scalars[i] = body.next(property.type);
            continue;
        }
        lists[i].resize(
            whole(body.next(*property.list_count), double(body.bytes_left()) + 1.0, "a list with a length"));
        for (double& value : lists[i]) value = body.next(property.type);
    }
}

std::optional<std::size_t> property_index(const Element& element, std::string_view name, bool is_list) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (element.properties[i].name == name && element.properties[i].list_count.has_value() == is_list) return i;
    }
    return std::nullopt;
}

/// The properties of these names, if the element has all of them.
template <std::size_t N>
std::optional<std::array<std::size_t, N>> all_of(const Element& element, const std::array<const char*, N>& names) {
    std::array<std::size_t, N> result{};
    for (std::size_t i = 0; i < N; ++i) {
        const auto index = property_index(element, names[i], false);
        if (!index) return std::nullopt;
        result[i] = *index;
    }
    return result;
}

/// Data of vertices beside their positions; each list has one value per vertex, or none at all.
struct VertexData {
    std::vector<Vec3> normals;
    std::vector<std::array<float, 3>> colors;  // linear light
    std::vector<std::array<float, 2>> places;  // in the texture
    std::uint32_t material = MeshFile::no_material;
};

MeshFile::Corner corner_of(double index, const VertexData& data, const MeshFile& mesh) {
    const std::size_t v = whole(index, double(mesh.positions.size()), "a face with a vertex");
    MeshFile::Corner corner;
    corner.position = static_cast<std::uint32_t>(v);
    if (v < data.normals.size()) corner.normal = data.normals[v];
    if (v < data.colors.size()) corner.color = data.colors[v];
    if (v < data.places.size()) corner.uv = data.places[v];
    corner.material = data.material;
    return corner;
}

/// The largest value of a color channel of this type.
double full_channel(Type type) {
    if (type == Type::float32 || type == Type::float64) return 1.0;
    return type == Type::uint16 ? 65535.0 : 255.0;
}

/// Strips of triangles, each ended by -1; every second triangle is wound the other way.
void add_strips(const std::vector<double>& indices, const VertexData& data, MeshFile& mesh) {
    std::vector<MeshFile::Corner> strip;
    for (const double index : indices) {
        if (index == -1.0) {
            strip.clear();
            continue;
        }
        strip.push_back(corner_of(index, data, mesh));
        const std::size_t n = strip.size();
        if (n < 3) continue;
        if (n % 2 == 1)
            mesh.add_triangle({strip[n - 3], strip[n - 2], strip[n - 1]});
        else
            mesh.add_triangle({strip[n - 2], strip[n - 3], strip[n - 1]});
    }
}

}  // namespace

MeshFile read_ply(std::string_view bytes, const std::filesystem::path& folder) {
    const Header header = read_header(bytes);
    Body body(bytes, header.encoding);

    MeshFile mesh;
    VertexData data;
    MeshImages images(folder);
    if (!header.texture.empty())
        if (const auto texture = images.texture(header.texture)) {
            data.material = 0;
            mesh.materials.emplace_back().texture = texture;
        }
    mesh.take(images);
    // A row for each line may have more columns than the header names.
    std::uint64_t rows = 0;
    for (const Element& element : header.elements)
        if (!element.properties.empty()) rows += std::min(element.count, std::uint64_t(bytes.size()));
    const bool row_per_line = header.encoding == Encoding::text && body.lines_left() == rows;
    for (const Element& element : header.elements) {
        const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
        const auto position = all_of<3>(element, {"x", "y", "z"}), normal = all_of<3>(element, {"nx", "ny", "nz"});
        // Programs write gray vertices beside a texture.
        const auto color = mesh.materials.empty() ? all_of<3>(element, {"red", "green", "blue"}) : std::nullopt;
        auto place = all_of<2>(element, {"s", "t"});
        for (const auto& names : {std::array{"u", "v"}, std::array{"texture_u", "texture_v"}})
            if (!place) place = all_of<2>(element, names);
        const auto corner_places = property_index(element, "texcoord", true);
        auto corners = property_index(element, "vertex_indices", true);
        if (!corners) corners = property_index(element, "vertex_index", true);
        if (is_vertex && !position) throw MeshError("has vertices without x, y and z");
        const bool is_strip = element.name == "tristrips" && corners;
        if (is_face && !corners) throw MeshError("has faces without vertex_indices");
        if (element.properties.empty() && element.count > 0) continue;  // empty rows

        std::vector<double> scalar(element.properties.size());
        std::vector<std::vector<double>> list(element.properties.size());
        std::vector<MeshFile::Corner> polygon;
        for (std::uint64_t row = 0; row < element.count; ++row) {
            read_row(body, element, scalar, list);
            if (row_per_line) body.skip_line();
            if (is_vertex) {
                const auto& [x, y, z] = *position;
                mesh.add_position({scalar[x], scalar[y], scalar[z]});
                if (place) data.places.push_back({float(scalar[(*place)[0]]), 1.0f - float(scalar[(*place)[1]])});
                if (color) {
                    std::array<float, 3>& linear = data.colors.emplace_back();
                    for (std::size_t c = 0; c < 3; ++c)
                        linear[c] = linear_channel(
                            float(scalar[(*color)[c]] / full_channel(element.properties[(*color)[c]].type)));
                }
                if (normal)
                    data.normals.push_back(
                        unit_or_zero({scalar[(*normal)[0]], scalar[(*normal)[1]], scalar[(*normal)[2]]}));
            } else if (is_face) {
                polygon.clear();
                for (const double index : list[*corners]) polygon.push_back(corner_of(index, data, mesh));
                if (corner_places && list[*corner_places].size() == 2 * polygon.size())
                    for (std::size_t i = 0; i < polygon.size(); ++i)
                        polygon[i].uv = {float(list[*corner_places][2 * i]),
                                         1.0f - float(list[*corner_places][2 * i + 1])};
                mesh.add_polygon(polygon);
            } else if (is_strip) {
                add_strips(list[*corners], data, mesh);
            }
        }
    }
    mesh.colored = !data.colors.empty();
    return mesh;
}

}  // namespace tumble

#include "scene/mesh/stl_file.h"

#include "scene/mesh/mesh_text.h"
#include "scene/mesh/mesh_transform.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>

namespace tumble {
namespace {

constexpr std::size_t binary_header_bytes = 80, count_bytes = 4, facet_bytes = 50, normal_bytes = 12;

/// The file's words, across line ends.
class Words {
public:
    explicit Words(std::string_view text) : words_(text) {}
    std::string_view next() {
        while (true) {
            const std::string_view word = words_.word();
            if (!word.empty() || !words_.next_line()) return word;
        }
    }
    /// The word after the begin or end of a solid, which may be any word.
    void skip_name() { words_.word(); }
    std::size_t line() const { return words_.line(); }

private:
    TextWords words_;
};

void add_last_three(MeshFile& mesh) {
    const auto next = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.add_triangle({{{next - 3, Vec3::Zero()}, {next - 2, Vec3::Zero()}, {next - 1, Vec3::Zero()}}});
}

MeshFile read_text(std::string_view bytes) {
    MeshFile mesh;
    const MeshTransform in_place;
    Words words(bytes);
    int corners = 3;  // of the facet; outside a facet no vertex is expected
    const auto end_facet = [&] {
        if (corners != 3)
            throw MeshError(fmt::format("has a facet of {} corners before line {}", corners, words.line()));
    };
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (word == "solid") {
            end_facet();
            mesh.begin_object();
            words.skip_name();
        } else if (word == "facet") {
            end_facet();
            corners = 0;
        } else if (word == "vertex" && corners < 3) {
            std::array<float, 3> point{};
            for (float& coordinate : point) coordinate = mesh_number(words.next(), words.line());
            mesh.add_position(in_place.point(point));
            if (++corners == 3) add_last_three(mesh);
        } else if (word == "endsolid") {
            end_facet();
            words.skip_name();
        }
    }
    end_facet();
    return mesh;
}

MeshFile read_binary(std::string_view bytes) {
    MeshFile mesh;
    const MeshTransform in_place;
    for (std::size_t at = binary_header_bytes + count_bytes; at < bytes.size(); at += facet_bytes) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            std::array<float, 3> point{};
            std::memcpy(point.data(), bytes.data() + at + normal_bytes + corner * sizeof point, sizeof point);
            mesh.add_position(in_place.point(point));
        }
        add_last_three(mesh);
    }
    return mesh;
}

}  // namespace

MeshFile read_stl(std::string_view bytes) {
    // Binary files may begin with "solid" as well, so the length decides.
    std::uint32_t facets = 0;
    const bool long_enough = bytes.size() >= binary_header_bytes + count_bytes;
    if (long_enough) std::memcpy(&facets, bytes.data() + binary_header_bytes, sizeof facets);
    if (long_enough && bytes.size() == binary_header_bytes + count_bytes + facets * facet_bytes)
        return read_binary(bytes);
    if (Words(bytes).next() == "solid") return read_text(bytes);
    if (!long_enough)
        throw MeshError("is no STL file: it does not begin with \"solid\" and is too short for a binary one");
    throw MeshError(
        fmt::format("is no STL file: it does not begin with \"solid\", and a binary one of {} facets would have {} "
                    "bytes (it has {})",
                    facets, binary_header_bytes + count_bytes + facets * facet_bytes, bytes.size()));
}

}  // namespace tumble

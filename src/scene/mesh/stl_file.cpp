#include "scene/mesh/mesh_readers.h"

#include "scene/mesh/mesh_text.h"
#include "scene/mesh/mesh_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace tumble {
namespace {

constexpr std::size_t binary_header_bytes = 80, count_bytes = 4, facet_bytes = 50, normal_bytes = 12;

/// The file's tokens, across line ends.
class Tokens {
public:
    explicit Tokens(std::string_view text) : tokens_(text) {}
    std::string_view next() {
        while (true) {
            const std::string_view token = tokens_.token();
            if (!token.empty() || !tokens_.next_line()) return token;
        }
    }
    /// The token after the begin or end of a solid, which may be any token.
    void skip_name() { tokens_.token(); }
    std::size_t line() const { return tokens_.line(); }

private:
    TextTokens tokens_;
};

void add_last_three(MeshFile& mesh) {
    const auto next = static_cast<std::uint32_t>(mesh.positions.size());
    std::array<MeshFile::Corner, 3> corners;
    for (std::uint32_t i = 0; i < 3; ++i) corners[i].position = next - 3 + i;
    mesh.add_triangle(corners);
}

/// Keywords may have capitals.
bool is_word(std::string_view token, std::string_view lower) {
    return std::equal(token.begin(), token.end(), lower.begin(), lower.end(),
                      [](char given, char wanted) { return (given | 0x20) == wanted; });
}

MeshFile read_text(std::string_view bytes) {
    MeshFile mesh;
    const MeshTransform in_place;
    Tokens tokens(bytes);
    int corners = 3;  // of the facet; outside a facet no vertex is expected
    const auto end_facet = [&] {
        if (corners != 3)
            throw MeshError(fmt::format("has a facet of {} corners before line {}", corners, tokens.line()));
    };
    for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
        if (is_word(token, "solid")) {
            end_facet();
            mesh.begin_object();
            tokens.skip_name();
        } else if (is_word(token, "facet")) {
            end_facet();
            corners = 0;
        } else if (is_word(token, "vertex") && corners < 3) {
            std::array<float, 3> point{};
            for (float& coordinate : point) coordinate = mesh_number(tokens.next(), tokens.line());
            mesh.add_position(in_place.point(point));
            if (++corners == 3) add_last_three(mesh);
        } else if (is_word(token, "endsolid")) {
            end_facet();
            tokens.skip_name();
        }
    }
    end_facet();
    return mesh;
}

MeshFile read_binary(std::string_view bytes, std::uint32_t facets) {
    MeshFile mesh;
    const MeshTransform in_place;
    std::size_t at = binary_header_bytes + count_bytes;
    for (std::uint32_t facet = 0; facet < facets; ++facet, at += facet_bytes) {
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
    // Binary files may begin with "solid" as well, so the length decides. Some have bytes of their program behind the
    // facets.
    std::uint32_t facets = 0;
    const bool long_enough = bytes.size() >= binary_header_bytes + count_bytes;
    if (long_enough) std::memcpy(&facets, bytes.data() + binary_header_bytes, sizeof facets);
    const std::uint64_t binary_bytes = binary_header_bytes + count_bytes + std::uint64_t(facets) * facet_bytes;
    if (long_enough && bytes.size() == binary_bytes) return read_binary(bytes, facets);
    const std::string_view text = bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
    if (is_word(Tokens(text).next(), "solid")) {
        MeshFile mesh = read_text(text);
        if (!mesh.triangles.empty() || !long_enough || facets == 0 || bytes.size() < binary_bytes) return mesh;
    }
    if (long_enough && facets > 0 && bytes.size() > binary_bytes) return read_binary(bytes, facets);
    if (!long_enough)
        throw MeshError("is no STL file: it does not begin with \"solid\" and is too short for a binary one");
    throw MeshError(
        fmt::format("is no STL file: it does not begin with \"solid\", and a binary one of {} facets would have {} "
                    "bytes (it has {})",
                    facets, binary_bytes, bytes.size()));
}

}  // namespace tumble

#include "scene/keys/compound.h"

#include "scene/keys/motion.h"
#include "scene/keys/shapes.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

namespace tumble {
namespace {

CompoundPart read_part(TomlTable& table, BodyType type, const std::filesystem::path& folder, MeshCache& meshes) {
    table.set_title("a part");
    table.expect_keys({"shape", "position", "rotation", "density", "color"});
    const TomlValue shape = table.require("shape");
    if (const auto kind = shape.table().find("type"); kind && kind->text() == "plane")
        kind->fail("\"plane\" is endless and cannot be part of a body");
    CompoundPart part;
    part.shape = read_shape(shape, type, folder, meshes).shape;
    table.read("position", part.position, limits::coordinate);
    if (const auto rotation = table.find("rotation")) part.rotation = read_rotation(*rotation);
    table.read("density", part.density, limits::density);
    if (const auto color = table.find("color")) part.color = color->color();
    return part;
}

/// A part of a part as a part of the whole.
CompoundPart within(const CompoundPart& outer, const CompoundPart& inner) {
    CompoundPart part = inner;
    part.position = outer.position + outer.rotation * inner.position;
    part.rotation = (outer.rotation * inner.rotation).normalized();
    if (!inner.density) part.density = outer.density;
    if (!inner.color) part.color = outer.color;
    return part;
}

}  // namespace

CompoundShape read_compound(const TomlTable& table, BodyType type, const std::filesystem::path& folder,
                            MeshCache& meshes) {
    table.expect_keys({"type", "parts"});
    const TomlValue list = table.require("parts");
    auto parts = std::make_shared<std::vector<CompoundPart>>();
    for (TomlTable& item : list.tables(" { shape, position, rotation, density, color }")) {
        CompoundPart part = read_part(item, type, folder, meshes);
        if (const auto* inner = std::get_if<CompoundShape>(&part.shape))
            for (const CompoundPart& p : *inner->parts) parts->push_back(within(part, p));
        else
            parts->push_back(std::move(part));
        if (parts->size() > std::size_t(limits::parts))
            list.origin().fail(fmt::format("holds too many parts: the limit of a body is {}", limits::parts));
    }
    if (parts->empty()) list.fail("must hold at least one part");
    return {std::move(parts)};
}

}  // namespace tumble

#include "scene/keys/shapes.h"

#include "core/safe_text.h"
#include "scene/fields/body_fields.h"
#include "scene/fields/choices.h"
#include "scene/keys/read_fields.h"
#include "scene/mesh/curved_mesh.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

enum class ShapeKind { plane, box, sphere, capsule, cylinder, cone, ellipsoid, mesh, compound, hull, heightfield };

constexpr Choice<ShapeKind> shape_kinds[] = {
    {"plane", ShapeKind::plane},
    {"box", ShapeKind::box},
    {"sphere", ShapeKind::sphere},
    {"capsule", ShapeKind::capsule},
    {"cylinder", ShapeKind::cylinder},
    {"cone", ShapeKind::cone},
    {"ellipsoid", ShapeKind::ellipsoid},
    {"mesh", ShapeKind::mesh},
    {"compound", ShapeKind::compound},
    {"hull", ShapeKind::hull},
    {"heightfield", ShapeKind::heightfield},
};

// One convex hull of the mesh, or one of each object of the file.
enum class MeshParts { whole, objects };

constexpr Choice<MeshParts> mesh_parts[] = {
    {"objects", MeshParts::objects},
};

constexpr Choice<double> mesh_units[] = {
    {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}, {"km", 1e3}, {"in", 0.0254}, {"ft", 0.3048}, {"yd", 0.9144},
};

constexpr Choice<UpAxis> up_axes[] = {
    {"y", UpAxis::y},
    {"z", UpAxis::z},
    {"x", UpAxis::x},
};

PlaneShape read_plane(const TomlTable& table) {
    PlaneShape plane;
    if (const auto value = table.find("normal")) plane.normal = value->direction();
    table.read("offset", plane.offset, limits::coordinate);
    return plane;
}

CurvedShape read_curved(TomlTable& table, CurvedKind kind, MeshCache& meshes) {
    table.set_title(fmt::format("{} {}", kind == CurvedKind::ellipsoid ? "an" : "a", name_of(kind)));
    CurvedShape shape{kind};
    if (kind == CurvedKind::ellipsoid) {
        table.expect_keys({"type", "radii"});
        shape.radii = table.require("radii").vector(limits::size);
    } else {
        if (kind == CurvedKind::cone)
            table.expect_keys({"type", "radius", "height", "top_radius"});
        else
            table.expect_keys({"type", "radius", "height"});
        shape.radius = table.require("radius").number(limits::size);
        shape.height = table.require("height").number(limits::size);
        if (kind == CurvedKind::cylinder) shape.top_radius = shape.radius;
        if (kind == CurvedKind::cone) table.read("top_radius", shape.top_radius, limits::size_or_zero);
    }
    return meshes.drawn(shape);
}

/// Fails where the mesh encloses no volume. `which`: "this one", or the object of the file.
void require_solid(const LoadedMesh& mesh, const TomlValue& origin, const std::string& which) {
    if (mesh.encloses()) return;
    const Closedness& c = mesh.closedness;
    std::string why = "encloses no volume";
    if (c.open_edges > 0)
        why =
            fmt::format("is open: {} of its edges belong to one triangle only, so it encloses no volume", c.open_edges);
    else if (c.unbalanced_edges > 0)
        why = fmt::format("is not a proper surface: at {} of its edges the triangles disagree on which side is out",
                          c.unbalanced_edges);
    origin.fail(
        fmt::format("\"solid\" needs a closed mesh, and {} {}; take \"hull\" or \"shell\", or close it", which, why));
}

bool is_flat(const TriangleMesh& mesh) {
    try {
        make_hull(mesh.vertices, Vec3::Zero());
        return false;
    } catch (const InputError&) {
        return true;
    }
}

/// The shape of a loaded mesh. The mass of a moving body is that of the enclosed volume; of a mesh without one, that of
/// its hull, and of a flat mesh that of a shell. The key mass_from chooses another.
MeshShape shape_of(const LoadedMesh& mesh, const TomlTable& table, BodyType type,
                   const std::string& which = "this one") {
    MeshShape shape{mesh.asset};
    shape.painted = mesh.asset->paint != nullptr;
    const auto thickness = table.find("thickness");
    if (const auto given = table.find("mass_from")) {
        shape.mass_from = given->choice<MassFrom>(choices<MassFrom>);
        if (type == BodyType::dynamic && shape.mass_from == MassFrom::solid) require_solid(mesh, *given, which);
        if (type == BodyType::dynamic && shape.mass_from == MassFrom::hull && is_flat(mesh.asset->mesh))
            given->fail(fmt::format("\"hull\" needs a mesh with a volume, and {} is flat: take \"shell\"", which));
    } else if (type == BodyType::dynamic && !mesh.encloses()) {
        shape.mass_from = is_flat(mesh.asset->mesh) || thickness ? MassFrom::shell : MassFrom::hull;
        shape.chosen = thickness.has_value();
    }
    if (thickness && shape.mass_from != MassFrom::shell)
        thickness->origin().fail("is a key of shells: give it with mass_from = \"shell\"");
    constexpr double usual_thickness = 0.01;  // of the length: a sheet
    shape.thickness = thickness ? thickness->number(limits::size)
                      : shape.mass_from == MassFrom::shell
                          ? usual_thickness * mesh.asset->mesh.bounds().extent().maxCoeff()
                          : 0.0;
    return shape;
}

void check_mesh_size(const LoadedMesh& mesh, const TomlValue& origin) {
    const Bounds bounds = mesh.asset->mesh.bounds();
    const double extent = bounds.extent().maxCoeff();
    const double reach = std::max(bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff());
    if (!limits::size.contains(extent) || !limits::coordinate.contains(reach)) {
        origin.origin().fail(
            fmt::format("makes a mesh of unusable size: it reaches {} m from its origin and is {} m long "
                        "(its length {})",
                        number_text(reach), number_text(extent), limits::size.requirement()));
    }
}

/// Scale and orientation, by keys or by the file, but not by both.
void check_frame(const TomlTable& table, const LoadedMesh& mesh) {
    if (!mesh.in_meters) return;
    for (const auto& [key, instead] : {std::pair("unit", "scale"), std::pair("up", "the body's rotation")})
        if (const auto given = table.find(key))
            given->origin().fail(
                fmt::format("is for files that state no unit and no up axis, and this one does: take {} in place of {}",
                            instead, key));
}

/// Each object of the file as a part.
CompoundShape read_objects(const TomlTable& table, BodyType type, const TomlValue& file, const ShapeRequest& request,
                           MeshCache& meshes) {
    const std::vector<LoadedMesh>& objects = meshes.load_objects(request.mesh, request.mesh_scale);
    if (!objects.empty()) check_frame(table, objects.front());
    auto made = std::make_shared<std::vector<CompoundPart>>();
    const auto scale = table.find("scale");
    for (const LoadedMesh& object : objects) {
        check_mesh_size(object, scale ? *scale : file);
        CompoundPart part;
        part.shape = shape_of(object, table, type, fmt::format("object {} of the file", made->size() + 1));
        made->push_back(std::move(part));
    }
    return {std::move(made)};
}

/// Fills in the shape of the request. `origin`: the value that names the mesh, for errors.
void load_whole(const TomlTable& table, BodyType type, const TomlValue& origin, ShapeRequest& request,
                MeshCache& meshes) {
    const LoadedMesh& mesh = meshes.load(request.mesh, request.mesh_scale);
    check_frame(table, mesh);
    const auto scale = table.find("scale");
    check_mesh_size(mesh, scale ? *scale : origin);
    request.shape = shape_of(mesh, table, type);
}

ShapeRequest read_mesh(const TomlTable& table, BodyType type, const std::filesystem::path& folder, MeshCache& meshes) {
    ShapeRequest request;
    table.read("scale", request.mesh_scale, limits::mesh_scale);
    const TomlValue file = table.require("file");
    const std::string name = file.text();
    if (name.empty()) file.fail("must not be empty");
    if (name.find('\0') != std::string::npos) file.fail("must not hold a zero byte");
    request.mesh = (folder / std::filesystem::path(name)).lexically_normal();
    table.read<UpAxis>("up", request.mesh.up, up_axes);
    if (const auto unit = table.find("unit")) request.mesh_scale *= unit->choice<double>(mesh_units);
    MeshParts parts = MeshParts::whole;
    table.read<MeshParts>("parts", parts, mesh_parts);
    try {
        if (parts == MeshParts::objects) {
            request.shape = read_objects(table, type, file, request, meshes);
            return request;
        }
        load_whole(table, type, file, request, meshes);
    } catch (const MeshError& error) {
        throw InputError(file.origin().where,
                         fmt::format("mesh \"{}\" {} (looked at {})", safe_text(name, path_text_bytes), error.what(),
                                     safe_path(request.mesh.file)));
    }
    return request;
}

/// A mesh of a scene that is built in code. No file has the key "memory".
ShapeRequest read_supplied_mesh(const TomlTable& table, BodyType type, const TomlValue& memory, MeshCache& meshes) {
    table.expect_keys({"type", "memory", "scale", "mass_from", "thickness"});
    ShapeRequest request;
    table.read("scale", request.mesh_scale, limits::mesh_scale);
    request.mesh = MeshSource(std::size_t(memory.integer(0, std::numeric_limits<std::int64_t>::max())));
    try {
        load_whole(table, type, memory, request, meshes);
    } catch (const MeshError& error) {
        throw InputError(memory.origin().where, fmt::format("the mesh {}", error.what()));
    }
    return request;
}

CompoundPart read_part(TomlTable& table, BodyType type, const std::filesystem::path& folder, MeshCache& meshes) {
    table.set_title("a part");
    CompoundPart part = read_all_fields<CompoundPart>(table);
    const TomlValue shape = table.require("shape");
    if (const auto kind = shape.table().find("type")) {
        if (kind->text() == "plane") kind->fail("\"plane\" is endless and cannot be part of a body");
        if (kind->text() == "heightfield")
            kind->fail("\"heightfield\" cannot be part of a body, whose parts collide as convex shapes");
    }
    part.shape = read_shape(shape, type, folder, meshes).shape;
    if (part.color) part.shape = without_paint(part.shape);
    return part;
}

/// A part of a part as a part of the whole.
CompoundPart within(const CompoundPart& outer, const CompoundPart& inner) {
    CompoundPart part = inner;
    part.position = outer.position + outer.rotation * inner.position;
    part.rotation = (outer.rotation * inner.rotation).normalized();
    if (!inner.density) part.density = outer.density;
    if (!inner.color) part.color = outer.color;
    part.collide = inner.collide && outer.collide;
    part.visible = inner.visible && outer.visible;
    return part;
}

/// Nested compounds are flattened.
CompoundShape read_compound(const TomlTable& table, BodyType type, const std::filesystem::path& folder,
                            MeshCache& meshes) {
    table.expect_keys({"type", "parts"});
    const TomlValue list = table.require("parts");
    auto parts = std::make_shared<std::vector<CompoundPart>>();
    for (TomlTable& item : list.tables(" { shape, position, rotation, density, color, collide, visible }")) {
        CompoundPart part = read_part(item, type, folder, meshes);
        if (const auto* inner = std::get_if<CompoundShape>(&part.shape))
            for (const CompoundPart& p : *inner->parts) parts->push_back(within(part, p));
        else
            parts->push_back(std::move(part));
        if (parts->size() > std::size_t(limits::parts))
            list.origin().fail(fmt::format("holds too many parts: the limit of a body is {}", limits::parts));
    }
    if (parts->empty()) list.fail("must hold at least one part");
    if (std::none_of(parts->begin(), parts->end(), [](const CompoundPart& part) { return part.collide; }))
        list.origin().fail(
            "must hold a part that collides; a body that touches nothing has collide_with = [] in place of "
            "collide = false in each part");
    return {std::move(parts)};
}

}  // namespace

ShapeRequest read_shape(const TomlValue& value, BodyType type, const std::filesystem::path& folder, MeshCache& meshes) {
    TomlTable table = value.table();
    table.set_title("a shape");
    const TomlValue type_value = table.require("type");
    const ShapeKind kind = type_value.choice<ShapeKind>(shape_kinds);
    switch (kind) {
        case ShapeKind::plane:
            table.set_title("a plane");
            table.expect_keys({"type", "normal", "offset"});
            if (type == BodyType::dynamic) {
                type_value.fail("\"plane\" is endless and cannot move freely: give the body type = \"fixed\"");
            }
            return {read_plane(table), {}, 1.0};
        case ShapeKind::box: {
            table.set_title("a box");
            table.expect_keys({"type", "size"});
            return {BoxShape{table.require("size").vector(limits::size)}, {}, 1.0};
        }
        case ShapeKind::sphere:
            table.set_title("a sphere");
            table.expect_keys({"type", "radius"});
            return {SphereShape{table.require("radius").number(limits::size)}, {}, 1.0};
        case ShapeKind::capsule:
            return {read_curved(table, CurvedKind::capsule, meshes), {}, 1.0};
        case ShapeKind::cylinder:
            return {read_curved(table, CurvedKind::cylinder, meshes), {}, 1.0};
        case ShapeKind::cone:
            return {read_curved(table, CurvedKind::cone, meshes), {}, 1.0};
        case ShapeKind::ellipsoid:
            return {read_curved(table, CurvedKind::ellipsoid, meshes), {}, 1.0};
        case ShapeKind::compound:
            table.set_title("a compound");
            return {read_compound(table, type, folder, meshes), {}, 1.0};
        case ShapeKind::hull:
            table.set_title("a hull");
            return read_hull(table);
        case ShapeKind::heightfield:
            table.set_title("a heightfield");
            if (type != BodyType::fixed)
                type_value.fail("\"heightfield\" is ground and cannot move: give the body type = \"fixed\"");
            return read_height_field(table, folder, meshes);
        case ShapeKind::mesh:
            break;
    }
    table.set_title("a mesh");
    if (meshes.has_supplier())
        if (const auto memory = table.find("memory")) return read_supplied_mesh(table, type, *memory, meshes);
    table.expect_keys({"type", "file", "scale", "unit", "up", "parts", "mass_from", "thickness"});
    return read_mesh(table, type, folder, meshes);
}

Shape without_paint(const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape); mesh && mesh->painted) {
        MeshShape plain = *mesh;
        plain.painted = false;
        return plain;
    }
    const auto* compound = std::get_if<CompoundShape>(&shape);
    if (compound == nullptr || !mean_paint(shape)) return shape;
    std::vector<CompoundPart> parts = *compound->parts;
    for (CompoundPart& part : parts) part.shape = without_paint(part.shape);
    return CompoundShape{std::make_shared<const std::vector<CompoundPart>>(std::move(parts))};
}

std::optional<Color> mean_paint(const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape); mesh && mesh->painted) return mesh->asset->paint->mean;
    if (const auto* compound = std::get_if<CompoundShape>(&shape))
        for (const CompoundPart& part : *compound->parts)
            if (const auto mean = mean_paint(part.shape)) return mean;
    return std::nullopt;
}

Shape scaled(const ShapeRequest& request, double factor, MeshCache& meshes) {
    if (factor == 1.0) return request.shape;
    if (const auto* mesh = std::get_if<MeshShape>(&request.shape); mesh && !request.made) {
        MeshShape larger = *mesh;
        larger.asset = meshes.load(request.mesh, request.mesh_scale * factor).asset;
        larger.thickness *= factor;
        if (larger.painted && larger.asset->paint != mesh->asset->paint) {  // it has a texture of the scene
            auto own = std::make_shared<MeshAsset>(*larger.asset);
            own->paint = mesh->asset->paint;
            larger.asset = std::move(own);
        }
        return larger;
    }
    return meshes.enlarged(request.shape, factor);
}

}  // namespace tumble

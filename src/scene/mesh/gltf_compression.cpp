#include "scene/mesh/gltf_compression.h"

#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <memory>

namespace tumble {

const Json* find_extension(const Json& holder, const char* name) {
    const Json* extensions = find_member(holder, "extensions");
    return extensions ? find_member(*extensions, name) : nullptr;
}

DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint64_t>& attributes) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        throw MeshError(fmt::format("has a mesh that Draco cannot read: {}", decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (std::int64_t(mesh->num_faces()) > limits::mesh_triangles ||
        std::int64_t(mesh->num_points()) > limits::mesh_triangles * 3)
        throw MeshError(
            fmt::format("has {} triangles in a mesh (at most {})", mesh->num_faces(), limits::mesh_triangles));
    DracoMesh made;
    made.indices.reserve(3 * std::size_t(mesh->num_faces()));
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& point : mesh->face(face)) made.indices.push_back(point.value());
    for (const std::uint64_t number : attributes) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(std::uint32_t(number));
        if (!attribute) throw MeshError(fmt::format("has no attribute {} in the data of Draco", number));
        auto& values = made.attributes[number];
        values.assign(mesh->num_points(), {1.0f, 1.0f, 1.0f, 1.0f});
        const auto components = std::int8_t(std::min<int>(attribute->num_components(), 4));
        for (draco::PointIndex point(0); point < mesh->num_points(); ++point)
            if (!attribute->ConvertValue<float>(attribute->mapped_index(point), components,
                                                values[point.value()].data()))
                throw MeshError("has values in the data of Draco that are no numbers");
    }
    return made;
}

std::string decode_meshopt(const Json& extension, std::string_view bytes) {
    const std::uint64_t count = require_whole(extension, "count"), stride = require_whole(extension, "byteStride");
    const auto text = [&](const char* key) {
        const Json* value = find_member(extension, key);
        return value && value->is_string() ? value->get<std::string>() : std::string();
    };
    const std::string mode = text("mode"), filter = text("filter");
    if (stride == 0 || stride > 256 || count > std::uint64_t(limits::mesh_bytes) / stride)
        throw MeshError(fmt::format("has a compressed buffer view of {} times {} bytes (at most {} MiB)", count, stride,
                                    limits::mesh_bytes >> 20));
    const bool vertices = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES", list = mode == "INDICES";
    // Sizes that the decoders assert.
    if (!(vertices ? stride % 4 == 0 : (triangles || list) && (stride == 2 || stride == 4) && (list || count % 3 == 0)))
        throw MeshError(fmt::format("has a compressed buffer view of mode \"{}\" with {} times {} bytes",
                                    readable(mode, 20), count, stride));
    const bool fits_filter = filter.empty() || filter == "NONE" ||
                             (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                             (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL";
    if (!fits_filter || (!vertices && !filter.empty() && filter != "NONE"))
        throw MeshError(fmt::format("has a compressed buffer view with the filter \"{}\" on {} bytes",
                                    readable(filter, 20), stride));
    std::string result(count * stride, '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const int fault = vertices    ? meshopt_decodeVertexBuffer(result.data(), count, stride, from, bytes.size())
                      : triangles ? meshopt_decodeIndexBuffer(result.data(), count, stride, from, bytes.size())
                                  : meshopt_decodeIndexSequence(result.data(), count, stride, from, bytes.size());
    if (fault != 0)
        throw MeshError(fmt::format("has a compressed buffer view that meshoptimizer cannot read ({})", fault));
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(result.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(result.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), count, stride);
    return result;
}

}  // namespace tumble

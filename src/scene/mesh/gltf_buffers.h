// The buffers of a glTF file and the values of its accessors.
#pragma once

#include "scene/mesh/gltf_json.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class GltfBuffers {
public:
    /// `binary`: the binary chunk of a GLB file, otherwise empty; `file_bytes`: size of the file. The document and the
    /// chunk must outlive the buffers. Other files are read from `folder` and below.
    GltfBuffers(const Json& document, std::string_view binary, std::size_t file_bytes, std::filesystem::path folder)
        : document_(document), binary_(binary), folder_(std::move(folder)), bytes_read_(file_bytes) {}

    /// The number of elements of an accessor. Throws MeshError if it exceeds the number of bytes read.
    std::uint64_t count_vectors(std::uint64_t accessor);
    std::uint64_t count_indices(std::uint64_t accessor);
    /// An accessor of 3-vectors; integers become floats, of -1 to 1 or 0 to 1 if they are normalized.
    std::vector<std::array<float, 3>> vectors(std::uint64_t accessor);
    /// The same for vectors of 2 to 4 components; the others are 1.
    std::vector<std::array<float, 4>> values(std::uint64_t accessor, std::size_t components);
    /// An accessor of matrices, column by column.
    std::vector<std::array<float, 16>> matrices(std::uint64_t accessor);
    /// The number of components of an accessor.
    std::size_t components(std::uint64_t accessor) const;
    /// The bytes of the buffer view that an image names.
    std::string_view whole_view(const Json& image);
    /// An accessor of indices.
    std::vector<std::uint32_t> indices(std::uint64_t accessor);
    /// Values of an accessor that were decompressed: from here on in place of its own.
    void give(std::uint64_t accessor, const std::vector<std::array<float, 4>>& values);
    void give(std::uint64_t accessor, const std::vector<std::uint32_t>& indices);
    /// The files that were read in addition to the glTF file.
    const std::vector<std::filesystem::path>& other_files() const { return other_files_; }

private:
    struct Elements;
    struct Sparse;
    std::string_view buffer(std::uint64_t index);
    std::string load(const Json& buffer);
    std::string load_file(std::string_view uri);
    std::string_view slice(const Json& view);
    std::string_view view(const Json& holder, std::size_t& stride);
    std::string_view decompressed(std::uint64_t view, const Json& extension);
    template <class Value>
    void keep_given(std::uint64_t accessor, const std::vector<Value>& values);
    Elements elements(std::uint64_t accessor, std::size_t components);
    Sparse sparse_of(const Json& sparse, const Elements& elements);
    template <class Element, class Convert>
    std::vector<Element> read(std::uint64_t accessor, std::size_t components, const Convert& convert);

    const Json& document_;
    std::string_view binary_;
    std::filesystem::path folder_;
    std::uint64_t bytes_read_;     // of the file and its buffers
    std::int64_t files_read_ = 0;  // bytes of other files
    std::vector<std::filesystem::path> other_files_;
    std::map<std::uint64_t, std::string> loaded_;                // buffers by their index
    std::map<std::uint64_t, std::string> decompressed_, given_;  // buffer views and accessors by their index
};

/// The bytes of a data: URI with base64. `what`: "a buffer". Throws MeshError.
std::string decode_data_uri(std::string_view uri, const char* what);
/// Decodes %20 and similar escapes.
std::string without_percents(std::string_view uri);

}  // namespace tumble

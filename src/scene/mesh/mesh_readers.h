// Readers of the formats of mesh files, one for each. Throw MeshError.
#pragma once

#include "scene/description/mesh_paint.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/mesh_images.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace tumble {

// -- Wavefront OBJ files: positions, normals, texture coordinates, colors, polygons, their objects and their materials.
// Curves are skipped.

/// `bytes`: content of the file; the files of its materials and images are in `folder` or below, or are missing. Throws
/// MeshError.
MeshFile read_obj(std::string_view bytes, const std::filesystem::path& folder);

// -- Materials of Wavefront OBJ files.

/// Adds the materials of the text, by name: Kd, Ke, map_Kd, map_Ke, Pr, Pm, d, Tr, map_Bump and norm. Colors of the
/// text are sRGB. Other keywords are skipped. Throws MeshError.
void read_mtl(std::string_view text, MeshImages& images, std::map<std::string, MeshMaterial, std::less<>>& materials);

/// A color channel of sRGB, 0 to 1, in linear light.
float linear_channel(float srgb);

// -- STL files: text with one or more solids, and binary.

/// `bytes`: content of the file. Each solid of a text is an object. Normals are ignored, because they are those of
/// facets and carry no information about smoothness. Throws MeshError.
MeshFile read_stl(std::string_view bytes);

// -- PLY files (Turk 1994): text and binary, positions, normals and polygons. Other elements and properties are
// skipped.

/// `bytes`: content of the file. Throws MeshError.
MeshFile read_ply(std::string_view bytes, const std::filesystem::path& folder);

// -- glTF 2.0 files (Khronos, ISO/IEC 12113): the triangles of the scene's nodes. Both as JSON and as GLB.

/// A kind of glTF without a reader in Tumble: version 1.
struct UnsupportedGltf : MeshError {
    using MeshError::MeshError;
};

/// `bytes`: content of the file. Buffers may be files in the folder and below. Throws MeshError, or UnsupportedGltf.
MeshFile read_gltf(std::string_view bytes, const std::filesystem::path& folder);

// -- Reader of 3MF files, by lib3mf. Call it in a child process (import_process.h): a malformed file can crash the
// library.

/// All objects that the file builds, with their transforms, in m with y up, in their colors. Without textures. Throws
/// MeshError if the file cannot be read.
MeshFile read_three_mf(std::string_view bytes);

// -- Import of the mesh formats that Tumble does not read itself: 3MF by lib3mf, the others (Collada, 3D Studio, OFF,
// FBX and more) by assimp. It runs in a child process (import_process.h).

/// True if assimp reads files of that ending (".dae", lower case).
bool assimp_reads(const std::string& extension);

/// Imports the bytes of a file; no other file is opened but its images, in `folder` or below. Throws MeshError if they
/// cannot be read, if the import crashes, or if it takes more memory or time than a mesh within limits.h needs.
MeshFile import_with_assimp(std::string_view bytes, const std::filesystem::path& folder, const std::string& extension);

}  // namespace tumble

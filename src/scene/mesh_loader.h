// From a mesh file to what bodies use: a welded surface to compute with and shaded vertices to draw.
#pragma once

#include "core/triangle_mesh.h"
#include "scene/description.h"
#include "scene/mesh_file.h"

#include <filesystem>
#include <map>
#include <memory>
#include <utility>

namespace tumble {

/// A mesh and what a body must know before it uses it.
struct LoadedMesh {
    std::shared_ptr<const MeshAsset> asset;
    Closedness closedness;   // of the surface before triangles without area were dropped; its volume is in m^3
};

/// Loads each file once, and makes each (file, scale) once, so that bodies share.
class MeshCache {
public:
    /// Throws MeshError. `file` is resolved already.
    const LoadedMesh& load(const std::filesystem::path& file, double scale);

private:
    std::map<std::filesystem::path, LoadedMesh> files_;                      // at scale 1
    std::map<std::pair<std::filesystem::path, double>, LoadedMesh> scaled_;
};

/// One file at scale 1: welded, turned to face outward when it is closed, without triangles that have no area, with
/// normals for drawing. Throws MeshError.
LoadedMesh load_mesh(const std::filesystem::path& file);

/// Merges vertices that are closer than 1e-9 of the mesh's size; the first of each group in file order stays.
/// Returns for each vertex the one that stands for it.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions);

}  // namespace tumble

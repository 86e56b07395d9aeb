// From a mesh file to what bodies use: a welded surface to compute with and shaded vertices to draw.
#pragma once

#include "core/triangle_mesh.h"
#include "scene/description/description.h"
#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace tumble {

/// A mesh and what a body must know before it uses it.
struct LoadedMesh {
    std::shared_ptr<const MeshAsset> asset;
    Closedness closedness;   // of the surface before triangles without area were dropped; its volume is in m^3
};

/// Loads each file once, and makes each (file, scale) once, so that bodies share.
class MeshCache {
public:
    explicit MeshCache(MeshImports imports = MeshImports::in_child_process) : imports_(imports) {}

    /// Throws MeshError. `file` is resolved already.
    const LoadedMesh& load(const std::filesystem::path& file, double scale);
    /// Each object of the file as a mesh of its own. Throws MeshError.
    const std::vector<LoadedMesh>& load_objects(const std::filesystem::path& file, double scale);
    /// The files that were read, in the order in which they were met first.
    const std::vector<std::filesystem::path>& files() const { return read_; }
    /// All parts larger by a factor, their places too.
    CompoundShape enlarged(const CompoundShape& shape, double factor);

private:
    MeshImports imports_;
    std::vector<std::filesystem::path> read_;
    std::map<std::filesystem::path, LoadedMesh> files_;                      // at scale 1
    std::map<std::pair<std::filesystem::path, double>, LoadedMesh> scaled_;
    std::map<std::pair<std::filesystem::path, double>, std::vector<LoadedMesh>> objects_;
    // By address, so the keys are kept alive beside the values; only looked up.
    template <class T>
    struct Larger {
        std::shared_ptr<const T> original, made;
    };
    std::map<std::pair<const MeshAsset*, double>, Larger<MeshAsset>> larger_meshes_;
    std::map<std::pair<const void*, double>, Larger<std::vector<CompoundPart>>> larger_compounds_;
};

/// One file at scale 1: welded, turned to face outward when it is closed, without triangles that have no area, with
/// normals for drawing. Throws MeshError. The files that were read are appended to `read`, where that is given.
LoadedMesh load_mesh(const std::filesystem::path& file, std::vector<std::filesystem::path>* read = nullptr,
                     MeshImports imports = MeshImports::in_child_process);

/// The same for each object of the file: a group of an OBJ, a node of a glTF, a solid of a text STL; of other kinds the whole.
/// Throws MeshError too when they are more than a body has parts.
std::vector<LoadedMesh> load_mesh_objects(const std::filesystem::path& file,
                                          std::vector<std::filesystem::path>* read = nullptr,
                                          MeshImports imports = MeshImports::in_child_process);

/// Merges vertices that are closer than 1e-9 of the mesh's size; the first of each group in file order stays.
/// Returns for each vertex the one that stands for it.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions);

}  // namespace tumble

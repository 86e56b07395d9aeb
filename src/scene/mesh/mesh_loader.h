// From a mesh file to the data of bodies: a welded surface for computation and shaded vertices for drawing.
#pragma once

#include "core/triangle_mesh.h"
#include "scene/description/description.h"
#include "scene/mesh/mesh_file.h"

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tumble {

/// A mesh and its properties.
struct LoadedMesh {
    std::shared_ptr<const MeshAsset> asset;
    Closedness closedness;   // of the surface before triangles without area were dropped; its volume is in m^3
    bool in_meters = false;  // the file states its unit and its up axis
    /// True if it has a volume, and that is more than rounding.
    bool encloses() const;
};

/// The mesh in memory of that index, as from a file. May throw MeshError.
using MeshSupplier = std::function<MeshFile(std::size_t index)>;

/// The axis of a file that points upward in the mesh.
enum class UpAxis : std::uint8_t { y, x, z };

/// The origin of a mesh: a file (a resolved path) with its up axis, or an index for the supplier.
struct MeshSource {
    MeshSource() = default;
    MeshSource(std::filesystem::path path) : file(std::move(path)) {}
    explicit MeshSource(std::size_t supplied) : index(supplied) {}

    std::filesystem::path file;  // empty: from the supplier
    std::size_t index = 0;       // for the supplier
    UpAxis up = UpAxis::y;

    friend bool operator<(const MeshSource& a, const MeshSource& b) {
        return std::tie(a.file, a.index, a.up) < std::tie(b.file, b.index, b.up);
    }
};

/// Loads each mesh once, and makes each (mesh, scale) once, so that bodies share data.
class MeshCache {
public:
    /// Without a supplier there are no meshes in memory.
    explicit MeshCache(MeshImports imports = MeshImports::in_child_process, MeshSupplier supplier = {})
        : imports_(imports), supplier_(std::move(supplier)) {}

    bool has_supplier() const { return supplier_ != nullptr; }
    /// Throws MeshError.
    const LoadedMesh& load(const MeshSource& source, double scale);
    /// Each object of the file as a mesh of its own. Throws MeshError.
    const std::vector<LoadedMesh>& load_objects(const MeshSource& source, double scale);
    /// The files that were read, in the order of first use.
    const std::vector<std::filesystem::path>& files() const { return read_; }
    void add_file(std::filesystem::path file) { read_.push_back(std::move(file)); }
    /// All lengths enlarged by a factor, and the parts of a compound with their places.
    Shape enlarged(const Shape& shape, double factor);
    /// With its triangles for drawing, which equal shapes share.
    CurvedShape drawn(const CurvedShape& shape);

private:
    CurvedShape larger(const CurvedShape& shape, double factor);
    CompoundShape larger(const CompoundShape& shape, double factor);
    MeshShape larger(const MeshShape& shape, double factor);
    template <class Simple>
    Simple larger(const Simple& shape, double factor);

    MeshImports imports_;
    MeshSupplier supplier_;
    std::vector<std::filesystem::path> read_;
    std::map<MeshSource, LoadedMesh> loaded_;  // at scale 1
    std::map<std::pair<MeshSource, double>, LoadedMesh> scaled_;
    std::map<std::pair<MeshSource, double>, std::vector<LoadedMesh>> objects_;
    // The keys are addresses of the data that the values keep alive; only for lookups.
    template <class T>
    struct Larger {
        std::shared_ptr<const T> original, made;
    };
    std::map<std::pair<const MeshAsset*, double>, Larger<MeshAsset>> larger_meshes_;
    std::map<std::pair<const void*, double>, Larger<std::vector<CompoundPart>>> larger_compounds_;
    std::map<std::array<double, 7>, std::shared_ptr<const MeshAsset>> curved_;  // by the values of the shape
};

/// One file at scale 1: welded, oriented outward if it is closed, without triangles of zero area, with normals for
/// drawing. Throws MeshError. Appends the files that were read to `read`, if given.
LoadedMesh load_mesh(const MeshSource& source, std::vector<std::filesystem::path>* read = nullptr,
                     MeshImports imports = MeshImports::in_child_process);

/// The same for a mesh that is made, at scale 1. `name`: of the asset, for messages.
LoadedMesh load_made_mesh(const MeshFile& mesh, const std::string& name);

/// The same for each object of the file: a group of an OBJ, a node of a glTF, a solid of a text STL; the whole file for
/// other formats. Throws MeshError also if there are more objects than a body may have parts.
std::vector<LoadedMesh> load_mesh_objects(const MeshSource& source, std::vector<std::filesystem::path>* read = nullptr,
                                          MeshImports imports = MeshImports::in_child_process);

/// Merges vertices that are closer than 1e-9 of the mesh's size into the first of each group in file order. Returns for
/// each vertex the index of its representative.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions);

}  // namespace tumble
